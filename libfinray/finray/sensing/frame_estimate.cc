#include "finray/sensing/frame_estimate.h"

#include <cmath>

#include "finray/sensing/chi_squared.h"

namespace finray {

const char* StatusName(FrameStatus status) {
  switch (status) {
    case FrameStatus::kOk:
      return "ok";
    case FrameStatus::kNoContact:
      return "no_contact";
    case FrameStatus::kUnobservable:
      return "unobservable";
    case FrameStatus::kNotConverged:
      return "not_converged";
    case FrameStatus::kBadInput:
      return "bad_input";
  }
  return "";
}

double FrameEstimate::p_value() const { return ChiSquaredTail(chi2, dof); }

double FrameEstimate::noise_scale() const {
  return p_value() < kUnexplained ? std::sqrt(chi2 / dof) : 1;
}

}  // namespace finray
