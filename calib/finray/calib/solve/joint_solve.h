#ifndef FINRAY_CALIB_SOLVE_JOINT_SOLVE_H_
#define FINRAY_CALIB_SOLVE_JOINT_SOLVE_H_

#include <ceres/problem.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_blocks.h"
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
class JointSolve {
 public:
  /// A frame and where its contact (l_c, f_c) is kept; null without contact.
  struct Frame {
    const CalibrationFrame* frame;
    double* contact;
    LadderState* state;  ///< to start from, and left at the solution
  };

  /// All pointers must stay in place; those to contacts ascend with the frames.
  JointSolve(const Finger& finger, const Discretization& discretization,
             const Plan& plan, const CalibrationBlocks& blocks,
             CalibrationParameters* parameters,
             const std::vector<Frame>& frames, int threads);

  struct Limits {
    int iterations = 200;
    /// A step that lowers the cost by less than this share is the last.
    double function_tolerance = 1e-12;
  };
  SolveReport Solve(const Limits& limits);

 private:
  void AddFrame(const Frame& frame, const CalibrationBlocks& blocks);
  void AddPriors();
  void FixWhatIsNotFree();

  const Finger& finger_;
  const Plan& plan_;
  CalibrationParameters& parameters_;
  FrameSet evaluations_;
  std::vector<Frame> frames_;
  std::vector<FrameEvaluation*> evaluation_of_;  // null on the bench
  std::unique_ptr<ceres::LossFunction> loss_;
  std::unique_ptr<ceres::Problem> problem_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_JOINT_SOLVE_H_
