#ifndef FINRAY_CALIB_SOLVE_INFORMATION_SPECTRUM_H_
#define FINRAY_CALIB_SOLVE_INFORMATION_SPECTRUM_H_

#include <Eigen/Core>

namespace finray {

/// The eigenvalues, in ascending order, and the eigenvectors of an information
/// matrix S. The units of the variables cost no digits. Units may be far from
/// what the data tell: a prior of 2 V/rad on gains of 1e-6 V/rad spreads the
/// eigenvalues by more than a double has digits. An ordinary eigensolver then
/// returns nothing but rounding for the small ones.
///
/// With D = diag(S)^1/2 the matrix D^-1 S D^-1 = V L V' has a unit diagonal.
/// Only its condition, that of the correlations, costs digits. Then S = B'B
/// with B = L^1/2 V' D. B is a well-conditioned matrix times a diagonal one,
/// and a Jacobi method finds the singular values of such a matrix to high
/// relative precision (Demmel & Veselic, SIAM J. Matrix Anal. Appl. 13(4),
/// 1992).
struct InformationSpectrum {
  /// Throws std::runtime_error if S is not finite.
  explicit InformationSpectrum(const Eigen::MatrixXd& information);

  Eigen::VectorXd values;   ///< Not negative; 0 where S is singular.
  Eigen::MatrixXd vectors;  ///< Each column is an eigenvector.
};

/// The information of variables that are in the given units: U S U.
Eigen::MatrixXd InUnits(const Eigen::MatrixXd& information,
                        const Eigen::VectorXd& unit);

/// Returns the changes of one std, as columns, along the directions that the
/// information S determines. The variables are in the given units. Directions
/// with an information below kLeastMoved are left out: derivatives are exact to
/// some 1e-8 only, so S along them may be rounding.
Eigen::MatrixXd DeterminedUnits(const Eigen::MatrixXd& information,
                                const Eigen::VectorXd& unit);
constexpr double kLeastMoved = 1e-6;

/// Returns the inverse of an information matrix. A direction with less
/// information than kLeastInformation counts as one with so much.
Eigen::MatrixXd BoundedCovariance(const Eigen::MatrixXd& information);
constexpr double kLeastInformation = 1e-8;

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_INFORMATION_SPECTRUM_H_
