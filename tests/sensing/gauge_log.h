#ifndef FINRAY_TESTS_SENSING_GAUGE_LOG_H_
#define FINRAY_TESTS_SENSING_GAUGE_LOG_H_

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <vector>

#include "finray/sensing/fast/contact_fit.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {

/// A contact that wanders along the finger while its force swells, up to 0.06
/// mm and 0.018 N from frame to frame, and noisy angles of the gauges: the log
/// that sensing is measured and tested on.
struct GaugeLog {
  static constexpr double kNoise_rad = 1e-4;

  explicit GaugeLog(int frames)
      : angles(4, frames),
        weights(Eigen::MatrixXd::Constant(4, frames, 1 / kNoise_rad)) {
    std::mt19937_64 generator(1);
    std::normal_distribution<double> noise(0, kNoise_rad);
    EquilibriumSolver solver(PaperFinger(), {Scheme::kTaylor, 96});
    for (int i = 0; i < frames; ++i) {
      truth.push_back(
          {70 + 40 * std::sin(0.0015 * i), 4 + 3 * std::cos(0.006 * i), 0});
      solver.Solve({truth.back()});
      angles.col(i) = solver.outputs().head(4);
      for (double& angle : angles.col(i)) angle += noise(generator);
    }
  }

  /// Returns the least-squares contact of every frame, exact to rounding.
  std::vector<PointContact> LeastSquares(
      const Discretization& discretization) const {
    ContactFit fit(PaperFinger(), discretization);
    fit.set_state(StateAt(discretization, 0));
    std::vector<PointContact> best, contacts = {truth[0]};
    for (Eigen::Index i = 0; i < angles.cols(); ++i) {
      if (!fit.Follow(angles.col(i), weights.col(i), &contacts)) return {};
      best.push_back(contacts[0]);
    }
    return best;
  }

  /// Returns the equilibrium under a frame's true contact.
  LadderState StateAt(const Discretization& discretization, int frame) const {
    EquilibriumSolver solver(PaperFinger(), discretization);
    solver.Solve({truth[frame]});
    return solver.state();
  }

  std::vector<PointContact> truth;
  Eigen::MatrixXd angles, weights;  // a column a frame
};

}  // namespace finray

#endif  // FINRAY_TESTS_SENSING_GAUGE_LOG_H_
