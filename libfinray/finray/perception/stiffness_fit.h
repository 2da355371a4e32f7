#ifndef FINRAY_PERCEPTION_STIFFNESS_FIT_H_
#define FINRAY_PERCEPTION_STIFFNESS_FIT_H_

#include <Eigen/Core>
#include <Eigen/QR>
#include <cstddef>
#include <vector>

namespace finray {

/// Force and displacement of an object that yields along a line, sensed by the
/// finger that presses it, (20) of the paper:
///
///   u = (r - R n - p) . e,    F = -f_c n . e      (mm, N).
///
/// e is the direction in which the object is pushed, p its unloaded place (the
/// stage's object_x_mm, object_y_mm), n the beam's normal into the finger at
/// the contact r, and R the radius of the pulley that the finger touches. The
/// errors of u and F are correlated, as both come from one estimate.
struct ForcePoint {
  std::size_t row;  ///< of its table, from 0
  double displacement_mm, force_N;
  Eigen::Matrix2d covariance;  ///< of (u, F), with the error of the stage
  double approach_mm;          ///< -p . e, how far the object has been moved in
  /// +1 while the object is moved in, -1 while it is withdrawn.
  int direction = 1;
  /// False from a reversal until the slider moves again. Until then its
  /// friction may have any value between both limits.
  bool slides = true;
};

/// Form of an object's force law (N over mm), with the friction F_c of its
/// slider if both directions have been measured:
///
///   F(u, s) = sum_m a_m u^m + s F_c,   m = 0 .. degree,
///
/// with the direction s = +-1. The law is linear in its parameters a = (a_0 ..
/// a_degree[, F_c]).
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
  /// F(u, s), without friction for s = 0.
  template <typename T>
  T Force(const T* a, const T& u, int direction) const {
    T force = has_friction ? a[degree + 1] * T(direction) : T(0);
    T power(1);
    for (int m = 0; m <= degree; ++m, power *= u) force += a[m] * power;
    return force;
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

/// An object's force law fitted to points whose u and F both have errors, of
/// covariance C_i. The true displacements v_i are unknowns too, and
///
///   sum_i |C_i^-1/2 (u_i - v_i, F_i - F(v_i, s_i))|^2  -> min
///
/// is the maximum-likelihood fit (for a straight line, York's). If all points
/// have the same direction, a_0 includes the friction.
struct StiffnessFit {
  ForceLaw law;
  Eigen::VectorXd coefficients;  ///< a_0 .. a_degree, then F_c if it is fitted
  Eigen::MatrixXd covariance;    ///< of the coefficients
  double chi2 = 0;
  int dof = 0;
  double largest_force_N = 0;           ///< of the points
  double least_mm = 0, largest_mm = 0;  ///< range of the displacements v_i
  std::size_t points = 0;               ///< used by the fit
  std::size_t standing = 0;             ///< left out: the slider stood
  std::vector<std::size_t> left_out;    ///< rows that contradict the others

  double friction_N() const;  ///< NaN if it is not fitted
  double friction_std_N() const;
  /// The force without friction, and its inverse.
  double ForceAt(double displacement_mm) const;
  double DisplacementAt(double force_N) const;
  /// sqrt(chi2 / dof) if noise alone is unlikely to cause that chi2, else 1.
  double noise_scale() const;
};

constexpr std::size_t kLeastPoints = 5;

/// Fits the points where the slider moves. Chooses the degree, from 1 to
/// `most_degree`, with the least chi2 + p log(n) for p parameters and n points.
///
/// Points that contradict the law which most points follow are left out (a
/// light touch may read like a heavy one). With c_i the squared distance of
/// point i across that law, in units of its variance, and
///
///   s^2 = max(1, median(c) / median of chi2 with one degree of freedom),
///
/// a point contradicts the law if P(chi2 > c_i / s^2) < 0.01 / n. All points
/// stay if more than a quarter would go or no more than kLeastPoints would be
/// left.
///
/// Throws InputError for fewer than kLeastPoints points and for a force that
/// does not grow with the displacement.
StiffnessFit FitStiffness(const std::vector<ForcePoint>& points,
                          int most_degree);

/// Secant stiffness between two forces, (F_2 - F_1) / (u(F_2) - u(F_1)).
struct Stiffness {
  double N_per_mm, std;
};
Stiffness StiffnessBetween(const StiffnessFit& fit, double from_N, double to_N);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_STIFFNESS_FIT_H_
