#ifndef FINRAY_CALIB_SOLVE_FRAME_SUM_RESIDUAL_H_
#define FINRAY_CALIB_SOLVE_FRAME_SUM_RESIDUAL_H_

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <functional>

namespace finray {

/// The cost of frames and priors near the present values of the free
/// parameters x, with the best contacts for each x (Linearization):
///
///   cost(x + dx) = cost + g' dx + dx' S dx / 2.
struct FrameSums {
  Eigen::MatrixXd information;  ///< S
  Eigen::VectorXd gradient;     ///< g
  double cost = 0;
};

/// Any number of frames as one residual block over z, x = x_0 + T z, with T
/// such that the information at x_0 is that of z of std 1:
///
///   r = (D^-1/2 V' T'g, sqrt(2 cost - |D^-1/2 V' T'g|^2)),
///   J = (D^1/2 V', 0),                V D V' = T'S T,
///
/// so that |r|^2 / 2, J'r and J'J are the frames' cost, gradient and
/// information. Ceres needs no more to find the minimum, and memory does not go
/// with the number of frames.
class FrameSumResidual : public ceres::CostFunction {
 public:
  /// Sums at x; false if the model cannot be evaluated there.
  using Evaluator =
      std::function<bool(const Eigen::VectorXd& x, FrameSums* sums)>;

  /// `at_start`: the sums there.
  FrameSumResidual(const Eigen::VectorXd& start, const Eigen::MatrixXd& units,
                   const FrameSums& at_start, Evaluator evaluator);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  bool EvaluateAt(const Eigen::VectorXd& z) const;
  void Compress(const FrameSums& sums) const;

  Eigen::VectorXd start_;
  Eigen::MatrixXd units_;  // T
  Evaluator evaluator_;
  // Ceres asks for values and derivatives of a point one after the other.
  mutable Eigen::VectorXd at_;
  mutable bool valid_;
  mutable Eigen::VectorXd residuals_;
  mutable Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      jacobian_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_FRAME_SUM_RESIDUAL_H_
