#ifndef FINRAY_TESTS_STUDIES_AMBIGUITY_H_
#define FINRAY_TESTS_STUDIES_AMBIGUITY_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// How well single contacts elsewhere explain the readings of one contact:
/// distances between curves of gauge angles over f_c, one curve for each place,
/// in standard deviations of the gauges. A light touch below the tip and a
/// heavy one at the tip bend the back beam alike; then even the best estimator
/// takes one for the other now and then, and no std tells it.
class Ambiguity {
 public:
  explicit Ambiguity(const Finger& finger) {
    EquilibriumSolver solver(finger, {});
    const double unit =
        finger.front_stiffness_N_mm2 / std::pow(finger.front_length_mm, 2);
    weight_.resize(static_cast<int>(finger.gauges.size()));
    for (int j = 0; j < weight_.size(); ++j) {
      weight_[j] = finger.gauges[j].AngleWeight();
    }
    for (int i = 1; i < kPlaces; ++i) {
      curves_.push_back({finger.front_length_mm * i / kPlaces, {}});
      for (int k = 0; k < kForces; ++k) {
        const double force =
            unit * 0.05 * std::pow(1200.0, k / (kForces - 1.0));
        if (!solver.Solve({{curves_.back().arc_mm, force, 0}})) break;
        curves_.back().points.push_back(Whitened(solver));
      }
    }
  }

  /// How far the readings at the solver's present equilibrium are from those of
  /// any other place, at least, where the bound of l_c alone would have them 10
  /// std apart or more; nearer places count in proportion,
  ///
  ///   min over l of 10 d(l) / min(10, |l - l_c| / bound),    |l - l_c| >
  ///   bound.
  ///
  /// It is 10 where the readings are as straight as the bound takes them to be.
  double Distance(const EquilibriumSolver& solver, double arc_mm,
                  double bound_mm) const {
    const Eigen::VectorXd at = Whitened(solver);
    double least = std::numeric_limits<double>::infinity();
    for (const Curve& curve : curves_) {
      const double apart = std::abs(curve.arc_mm - arc_mm) / bound_mm;
      if (apart <= 1) continue;
      for (std::size_t k = 0; k + 1 < curve.points.size(); ++k) {
        const Eigen::VectorXd& a = curve.points[k];
        const Eigen::VectorXd chord = curve.points[k + 1] - a;
        const double share =
            std::clamp(chord.dot(at - a) / chord.squaredNorm(), 0.0, 1.0);
        const double distance = (a + share * chord - at).norm();
        least = std::min(least, 10 * distance / std::min(10.0, apart));
      }
    }
    return least;
  }

 private:
  static constexpr int kPlaces = 140, kForces = 60;
  struct Curve {
    double arc_mm;
    std::vector<Eigen::VectorXd> points;
  };

  Eigen::VectorXd Whitened(const EquilibriumSolver& solver) const {
    return solver.outputs().head(weight_.size()).cwiseProduct(weight_);
  }

  Eigen::VectorXd weight_;
  std::vector<Curve> curves_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_AMBIGUITY_H_
