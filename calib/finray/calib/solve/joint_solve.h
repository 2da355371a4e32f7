#ifndef FINRAY_CALIB_SOLVE_JOINT_SOLVE_H_
#define FINRAY_CALIB_SOLVE_JOINT_SOLVE_H_

#include <ceres/problem.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "finray/calib/problem/measurement_blocks.h"
#include "finray/residuals/frame_set.h"

namespace finray {

/// How a solve went.
struct SolveReport {
  bool converged = false;
  int iterations = 0;
  double initial_cost = 0;
  double final_cost = 0;
  std::string message;
};

/// Parameters and the contacts of some frames in one ceres::Problem, from which
/// Ceres eliminates the contacts (DENSE_SCHUR). Finds its way from far, as
/// contacts need not be where they explain their frame best before the gains
/// are known. Memory and time go with the number of frames: some thousand are
/// plenty to come near enough for FrameSumResidual.
///
/// In the weighted form base loads and rib tensions are unknowns of a frame as
/// well, and equilibrium is one of its residuals.
class JointSolve {
 public:
  /// A frame and where its unknowns are kept (those of FrameEvaluation: the
  /// contact, in the weighted form behind q); null without any.
  struct Frame {
    const CalibrationFrame* frame;
    double* unknowns;
    LadderState* state;  ///< to start from, and left at the solution
  };

  /// All pointers must stay in place; for Solve those to unknowns ascend with
  /// the frames.
  JointSolve(const Finger& finger, const Discretization& discretization,
             const Plan& plan, const MeasurementBlocks& blocks,
             CalibrationParameters* parameters,
             const std::vector<Frame>& frames, int threads,
             EquilibriumForm form = EquilibriumForm::kReduced);
  /// Std differ by some 1e-4 from the reduced form's at 1e6, and by the
  /// weight's square less.
  static constexpr double kEquilibriumWeight = 1e7;

  struct Limits {
    int iterations = 200;
    /// A step that lowers the cost by less than this share is the last.
    double function_tolerance = 1e-12;
  };
  SolveReport Solve(const Limits& limits);

  /// By Gauss-Newton steps in which the unknowns of each frame are eliminated
  /// by orthogonal projection: what Solve cannot do in the weighted form, as
  /// normal equations square the weight. From near the solution, to 1e-6 of a
  /// std; costs are not reported. `information` is what the frames and the
  /// priors say there of the free parameters. The unknowns are eliminated as if
  /// without bounds, as FrameLinearizer does.
  SolveReport SolveByProjection(Eigen::MatrixXd* information);

 private:
  // A frame's whitened residuals and their derivatives.
  struct Rows {
    Eigen::VectorXd residuals;
    Eigen::MatrixXd by_parameter, by_unknown;
  };
  class Projection;
  Rows RowsOf(std::size_t frame);
  void MoveUnknowns(std::size_t frame, const Eigen::VectorXd& step);
  void AddFrame(const Frame& frame, const MeasurementBlocks& blocks);
  void AddPriors();
  void FixWhatIsNotFree();

  const Finger& finger_;
  const Plan& plan_;
  CalibrationParameters& parameters_;
  EquilibriumForm form_;
  FrameSet evaluations_;
  std::vector<Frame> frames_;
  std::vector<FrameEvaluation*> evaluation_of_;  // null on the bench
  std::unique_ptr<ceres::LossFunction> loss_;
  std::unique_ptr<ceres::Problem> problem_;
  std::vector<std::vector<ceres::ResidualBlockId>> blocks_of_;  // by frame
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_JOINT_SOLVE_H_
