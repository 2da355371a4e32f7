#ifndef FINRAY_PERCEPTION_FORCE_LAW_H_
#define FINRAY_PERCEPTION_FORCE_LAW_H_

#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

#include "finray/perception/force_displacement.h"

namespace finray {

/// Form of an object's force law (N over mm), with the friction F_c of its
/// slider if both directions have been measured:
///
///   F(u, s) = sum_m a_m u^m + s F_c,   m = 0 .. degree,   s = +-1 the
///   direction.
///
/// The law is linear in its parameters a = (a_0 .. a_degree[, F_c]).
struct ForceLaw {
  int degree = 1;
  bool has_friction = false;

  int parameters() const { return degree + 1 + has_friction; }
  /// The row g with F(u, s) = g a.
  Eigen::RowVectorXd Row(double u, int direction) const {
    Eigen::RowVectorXd row(parameters());
    double power = 1;
    for (int m = 0; m <= degree; ++m, power *= u) row[m] = power;
    if (has_friction) row[degree + 1] = direction;
    return row;
  }
  /// F without friction.
  double Force(const Eigen::VectorXd& a, double u) const {
    return Row(u, 0).dot(a);
  }
  /// dF/du.
  double Slope(const Eigen::VectorXd& a, double u) const {
    double slope = 0;
    for (int m = degree; m >= 1; --m) slope = slope * u + m * a[m];
    return slope;
  }
  /// The variance of F_i - F(u_i): the point's covariance seen across the law.
  double VarianceAcross(const Eigen::VectorXd& a, const ForcePoint& point,
                        double u) const {
    const Eigen::Vector2d across(-Slope(a, u), 1);
    return across.dot(point.covariance * across);
  }
  /// Parameters by weighted least squares of F on u.
  Eigen::VectorXd Fit(const std::vector<ForcePoint>& points,
                      const Eigen::VectorXd& weights) const {
    Eigen::MatrixXd rows(weights.size(), parameters());
    Eigen::VectorXd forces(weights.size());
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const ForcePoint& point = points[static_cast<std::size_t>(i)];
      rows.row(i) = weights[i] * Row(point.displacement_mm, point.direction);
      forces[i] = weights[i] * point.force_N;
    }
    return rows.colPivHouseholderQr().solve(forces);
  }
};

}  // namespace finray

#endif  // FINRAY_PERCEPTION_FORCE_LAW_H_
