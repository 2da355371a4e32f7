#ifndef FINRAY_ESTIMATION_LOG_PRIOR_H_
#define FINRAY_ESTIMATION_LOG_PRIOR_H_

#include <Eigen/Core>

namespace finray {

/// A Gaussian on the first frame of a LogProblem: its offsets and, if the frame
/// before has a contact too, (l_c, f_c) behind them. The frames before it
/// determine the Gaussian. Empty if nothing is known.
struct LogPrior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd information;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_LOG_PRIOR_H_
