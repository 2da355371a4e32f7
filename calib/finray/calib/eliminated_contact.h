#ifndef FINRAY_CALIB_ELIMINATED_CONTACT_H_
#define FINRAY_CALIB_ELIMINATED_CONTACT_H_

#include <Eigen/Core>

#include "finray/calib/calibration_problem.h"

namespace finray {

/// The part of a 2 x 2 information matrix that is not noise, inverted; a
/// contact without force, say, says nothing of its place.
Eigen::Matrix2d PseudoInverse(const Eigen::Matrix2d& information);

/// Calls `visit(first, count)` for the rows of each frame.
template <class Visitor>
void ForEachFrame(const CalibrationProblem::Linearization& at,
                  const Visitor& visit) {
  const auto rows = static_cast<int>(at.rows.size());
  for (int first = 0; first < rows;) {
    int last = first;
    while (last < rows && at.rows[last].frame == at.rows[first].frame) ++last;
    visit(first, last - first);
    first = last;
  }
}

/// Rows of a frame with its contact eliminated, C - E (E'E)^-1 E'C: what they
/// say of the parameters when l_c and f_c may be anything. Their product
/// with themselves is the frame's information.
Eigen::MatrixXd EliminateContact(
    const Eigen::MatrixXd& by_parameter,
    const Eigen::Matrix<double, Eigen::Dynamic, 2>& by_contact);
Eigen::MatrixXd EliminateContact(const CalibrationProblem::Linearization& at,
                                 int first, int count);

}  // namespace finray

#endif  // FINRAY_CALIB_ELIMINATED_CONTACT_H_
