#include "finray/estimation/free_frame.h"

#include <limits>

#include "finray/io/nan.h"

namespace finray {

void JudgeFree(const Measurements& row, CalibrationErrors* systematic,
               FrameEstimate* estimate) {
  if (!estimate->IsUnexplained()) return;
  if (!systematic->empty()) {
    estimate->model_chi2 = systematic->Chi2({}, row);
    if (!estimate->IsUnexplained()) return;
  }
  LeaveUnknown(estimate);
}

void LeaveUnknown(FrameEstimate* estimate) {
  FrameEstimate unknown;
  unknown.status = FrameStatus::kUnobservable;
  unknown.chi2 = estimate->chi2;
  unknown.model_chi2 = estimate->model_chi2;
  unknown.dof = estimate->dof;
  unknown.rib_tension_N.assign(estimate->rib_tension_N.size(), kNaN);
  *estimate = unknown;
}

double OffsetsWander_V(const Scene& scene) {
  return scene.gauge_offset_walk ? std::numeric_limits<double>::infinity() : 0;
}

}  // namespace finray
