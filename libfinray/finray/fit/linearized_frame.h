#ifndef FINRAY_FIT_LINEARIZED_FRAME_H_
#define FINRAY_FIT_LINEARIZED_FRAME_H_

#include <Eigen/Core>
#include <vector>

#include "finray/fit/contact_covariance.h"
#include "finray/residuals/residual_family.h"

namespace finray {

/// The measurements of one frame at the present parameters and contacts, and
/// their derivatives: the rows of the frame in [C | E]. They are in units of
/// their std. The robust loss weights them by
///
///   w = sqrt(rho'(|r|^2)),
///
/// with |r|^2 over the residuals of one measurement.
struct LinearizedFrame {
  struct Row {
    ResidualFamily family;
    int gauge;         ///< The gauge of kGauge and kBench, else -1.
    double std_V = 0;  ///< Of the reading, for kGauge.
  };
  using Rows =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// Rows by (l_c, f_c) of each contact.
  using ContactRows =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor,
                    Eigen::Dynamic, 2 * kFittedContacts>;
  std::vector<Row> rows;
  Eigen::VectorXd residuals;  ///< r, without weights.
  Eigen::VectorXd weights;    ///< w.
  Rows by_parameter;          ///< C, rows x free parameters, weighted.
  /// E, rows x (l_c, f_c of each contact), weighted. A free frame has the two
  /// columns of one contact, which are zero.
  ContactRows by_contact;
  double cost = 0;  ///< The sum of rho / 2.

  /// An expression of the members: keep it in a vector.
  auto WeightedResiduals() const { return weights.cwiseProduct(residuals); }
  /// E'E, the Fisher information of the contacts where nothing else is unknown.
  /// CovarianceOf (contact_covariance.h) is its inverse.
  ContactMatrix Information() const;
  /// The contacts should move by A + B dx when the parameters move by dx:
  /// (A | B) = -(E'E)^-1 E'(r | C).
  struct ContactMove {
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kFittedContacts, 1> now;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor,
                  2 * kFittedContacts, Eigen::Dynamic>
        by_parameter;
    double decrease = 0;  ///< The move A lowers the cost by this.
  };
  ContactMove move;
  /// The rows with the contacts eliminated, C - E (E'E)^-1 E'C. They say what
  /// the frame tells about the parameters if the contacts may be anything.
  /// Their product with themselves is the information of the frame.
  Rows reduced;

  /// Returns these rows alone, by their indices, without `move`, `reduced` and
  /// the cost.
  LinearizedFrame WithRows(const std::vector<int>& indices) const;

  /// Computes `move` and `reduced` from the rest, with the part of E'E that is
  /// more than rounding, or with its inverse.
  void Eliminate();
  void Eliminate(const ContactMatrix& inverse);

 private:
  ContactRows scaled_;  // -E (E'E)^-1
};

/// Inverts the part of an information matrix of one contact that is more than
/// rounding. For example, a contact without force says nothing about its place.
Eigen::Matrix2d PseudoInverse(const Eigen::Matrix2d& information);

}  // namespace finray

#endif  // FINRAY_FIT_LINEARIZED_FRAME_H_
