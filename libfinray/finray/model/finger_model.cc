#include "finray/model/finger_model.h"

#include <algorithm>

namespace finray {

void FingerModel::Begin(const StartState& start) {
  start_ = &start;
  is_near_ = solver_is_near_ = by_surface_ = false;
}

void FingerModel::Stay(const FrameEvaluation& frame) {
  if (by_surface_) return;
  near_ = frame.state();
  solver_is_near_ = true;
}

bool FingerModel::Evaluate(const double* contacts, bool all,
                           FrameEvaluation* frame) {
  by_surface_ = TakeFromSurface(contacts, all, frame);
  return by_surface_ || (source_.solves && Solve(contacts, frame));
}

bool FingerModel::TakeFromSurface(const double* contacts, bool all,
                                  FrameEvaluation* frame) {
  if (source_.surface == nullptr || !frame->FitsSurface()) return false;
  auto [arc_mm, normal_N] =
      frame->contacts() == 1 ? std::array<double, 2>{contacts[0], contacts[1]}
                             : FreeContact(finger());
  arc_mm = std::clamp(arc_mm, 0.0, finger().front_length_mm);
  if (!source_.surface->Evaluate(arc_mm, normal_N, all, &values_)) return false;
  frame->Take(contacts, values_.outputs, values_.d_outputs, values_.by_place);
  return true;
}

bool FingerModel::Solve(const double* contacts, FrameEvaluation* frame) {
  if (!is_near_) {
    (*start_)(contacts, &near_);
    is_near_ = true;
    // The solver drops the mesh that another frame has refined. Otherwise
    // results would depend on which thread had which frame. A state of the
    // table brings its mesh along.
    if (near_.q.size() == 0) solver_.Reset();
  }
  // Where the solver is there already, it knows the way on.
  if (solver_is_near_) {
    frame->StartFromSolver();
  } else if (near_.q.size() > 0) {
    frame->set_state(near_);
  } else {
    frame->set_state(LadderState::Undeformed(solver_.model()));
  }
  solver_is_near_ = false;
  frame->set_by_parameter(source_.by_parameter);
  frame->Update(contacts, *source_.parameters, &solver_);
  return frame->valid();
}

}  // namespace finray
