#ifndef FINRAY_CALIB_SOLVE_JOINT_PROBLEM_H_
#define FINRAY_CALIB_SOLVE_JOINT_PROBLEM_H_

#include <ceres/loss_function.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <memory>
#include <vector>

#include "finray/calib/solve/joint_solve.h"
#include "finray/residuals/frame_set.h"

namespace finray {

/// The parameters and the unknowns of some frames as one ceres::Problem. In the
/// reduced form the unknowns of a frame are l_c and f_c of its contact, and
/// Ceres eliminates them (DENSE_SCHUR). In the weighted form they are the base
/// loads and rib tensions too, which start in equilibrium, and Ceres solves for
/// all by DENSE_QR, so that time grows with the cube of the frames.
class JointProblem {
 public:
  /// Frames start from the contacts of the store.
  JointProblem(const std::vector<int>& frames, EquilibriumForm form,
               CalibrationProblem* problem, ContactStore* contacts);

  /// Solves, and leaves parameters and contacts at the solution. `ready()` must
  /// be true. A further solve goes on from there.
  SolveReport Solve(const JointLimits& limits);

  /// The weight of EquilibriumResidual in the weighted form.
  void set_weight(double weight);

  /// False if a frame of the weighted form has no equilibrium to start from.
  bool ready() const { return ready_; }

 private:
  void AddFrame(int frame);
  // Starts base loads and tensions in equilibrium with the contact.
  double* StartWeighted(int frame, const double* contact);
  void AddPriors();
  std::shared_ptr<ceres::ParameterBlockOrdering> FixAndOrder();

  // The unknowns of a frame in the weighted form end with its contact.
  struct WeightedFrame {
    const double* contact;
    double* in_store;
  };

  CalibrationProblem& problem_;
  ContactStore& contacts_;
  EquilibriumForm form_;
  bool ready_ = true;
  FrameSet evaluations_;
  EquilibriumSolver solver_;
  std::vector<double> unknowns_;  // of all frames of the weighted form
  std::vector<WeightedFrame> weighted_;
  ceres::LossFunctionWrapper equilibrium_loss_;
  std::unique_ptr<ceres::LossFunction> loss_;
  std::unique_ptr<ceres::Problem> residuals_;
  std::vector<double*> frame_blocks_;  // of the frames, eliminated first
  std::size_t frames_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_JOINT_PROBLEM_H_
