// Outlines of ten objects as in Figs. 14 to 17 of the paper and of a concave
// one, from simulated touches: the fit of outline_fit.h and the paper's method
// (interior envelope of beams within 10 mm of the contact, 19 Fourier
// descriptors), and what 19 descriptors of the true outline make of it. 36
// orientations, 3 N, gauges 3e-4 rad, stage 0.02 mm. `seeds` draws of noise.
//
//   build/test/tests/reconstruction_study [SEEDS [OBJECT]]
//   build/test/tests/reconstruction_study write DIR [SEED [FINGER [FRICTION]]]
//
// The second one writes logs of the noisy touches and true outlines instead;
// with SEED the touching finger is off from the paper's by parameters drawn as
// a calibration leaves them (EI 1 %, gains 0.3 %, ribs 0.03 mm), as
// conditions.yaml says. With the YAML of a finger it is that finger. Under
// friction a touch that finds no equilibrium is an empty row.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>

#include "finray/control/plant.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/atomic_file.h"
#include "finray/perception/polygon.h"
#include "finray/perception/reconstruction.h"
#include "studies/ten_objects.h"
#include "test_finger.h"

namespace finray {
namespace {

struct Score {
  double mean = 0, p95 = 0, largest = 0;
  int count = 0;
  void Add(const RadialError& error) {
    mean += error.Mean();
    p95 += error.Quantile(0.95);
    largest = std::max(largest, error.Largest());
    ++count;
  }
  void Print() const {
    std::printf(" %.3f / %.3f / %.3f |", mean / count, p95 / count, largest);
  }
};

void Run(int seeds, const char* only) {
  const Finger finger = PaperFinger();
  for (const bool noisy : {false, true}) {
    std::printf(
        "\n%s; radial error in percent, mean / 95 %% / largest\n"
        "| object | fit | its supported part | fit, 19 descriptors | envelope, "
        "19 descriptors "
        "| truth, 19 descriptors | within 1, 1.96 std, %% | supported, %% | "
        "lambda | noise | bounds | touches "
        "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        noisy ? "gauges 3e-4 rad, stage 0.02 mm" : "without noise");
    for (const NamedObject& object : StudyObjects()) {
      if (only != nullptr && object.name != only) continue;
      Score fit, fit_touched, fit_descriptors, envelope, truth_descriptors;
      double within_1 = 0, within_2 = 0, supported = 0, lambda = 0, scale = 0;
      double touches = 0, bounds = 0;
      for (int seed = 1; seed <= (noisy ? seeds : 1); ++seed) {
        LogNoise noise;
        noise.gauges = noisy;
        noise.stage_std_mm = noisy ? 0.02 : 0;
        noise.seed = static_cast<std::uint64_t>(seed);
        const FrameTable table =
            SimulateTouches(finger, object.touched, {}, {}, noise);
        const Reconstruction found =
            Reconstruct(table, finger, Scene(), {}, kStageStd_mm);
        const RadialError error = CompareRadii(found.polygon(), object.truth);
        fit.Add(error);
        RadialError touched;
        for (std::size_t i = 0; i < found.outline.size(); ++i) {
          if (!found.outline[i].supported) continue;
          touched.percent.push_back(error.percent[i]);
        }
        fit_touched.Add(touched);
        fit_descriptors.Add(
            CompareRadii(FourierDescriptors(found.polygon(), 19).Sampled(1440),
                         object.truth));
        envelope.Add(CompareRadii(
            FourierDescriptors(InteriorEnvelope(found.touches.usable, 10), 19)
                .Sampled(1440),
            object.truth));
        truth_descriptors.Add(CompareRadii(
            FourierDescriptors(object.truth, 19).Sampled(1440), object.truth));
        int in_1 = 0, in_2 = 0;
        for (const OutlinePoint& point : found.outline) {
          const auto radius =
              RadiusAt(object.truth, found.centroid_mm, point.angle_rad);
          const double off =
              std::abs(point.radius_mm - radius.value_or(0)) / point.std_mm;
          in_1 += off <= 1;
          in_2 += off <= 1.96;
        }
        within_1 += 100.0 * in_1 / static_cast<double>(found.outline.size());
        within_2 += 100.0 * in_2 / static_cast<double>(found.outline.size());
        supported += 100 * found.supported_share;
        lambda += std::log10(found.fit.smoothing);
        scale += found.fit.noise_scale;
        bounds += found.fit.beam_bounds;
        touches += static_cast<double>(found.touches.usable.size());
      }
      std::printf("| %s |", object.name.c_str());
      for (const Score* score : {&fit, &fit_touched, &fit_descriptors,
                                 &envelope, &truth_descriptors}) {
        score->Print();
      }
      const double n = fit.count;
      std::printf(" %.0f, %.0f | %.0f | 1e%.1f | %.2f | %.0f | %.0f |\n",
                  within_1 / n, within_2 / n, supported / n, lambda / n,
                  scale / n, bounds / n, touches / n);
      std::fflush(stdout);
    }
  }
}

constexpr ModelError kCalibrated{1, 0.3, 0, 0.03};

// Returns the finger that touches, drawn anew for each object.
using Plant = std::function<Finger(std::mt19937_64*)>;

void Write(const std::string& folder, const Plant& plant,
           const ModelError& error, double friction, unsigned seed) {
  MakeFolder(folder);
  TouchProtocol protocol;
  protocol.friction = friction;
  protocol.may_fail = friction > 0;
  const double stage_std_mm = 0.02;
  std::mt19937_64 generator(seed);
  for (const NamedObject& object : StudyObjects()) {
    std::string stem = folder + "/" + object.name;
    std::replace(stem.end() - static_cast<std::ptrdiff_t>(object.name.size()),
                 stem.end(), ' ', '_');
    SimulateTouches(plant(&generator), object.touched, {}, protocol,
                    {true, stage_std_mm, seed})
        .Write(stem + ".touches.csv");
    FrameTable outline(360);
    const Polygon points = EvenlySpaced(object.truth, 360);
    for (std::size_t i = 0; i < points.size(); ++i) {
      outline.MutableNumbers("x_mm")[i] = points[i].x();
      outline.MutableNumbers("y_mm")[i] = points[i].y();
    }
    outline.Write(stem + ".outline.csv");
  }
  const Gauge gauge = PaperFinger().gauges[0];
  std::ofstream conditions(folder + "/conditions.yaml");
  conditions << "gauge_noise_rad: " << 1 / gauge.AngleWeight()
             << "\nstage_std_mm: " << stage_std_mm
             << "\nmodel_error: {stiffness_std_percent: "
             << error.stiffness_percent
             << ", gauge_gain_std_percent: " << error.gauge_gain_percent
             << ", rib_length_std_mm: " << error.rib_length_mm
             << "}\norientations: " << protocol.orientations
             << "\nforce_N: " << protocol.force_N << "\nobjects:\n";
  for (const NamedObject& object : StudyObjects()) {
    conditions << "  - {name: " << object.name << ", kind: " << object.kind
               << "}\n";
  }
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  if (argc >= 3 && std::string(argv[1]) == "write") {
    const unsigned seed = argc > 3 ? std::atoi(argv[3]) : 1;
    const double friction = argc > 5 ? std::atof(argv[5]) : 0;
    if (argc > 4) {
      const finray::Finger finger = finray::ReadFinger(argv[4]);
      finray::Write(
          argv[2], [&](auto*) { return finger; }, {}, friction, seed);
      return 0;
    }
    const finray::ModelError error =
        argc > 3 ? finray::kCalibrated : finray::ModelError{};
    finray::Write(
        argv[2],
        [&](auto* generator) {
          return finray::Perturbed(finray::PaperFinger(), error, generator);
        },
        error, 0, seed);
    return 0;
  }
  finray::Run(argc > 1 ? std::atoi(argv[1]) : 10, argc > 2 ? argv[2] : nullptr);
}
