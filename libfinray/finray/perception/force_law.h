#ifndef FINRAY_PERCEPTION_FORCE_LAW_H_
#define FINRAY_PERCEPTION_FORCE_LAW_H_

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "finray/perception/force_displacement.h"

namespace finray {

/// The law of stiffness_fit.h, F(u) = sum_m a_m u^m; behind the a_m of a degree
/// there may be the friction F_c.
inline double ForceOf(const Eigen::VectorXd& a, int degree, double u) {
  double force = 0;
  for (int m = degree; m >= 0; --m) force = force * u + a[m];
  return force;
}

/// dF/du.
inline double SlopeOf(const Eigen::VectorXd& a, int degree, double u) {
  double slope = 0;
  for (int m = degree; m >= 1; --m) slope = slope * u + m * a[m];
  return slope;
}

/// F as a linear function of the law's parameters, u being the true one.
struct LawRows {
  Eigen::MatrixXd left;
  Eigen::VectorXd right;
};
inline LawRows LawRowsOf(const std::vector<ForcePoint>& points, int degree,
                         bool friction) {
  const auto count = static_cast<Eigen::Index>(points.size());
  LawRows rows{Eigen::MatrixXd(count, degree + 1 + friction),
               Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const ForcePoint& point = points[static_cast<std::size_t>(i)];
    for (int m = 0; m <= degree; ++m) {
      rows.left(i, m) = std::pow(point.displacement_mm, m);
    }
    if (friction) rows.left(i, degree + 1) = point.direction;
    rows.right[i] = point.force_N;
  }
  return rows;
}

}  // namespace finray

#endif  // FINRAY_PERCEPTION_FORCE_LAW_H_
