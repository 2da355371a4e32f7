#include "finray/calib/unsupported.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace finray {
namespace {

// Whether a frame that is fitted shows this offset without a load.
bool HasUnloadedReading(CalibrationProblem& problem, const double* offset,
                        int gauge) {
  const auto& frames = problem.logs().frames;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CalibrationFrame& frame = frames[i];
    if (frame.held_out || frame.contact ||
        !std::isfinite(frame.gauges_V[gauge]) ||
        problem.rejected().count(static_cast<int>(i)) > 0) {
      continue;
    }
    if (problem.parameters().readings.offset_V(gauge, frame.log) == offset) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<Unsupported> FindUnsupported(CalibrationProblem& problem,
                                         const Identifiability& found) {
  const CalibrationParameters& parameters = problem.parameters();
  std::vector<Unsupported> unsupported;
  Unsupported offsets;
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    if (found.status[k] == ParameterStatus::kUnidentifiable) continue;
    const CalibrationParameter& p = parameters.all()[parameters.free()[k]];
    const double value = *p.variable, std = found.std[k];
    if (p.family == ParameterFamily::kGaugeGain &&
        std::abs(value) <
            std::max(kInsignificant * std, kDeadShare * std::abs(p.initial))) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "gauge %d does not respond to the load: its gain is %.2g "
                    "+- %.1g V/rad",
                    p.gauge + 1, value, std);
      unsupported.push_back(
          {{static_cast<int>(k)},
           "dead_gauge",
           text,
           "check its wiring and the column it is read from; a finger without "
           "this gauge can be calibrated"});
    }
    const bool guessed = !p.prior_std || *p.prior_std > p.vague_std;
    if (p.family == ParameterFamily::kGaugeOffset && guessed &&
        !HasUnloadedReading(problem, p.variable, p.gauge)) {
      offsets.free.push_back(static_cast<int>(k));
      offsets.text += (offsets.text.empty() ? "" : ", ") + p.name;
    }
  }
  if (!offsets.free.empty()) {
    offsets.code = "no_free_frame";
    offsets.text =
        "no frame that is fitted shows gauges without contact; the model's "
        "word alone are " +
        offsets.text;
    offsets.remedy =
        "record some ten frames without contact in every log, or fix "
        "gauge_offset, or give it a prior_std_V of 0.01 or less";
    unsupported.push_back(offsets);
  }
  return unsupported;
}

}  // namespace finray
