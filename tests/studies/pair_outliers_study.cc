// How far frames that are `ok` with two contacts are from the truth, over
// fingers with other ribs and gauges, noises and loads; the plant is another
// scheme (rigid links, 4000 of them) than the estimator's. Places are drawn
// over the whole finger, forces as logarithms from 0.3 to 8 N.
//
//   build/test/tests/pair_outliers_study [FRAMES [SEED [CASE [SHOWN]]]]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>

#include "finray/estimation/frame_estimator.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/number_text.h"
#include "finray/io/yaml_map.h"
#include "studies/gauge_frames.h"

namespace finray {
namespace {

struct Case {
  std::string name;
  Finger finger;
  std::optional<int> contacts;
};

// The paper's finger with other gauges, and with other ribs if there are any:
// evenly from 15 mm to `last_mm`, at 8 to 24 deg.
Finger Changed(int gauges, double noise_V, int ribs, double last_mm) {
  const double back_mm[] = {30, 53, 76, 98}, front_mm[] = {18, 40, 85, 107};
  std::string text =
      "{schema_version: 1, name: changed, geometry: {front_length_mm: 140, "
      "back_angle_deg: 112}, beams: {front: {bending_stiffness_N_mm2: 12500}, "
      "back: {bending_stiffness_N_mm2: 12500}}, ribs: [";
  const double paper_mm[] = {17, 39, 61, 83, 105};
  const double paper_deg[] = {10, 13, 16, 19, 22};
  for (int i = 0; i < (ribs > 0 ? ribs : 5); ++i) {
    const double share = ribs > 1 ? i / (ribs - 1.0) : 0;
    text += FormatText("{front_mm: %g, angle_deg: %g}, ",
                       ribs > 0 ? 15 + share * (last_mm - 15) : paper_mm[i],
                       ribs > 0 ? 8 + 16 * share : paper_deg[i]);
  }
  text += "], gauges: [";
  for (int j = 0; j < gauges; ++j) {
    const int front = gauges == 6 ? 2 * (j - 4) + 1 : j - 4;
    text += FormatText(
        "{beam: %s, start_mm: %g, length_mm: 18, gain_V_per_rad: 1, "
        "noise_V: %g}, ",
        j < 4 ? "back" : "front", j < 4 ? back_mm[j] : front_mm[front],
        noise_V);
  }
  return ReadFinger(YamlMap::FromText(text + "]}", "finger"));
}

void Run(const Case& of, int frames, unsigned seed, int shown) {
  FrameEstimator estimator(of.finger, [&] {
    Scene scene;
    scene.contacts = of.contacts;
    return scene;
  }());
  EquilibriumSolver plant(of.finger, {Scheme::kRigidChain, 4000});
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  const double length = of.finger.front_length_mm;
  int ok = 0, five = 0, eight = 0, tip_ok = 0, tip_five = 0, one = 0;
  int unobservable = 0, solved = 0;
  double worst = 0, seconds = 0;
  for (int i = 0; i < frames; ++i) {
    double first = length * (0.08 + 0.87 * uniform(generator)),
           second = length * (0.08 + 0.87 * uniform(generator));
    if (first > second) std::swap(first, second);
    const double f1 = 0.3 * std::pow(27, uniform(generator));
    const double f2 = 0.3 * std::pow(27, uniform(generator));
    if (second - first < 0.07 * length) continue;
    const std::vector<PointContact> truth = {{first, f1, 0}, {second, f2, 0}};
    plant.Reset();
    if (!plant.Solve(truth)) continue;
    ++solved;
    const Measurements row =
        WithNoise(CleanReadings(plant), of.finger, &generator);
    const std::clock_t begin = std::clock();
    const FrameEstimate estimate = estimator.Estimate(row);
    seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    one += estimate.contacts == 1 && estimate.status == FrameStatus::kOk;
    if (estimate.contacts != 2) continue;
    unobservable += estimate.status == FrameStatus::kUnobservable;
    if (estimate.status != FrameStatus::kOk) continue;
    double far = 0;
    for (int c = 0; c < 2; ++c) {
      const ContactEstimate& e = estimate.contact[c];
      far =
          std::max({far, std::abs(e.arc_mm - truth[c].arc_mm) / e.arc_std_mm,
                    std::abs(e.normal_N - truth[c].normal_N) / e.normal_std_N});
    }
    const bool tip = second > of.finger.ribs.back().front_mm;
    ++ok;
    five += far > 5;
    eight += far > 8;
    tip_ok += tip;
    tip_five += tip && far > 5;
    worst = std::max(worst, far);
    if (far > 5 && shown-- > 0) {
      std::printf(
          "  #%d far %.1f p %.3f chi2 %.2f: truth %.2f %.3f %.2f %.3f; found "
          "%.2f+-%.2f %.3f+-%.3f %.2f+-%.2f %.3f+-%.3f\n",
          i, far, estimate.p_value(), estimate.chi2, first, f1, second, f2,
          estimate.contact[0].arc_mm, estimate.contact[0].arc_std_mm,
          estimate.contact[0].normal_N, estimate.contact[0].normal_std_N,
          estimate.contact[1].arc_mm, estimate.contact[1].arc_std_mm,
          estimate.contact[1].normal_N, estimate.contact[1].normal_std_N);
    }
  }
  std::printf(
      "| %s | %d | %d | %d | %d (%.2f %%) | %d | %.1f | %d of %d | %d | %.0f "
      "|\n",
      of.name.c_str(), solved, ok, unobservable, five,
      100.0 * five / std::max(1, ok), eight, worst, tip_five, tip_ok, one,
      1e6 * seconds / std::max(1, solved));
  std::fflush(stdout);
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  using namespace finray;
  const int frames = argc > 1 ? std::atoi(argv[1]) : 2000;
  const unsigned seed = argc > 2 ? std::atoi(argv[2]) : 1;
  const int only = argc > 3 ? std::atoi(argv[3]) : -1;
  const int shown = argc > 4 ? std::atoi(argv[4]) : 0;
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const Finger& finger,
                       std::optional<int> contacts) {
    cases.push_back({name, finger, contacts});
  };
  add("8 gauges, 1e-4", Changed(8, 1e-4, 0, 0), {});
  add("8 gauges, 3e-4", Changed(8, 3e-4, 0, 0), {});
  add("8 gauges, 3e-5", Changed(8, 3e-5, 0, 0), {});
  add("6 gauges, 1e-4", Changed(6, 1e-4, 0, 0), {});
  add("6 gauges, 3e-4", Changed(6, 3e-4, 0, 0), {});
  add("4 gauges, 1e-4, contacts: 2", Changed(4, 1e-4, 0, 0), 2);
  add("4 gauges, 3e-4, contacts: 2", Changed(4, 3e-4, 0, 0), 2);
  add("8 gauges, 1e-4, 3 ribs to 90", Changed(8, 1e-4, 3, 90), {});
  add("8 gauges, 1e-4, 7 ribs to 120", Changed(8, 1e-4, 7, 120), {});
  add("6 gauges, 1e-4, 4 ribs to 80", Changed(6, 1e-4, 4, 80), {});
  std::printf(
      "| case | pairs | ok | unobservable | beyond 5 std | beyond 8 | worst | "
      "past the last rib | one contact | CPU us a frame |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (only >= 0 && only != static_cast<int>(i)) continue;
    Run(cases[i], frames, seed, shown);
  }
}
