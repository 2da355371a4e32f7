#ifndef FINRAY_PERCEPTION_STIFFNESS_FIT_H_
#define FINRAY_PERCEPTION_STIFFNESS_FIT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/perception/force_displacement.h"

namespace finray {

/// Force law of an object, with Coulomb friction of its slider:
///
///   F = sum_m a_m u^m + s F_c,   m = 0 .. degree,   s = +-1 the direction.
///
/// Both u and F of each point have errors, of covariance C_i. The true
/// displacements v_i are unknowns too, and
///
///   sum_i |C_i^-1/2 (u_i - v_i, F_i - F(v_i))|^2  -> min
///
/// is the maximum likelihood fit, for a straight line York's. F_c is an unknown
/// if the points have both directions; else it is within a_0.
struct StiffnessFit {
  Eigen::VectorXd coefficients;  ///< a_0 .. a_degree, then F_c if fitted
  Eigen::MatrixXd covariance;    ///< of these, of the points' errors
  int degree = 1;
  bool has_friction = false;
  double chi2 = 0;
  int dof = 0;
  double least_force_N = 0, largest_force_N = 0;  ///< of the points
  double least_mm = 0, largest_mm = 0;
  std::size_t points = 0, standing = 0;  ///< used; not, as the slider stood
  std::vector<std::size_t> left_out;     ///< rows that contradict the others

  double friction_N() const;  ///< NaN if it is not fitted
  double friction_std_N() const;
  /// Without friction.
  double ForceAt(double displacement_mm) const;
  double DisplacementAt(double force_N) const;
  /// 1, or sqrt(chi2 / dof) where noise alone hardly makes chi2 as large.
  double noise_scale() const;
};

constexpr std::size_t kLeastPoints = 5;

/// Fits the points that slide, less those that contradict most others
/// (contradicting_points.h). The degree is the one from 1 to `most_degree` with
/// the least chi2 + p log(n), p parameters from n points. Throws InputError for
/// fewer than kLeastPoints of them.
StiffnessFit FitStiffness(const std::vector<ForcePoint>& points,
                          int most_degree);

/// Stiffness between two forces, (F_2 - F_1) / (u(F_2) - u(F_1)), whatever the
/// law; for a straight line its slope.
struct Stiffness {
  double N_per_mm, std;
};
Stiffness StiffnessBetween(const StiffnessFit& fit, double from_N, double to_N);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_STIFFNESS_FIT_H_
