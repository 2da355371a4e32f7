// Is an `ok` frame ever far from the truth? Ramps of the force from zero to a
// peak and back at random places of the whole beam, the paper's finger, gauge
// noise 3e-4 rad, `contacts: auto`. It prints the frames that are `ok` and more
// than 6 std off, after a table by place. Behind a peak, `:` states the scene's
// force_max_N, and `~` smooths with 0.2 mm and that force from frame to frame.
//
//   build/test/tests/ramp_study [FRAMES [SEED [PEAK_N[:MAX_N][~CHANGE_N]...]]]

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "studies/ramps.h"
#include "test_finger.h"

namespace finray {
namespace {

void Run(long frames, unsigned seed, const char* peak) {
  const double peak_N = std::atof(peak);
  Scene scene;
  if (const char* limit = std::strchr(peak, ':')) {
    scene.force_max_N = std::atof(limit + 1);
  }
  if (const char* change = std::strchr(peak, '~')) {
    scene.smoothing = {0.2, std::atof(change + 1)};
  }
  const Finger finger = PaperFinger();
  const std::vector<double> edges = {0, 5, 17, 39, 61, 83, 105, 115, 125, 140};
  const std::vector<RampTally> bands = RampStudy(
      finger, scene, peak_N, static_cast<int>(frames / 64), edges, seed);
  std::printf(
      "\n| l_c, mm; 0 to %g N%s%s | frames | ok, %% | two contacts | ok beyond "
      "3 "
      "std, %% | beyond 6 std | farthest, std | largest force of a no_contact "
      "frame, N |\n|---|---|---|---|---|---|---|---|\n",
      peak_N, scene.force_max_N ? ", force_max_N stated" : "",
      scene.smoothing ? ", smoothed" : "");
  RampTally all;
  const auto print = [](const char* name, const RampTally& t) {
    std::printf("| %s | %ld | %.2f | %ld | %.2f | %ld | %.1f | %.2f |\n", name,
                t.frames, 100.0 * t.ok / t.frames, t.two,
                t.ok > 0 ? 100.0 * t.beyond_3 / t.ok : 0, t.beyond_6, t.worst,
                t.hidden_N);
  };
  for (const RampTally& band : bands) {
    char name[32];
    std::snprintf(name, sizeof(name), "%g..%g", band.from_mm, band.to_mm);
    print(name, band);
    all.Add(band);
  }
  print("all", all);
  for (const FarFrame& far : all.far) {
    const ContactEstimate& found = far.estimate.contact[0];
    std::printf(
        "%.2f mm %.3f N: %d contacts, %.2f +- %.2f mm, %.3f +- %.3f N, "
        "chi2 %.2f, volts",
        far.arc_mm, far.normal_N, far.estimate.contacts, found.arc_mm,
        found.arc_std_mm, found.normal_N, found.normal_std_N,
        far.estimate.chi2);
    for (const double volt : far.gauges_V) std::printf(" %.6f", volt);
    std::printf("\n");
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  const long frames = argc > 1 ? std::atol(argv[1]) : 1000000;
  const auto seed = static_cast<unsigned>(argc > 2 ? std::atol(argv[2]) : 1);
  std::vector<const char*> peaks = {"0.7", "8"};
  if (argc > 3) peaks.assign(argv + 3, argv + argc);
  for (const char* peak : peaks) finray::Run(frames, seed, peak);
}
