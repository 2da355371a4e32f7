#ifndef FINRAY_TESTS_ESTIMATION_GAUGE_LOG_H_
#define FINRAY_TESTS_ESTIMATION_GAUGE_LOG_H_

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "finray/estimation/row_fit.h"
#include "finray/scene/clean_readings.h"
#include "test_finger.h"

namespace finray {

/// A contact that wanders along the finger while its force swells, up to 0.06
/// mm and 0.018 N from frame to frame, and noisy readings of the gauges: the
/// log that estimates are measured and tested on. All gains are 1 V/rad, so
/// that readings are angles.
struct GaugeLog {
  static constexpr double kNoise_rad = 1e-4;

  explicit GaugeLog(int frames) {
    for (Gauge& gauge : finger.gauges) gauge.noise_V = kNoise_rad;
    std::mt19937_64 generator(1);
    std::normal_distribution<double> noise(0, kNoise_rad);
    EquilibriumSolver solver(finger, {Scheme::kTaylor, 96});
    for (int i = 0; i < frames; ++i) {
      truth.push_back(
          {70 + 40 * std::sin(0.0015 * i), 4 + 3 * std::cos(0.006 * i), 0});
      solver.Solve({truth.back()});
      rows.push_back(CleanReadings(solver));
      for (double& volts : rows.back().gauges_V) volts += noise(generator);
    }
  }

  /// Returns the least-squares contact of every frame, exact to rounding, or
  /// none at all if a fit fails.
  std::vector<PointContact> LeastSquares(
      const Discretization& discretization) const {
    RowFit fit(finger, Scene(), discretization, nullptr,
               std::numeric_limits<double>::infinity());
    ContactSolution at;
    at.contacts[0] = truth[0];
    at.state = StateAt(discretization, 0);
    std::vector<PointContact> best;
    for (const Measurements& row : rows) {
      fit.set_row(row);
      // The first fit leaves a small part of its last step, the second one
      // nothing.
      for (int i = 0; i < 2; ++i) {
        const LadderState near = at.state;
        if (!fit.Fit({1, at.contacts, 0, &near}, RowFit::Model::kRounding,
                     RowFit::kMostEvaluations, &at)) {
          return {};
        }
      }
      best.push_back(at.contacts[0]);
    }
    return best;
  }

  /// Returns the equilibrium under a frame's true contact.
  LadderState StateAt(const Discretization& discretization, int frame) const {
    EquilibriumSolver solver(finger, discretization);
    solver.Solve({truth[frame]});
    return solver.state();
  }

  Finger finger = PaperFinger();  ///< With this noise.
  std::vector<PointContact> truth;
  std::vector<Measurements> rows;
};

}  // namespace finray

#endif  // FINRAY_TESTS_ESTIMATION_GAUGE_LOG_H_
