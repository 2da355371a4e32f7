#ifndef FINRAY_CALIB_SOLVE_SUMMED_SOLVE_H_
#define FINRAY_CALIB_SOLVE_SUMMED_SOLVE_H_

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/joint_solve.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

/// Fits the contacts of the frames at the present values and gathers what the
/// frames say about the parameters. Returns nothing if the model cannot be
/// evaluated at one of them; the contacts then stay where they were.
std::optional<Linearization> FitFrames(const std::vector<int>& frames,
                                       CalibrationProblem* problem,
                                       ContactStore* contacts);

/// The cost of frames and priors near the present values of the free parameters
/// x. Each x has its best contacts (Linearization):
///
///   cost(x + dx) = cost + g' dx + dx' S dx / 2.
struct FrameSums {
  Eigen::MatrixXd information;  ///< S
  Eigen::VectorXd gradient;     ///< g
  double cost = 0;
};

/// Adds the priors at the present values.
FrameSums SumsWithPriors(const Linearization& at,
                         const CalibrationParameters& parameters);

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

struct SummedSolution {
  SolveReport report;
  Linearization at;  ///< The frames at the solution.
};

/// Solves for the parameters by these frames, through FrameSumResidual. The
/// present values must be near the solution. Every pass fits the contact of
/// each frame by itself. Time is linear in the number of frames, and memory is
/// that of a Linearization. `start` saves the first pass if it is the
/// linearization of these frames at the present values. Throws
/// std::runtime_error if the model cannot be evaluated.
SummedSolution SolveSummed(const std::vector<int>& frames,
                           std::optional<Linearization> start,
                           CalibrationProblem* problem, ContactStore* contacts);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_SUMMED_SOLVE_H_
