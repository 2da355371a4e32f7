#ifndef FINRAY_FIT_LINEARIZED_FRAME_H_
#define FINRAY_FIT_LINEARIZED_FRAME_H_

#include <Eigen/Core>
#include <vector>

#include "finray/residuals/residual_family.h"

namespace finray {

/// The measurements of one frame at the present parameters and contact, and
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
  std::vector<Row> rows;
  Eigen::VectorXd residuals;  ///< r, without weights.
  Eigen::VectorXd weights;    ///< w.
  Rows by_parameter;          ///< C, rows x free parameters, weighted.
  /// E, rows x (l_c, f_c), weighted. It is zero for a free frame.
  Eigen::Matrix<double, Eigen::Dynamic, 2> by_contact;
  double cost = 0;  ///< The sum of rho / 2.

  Eigen::VectorXd WeightedResiduals() const {
    return weights.cwiseProduct(residuals);
  }
  /// The contact should move by A + B dx when the parameters move by dx:
  /// (A | B) = -(E'E)^-1 E'(r | C).
  struct ContactMove {
    Eigen::Vector2d now = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> by_parameter;
    double decrease = 0;  ///< The move A lowers the cost by this.
  };
  ContactMove move;
  /// The rows with the contact eliminated, C - E (E'E)^-1 E'C. They say what
  /// the frame tells about the parameters if l_c and f_c may be anything. Their
  /// product with themselves is the information of the frame.
  Rows reduced;

  /// Computes `move` and `reduced` from the rest.
  void Eliminate();
};

/// Inverts the part of a 2 x 2 information matrix that is more than rounding.
/// For example, a contact without force says nothing about its place.
Eigen::Matrix2d PseudoInverse(const Eigen::Matrix2d& information);

/// Returns C - E (E'E)^-1 E'C.
Eigen::MatrixXd EliminateContact(
    const Eigen::MatrixXd& by_parameter,
    const Eigen::Matrix<double, Eigen::Dynamic, 2>& by_contact);

}  // namespace finray

#endif  // FINRAY_FIT_LINEARIZED_FRAME_H_
