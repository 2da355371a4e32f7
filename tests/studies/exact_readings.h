#ifndef FINRAY_TESTS_STUDIES_EXACT_READINGS_H_
#define FINRAY_TESTS_STUDIES_EXACT_READINGS_H_

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"
#include "studies/gauge_frames.h"

namespace finray {

/// Fingers with gauges over all that a lab may build, from a seed: back angles
/// 90.5 to 130 degrees, 0 to 38 ribs, 2 to 8 gauges with 1e-6 to 1e-3 rad of
/// noise. A third of them are upright, below 93 degrees.
class GaugedFingers {
 public:
  explicit GaugedFingers(unsigned seed) : engine_(seed) {}

  Finger Draw() {
    Finger finger;
    finger.name = "random";
    finger.front_length_mm = LogUniform(40, 250);
    const double length = finger.front_length_mm;
    finger.back_angle_rad =
        (Uniform(0, 3) < 1 ? Uniform(90.5, 93) : Uniform(93, 130)) * kDegree;
    const double back = BeamLength(finger, Side::kBack);
    finger.front_stiffness_N_mm2 = LogUniform(1e3, 1e5);
    finger.back_stiffness_N_mm2 =
        finger.front_stiffness_N_mm2 * LogUniform(0.3, 3);
    const int ribs = Count(0, 38);
    const double jitter = Uniform(0, 0.3);
    for (int i = 1; i <= ribs; ++i) {
      Rib rib;
      rib.front_mm = length * (i + jitter * Uniform(-1, 1)) / (ribs + 1);
      rib.back_mm = back * (i + jitter * Uniform(-1, 1)) / (ribs + 1);
      rib.length_mm = NominalRibLength(finger, rib);
      finger.ribs.push_back(rib);
    }
    const int gauges = Count(2, 8);
    const double noise = LogUniform(1e-6, 1e-3);
    for (int j = 0; j < gauges; ++j) {
      const Side beam = Uniform(0, 1) < 0.25 ? Side::kFront : Side::kBack;
      const double at = (j + Uniform(0, 0.5)) / gauges;
      finger.gauges.push_back(
          {beam, at * BeamLength(finger, beam),
           Uniform(0.2, 0.5) / gauges * BeamLength(finger, beam), 1, 0, noise});
    }
    return finger;
  }

  /// A contact over 3 to 97 % of l_0 with 0.1 to 38 force units (0.06 to 24 N
  /// of the paper's finger).
  PointContact DrawContact(const Finger& finger) {
    const double arc = Uniform(0.03, 0.97) * finger.front_length_mm;
    return {arc, LogUniform(0.1, 38) * ForceUnit(finger), 0};
  }

 private:
  // <random>'s distributions differ by library.
  double Uniform(double from, double to) {
    return from + (to - from) * engine_() / 4294967296.0;
  }
  double LogUniform(double from, double to) {
    return std::exp(Uniform(std::log(from), std::log(to)));
  }
  int Count(int least, int most) {
    return least + static_cast<int>(Uniform(0, most - least + 1));
  }

  std::mt19937 engine_;
};

/// How exact readings of one finger came out.
struct ExactTally {
  int frames = 0, ok = 0;
  int wrong = 0;  ///< ok, and yet another contact
};

/// Estimates contacts from exact readings, each on its own.
class ExactReadings {
 public:
  ExactReadings(const Finger& finger, const Scene& scene)
      : estimator_(finger, scene, {}), solver_(finger, {}) {}

  /// Adds one frame. A frame is wrong if it is ok, but l_c or f_c is more than
  /// 6 std off, and also more than a thousandth of l_0 or a hundredth of f_c.
  /// Returns false for a wrong one.
  bool Add(const PointContact& contact, ExactTally* tally) {
    solver_.Reset();
    if (!solver_.Solve({contact})) return true;
    ++tally->frames;
    estimate_ = estimator_.Estimate(CleanReadings(solver_));
    if (estimate_.status != FrameStatus::kOk) return true;
    ++tally->ok;
    const ContactEstimate& found = estimate_.contact[0];
    const double arc_error = std::abs(found.arc_mm - contact.arc_mm);
    const double force_error = std::abs(found.normal_N - contact.normal_N);
    const double length = estimator_.finger().front_length_mm;
    const bool wrong =
        arc_error > std::max(6 * found.arc_std_mm, 1e-3 * length) ||
        force_error > std::max(6 * found.normal_std_N, 0.01 * contact.normal_N);
    tally->wrong += wrong;
    return !wrong;
  }

  const FrameEstimate& estimate() const { return estimate_; }

 private:
  FrameEstimator estimator_;
  EquilibriumSolver solver_;
  FrameEstimate estimate_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_EXACT_READINGS_H_
