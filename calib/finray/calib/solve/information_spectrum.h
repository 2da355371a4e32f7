#ifndef FINRAY_CALIB_SOLVE_INFORMATION_SPECTRUM_H_
#define FINRAY_CALIB_SOLVE_INFORMATION_SPECTRUM_H_

#include <Eigen/Core>

namespace finray {

/// Eigenvalues, ascending, and eigenvectors of an information matrix S, of
/// which units take no digits. Units far from what the data tell (a prior of 2
/// V/rad on gains of 1e-6 V/rad) spread the eigenvalues by more than a double
/// has digits, and then an eigensolver has nothing but rounding to say of the
/// small ones.
///
/// With D = diag(S)^1/2 the matrix D^-1 S D^-1 = V L V' has a unit diagonal:
/// its condition, that of correlations, is what digits are lost by. S = B'B
/// with B = L^1/2 V' D, whose singular values a Jacobi method finds to high
/// relative precision, as it is a well-conditioned matrix times a diagonal one
/// (Demmel & Veselic, SIAM J. Matrix Anal. Appl. 13(4), 1992).
struct InformationSpectrum {
  /// Throws std::runtime_error where S is not finite.
  explicit InformationSpectrum(const Eigen::MatrixXd& information);

  Eigen::VectorXd values;   ///< not negative; 0 where S is singular
  Eigen::MatrixXd vectors;  ///< columns
};

/// Columns are changes of one std along the directions that S of variables in
/// these units determines. Directions with less than kLeastMoved are left out:
/// derivatives are exact to some 1e-8, and S along them may be rounding.
Eigen::MatrixXd DeterminedUnits(const Eigen::MatrixXd& information,
                                const Eigen::VectorXd& unit);
constexpr double kLeastMoved = 1e-6;
/// The information that a covariance is bounded by.
constexpr double kLeastInformation = 1e-8;

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_INFORMATION_SPECTRUM_H_
