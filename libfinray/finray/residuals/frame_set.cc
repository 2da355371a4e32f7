#include "finray/residuals/frame_set.h"

#include <atomic>
#include <utility>

#include "finray/residuals/parallel_frames.h"

namespace finray {

FrameSet::FrameSet(const Finger& finger, const Discretization& discretization,
                   EquilibriumForm form, const SharedParameters* shared,
                   int threads)
    : solver_(finger, discretization),
      form_(form),
      shared_(shared),
      threads_(threads) {
  solver_.model().set_effects(shared->effects, shared->friction_varies);
}

FrameEvaluation& FrameSet::Add(int contacts, double friction,
                               const double* frame, bool pins,
                               bool movable_gauges, RowFriction row) {
  frames_.push_back({FrameEvaluation(solver_.model(), form_, contacts, friction,
                                     pins, movable_gauges, row),
                     frame});
  return frames_.back().evaluation;
}

// Says whether any parameter has changed since the last evaluation. With
// bounds, Ceres searches along each step and then asks again for the point
// where the search ended.
bool FrameSet::Moved() {
  std::vector<double> at = {shared_->ln_front_stiffness,
                            shared_->ln_back_stiffness};
  for (const auto* all :
       {&shared_->rib_lengths_mm, &shared_->gauge_starts_mm,
        &shared_->gauge_lengths_mm, &shared_->effect_values}) {
    at.insert(at.end(), all->begin(), all->end());
  }
  for (const Frame& frame : frames_) {
    at.insert(at.end(), frame.unknowns,
              frame.unknowns + frame.evaluation.frame_size());
  }
  if (at == evaluated_at_) return false;
  evaluated_at_ = std::move(at);
  return true;
}

void FrameSet::PrepareForEvaluation(bool /*evaluate_jacobians*/,
                                    bool new_evaluation_point) {
  // Derivatives are always computed along with the values: they cost little
  // beside the solve, and Ceres needs them next at every point that it accepts.
  if (!new_evaluation_point || !Moved()) return;
  // Ceres rejects the step if one frame has no equilibrium. The search for a
  // missing equilibrium takes long, so the other frames are skipped.
  std::atomic<bool> failed = false;
  const auto update = [&](Frame& frame, EquilibriumSolver* solver) {
    if (failed || exhausted()) {
      frame.evaluation.Invalidate();
      return;
    }
    frame.evaluation.Update(frame.unknowns, *shared_, solver);
    if (form_ == EquilibriumForm::kReduced) {
      const double took = 1.0 * solver->iterations() * solver->unknowns();
      for (double work = work_;
           !work_.compare_exchange_weak(work, work + took);) {
      }
    }
    if (!frame.evaluation.valid()) failed = true;
  };
  if (threads_ <= 1 || frames_.size() < 2) {
    for (Frame& frame : frames_) update(frame, &solver_);
    return;
  }
  VisitInParallel(frames_.size(), threads_, solver_,
                  [&](std::size_t i, EquilibriumSolver* solver) {
                    update(frames_[i], solver);
                  });
}

}  // namespace finray
