#ifndef FINRAY_CALIB_SOLVE_FRAME_SUM_RESIDUAL_H_
#define FINRAY_CALIB_SOLVE_FRAME_SUM_RESIDUAL_H_

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <functional>

namespace finray {

/// The cost of frames and priors near the present values of the free parameters
/// x. Each x has its best contacts (Linearization):
///
///   cost(x + dx) = cost + g' dx + dx' S dx / 2.
struct FrameSums {
  Eigen::MatrixXd information;  ///< S
  Eigen::VectorXd gradient;     ///< g
  double cost = 0;
};

/// One residual block for any number of frames. Its unknowns are z, with x =
/// x_0 + T z. T is such that the information about z at x_0 is the identity:
///
///   r = (D^-1/2 V' T'g, sqrt(2 cost - |D^-1/2 V' T'g|^2)),
///   J = (D^1/2 V', 0),                V D V' = T'S T.
///
/// So |r|^2 / 2, J'r and J'J are the cost, gradient and information of the
/// frames. Ceres needs no more to find the minimum, and memory does not grow
/// with the number of frames.
class FrameSumResidual : public ceres::CostFunction {
 public:
  /// Computes the sums at x. Returns false if the model cannot be evaluated
  /// there. Ceres asks for the values and the derivatives at a point in two
  /// calls, so the evaluator should remember the last point.
  using Evaluator =
      std::function<bool(const Eigen::VectorXd& x, FrameSums* sums)>;

  FrameSumResidual(const Eigen::VectorXd& start, const Eigen::MatrixXd& units,
                   Evaluator evaluator);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::VectorXd start_;
  Eigen::MatrixXd units_;  // T
  Evaluator evaluator_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_FRAME_SUM_RESIDUAL_H_
