#ifndef FINRAY_RESIDUALS_FRAME_SET_H_
#define FINRAY_RESIDUALS_FRAME_SET_H_

#include <ceres/evaluation_callback.h>

#include <atomic>
#include <deque>
#include <limits>
#include <vector>

#include "finray/model/frame_evaluation.h"
#include "finray/model/shared_parameters.h"

namespace finray {

/// The frames of a ceres::Problem, and the problem's evaluation callback.
/// Before Ceres evaluates the residual blocks, the set evaluates all frames in
/// parallel, unless no parameter has changed since the last time. Each frame
/// starts from its own state. The results therefore do not depend on the number
/// of threads, as long as all frames can be evaluated.
class FrameSet : public ceres::EvaluationCallback {
 public:
  /// `shared` must stay in place; Ceres varies it, but not what its effects
  /// are.
  FrameSet(const Finger& finger, const Discretization& discretization,
           EquilibriumForm form, const SharedParameters* shared, int threads);

  /// Adds a frame with its unknowns at `frame`, which must stay in place; null
  /// if it has none. With `pins`, the rib pins are among its outputs. The
  /// returned reference stays valid.
  FrameEvaluation& Add(int contacts, double friction, const double* frame,
                       bool pins = false, bool movable_gauges = false,
                       RowFriction row = {});

  /// See EquilibriumSolver::set_near_only.
  void set_near_only(bool near_only) { solver_.set_near_only(near_only); }

  /// Bounds what all solves of equilibria may cost together: each counts as
  /// Newton iterations times unknowns of the mesh. Beyond, no frame is valid,
  /// so that Ceres ends. Far from any finger that bends, a solve follows load
  /// paths and takes thousands of times longer.
  void set_most_work(double most) { most_work_ = most; }
  bool exhausted() const { return work_ > most_work_; }

  /// Removes all frames.
  void Clear() {
    frames_.clear();
    evaluated_at_.clear();
  }

  void PrepareForEvaluation(bool evaluate_jacobians,
                            bool new_evaluation_point) override;

  std::size_t size() const { return frames_.size(); }
  FrameEvaluation& operator[](std::size_t i) { return frames_[i].evaluation; }
  const LadderModel& model() const { return solver_.model(); }

 private:
  struct Frame {
    FrameEvaluation evaluation;
    const double* unknowns;
  };
  bool Moved();

  EquilibriumSolver solver_;  // copied for each thread
  EquilibriumForm form_;
  const SharedParameters* shared_;
  int threads_;
  std::deque<Frame> frames_;
  double most_work_ = std::numeric_limits<double>::infinity();
  std::atomic<double> work_ = 0;
  std::vector<double> evaluated_at_;  // parameters, then unknowns of all frames
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_FRAME_SET_H_
