#ifndef FINRAY_PERCEPTION_STIFFNESS_FIT_H_
#define FINRAY_PERCEPTION_STIFFNESS_FIT_H_

#include <Eigen/Core>
#include <vector>

#include "finray/perception/force_law.h"

namespace finray {

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
