#include "finray/calib/analysis/unsupported.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "finray/calib/problem/median.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// Says whether a fitted frame shows this offset without a load.
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

// Returns the median ratio of the gains to their initial values.
double UsualGain(const CalibrationParameters& parameters) {
  std::vector<double> ratios;
  for (const int i : parameters.free()) {
    const CalibrationParameter& p = parameters.all()[i];
    if (p.family == ParameterFamily::kGaugeGain) {
      ratios.push_back(std::abs(*p.variable / p.initial));
    }
  }
  return ratios.empty() ? 0 : Median(ratios);
}

// `off` is x - m and `share` is s^2, both in units of s_p. If the prior is
// true, values scatter about its mean by s_p^2 - s^2. Without the prior they
// would be further off by (x - m) s^2 / (s_p^2 - s^2).
bool IsContradicted(double off, double share) {
  const double rest = 1 - share;
  if (rest < 1e-6) return false;  // the data say nothing
  return std::abs(off) > kContradiction * std::sqrt(rest) &&
         std::abs(off) * std::sqrt(share) > rest;
}

}  // namespace

void FindUnsupported(CalibrationProblem& problem, Identifiability* found,
                     std::vector<Warning>* warnings) {
  const CalibrationParameters& parameters = problem.parameters();
  std::string offsets, contradicted, far;  // the parameters with these faults
  const auto list = [](const std::string& words, std::string* listed) {
    *listed += (listed->empty() ? "" : ", ") + words;
  };
  const double usual = UsualGain(parameters);
  const Eigen::VectorXd shares = found->covariance.diagonal();
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    if (found->status[k] == ParameterStatus::kUnidentifiable) continue;
    const CalibrationParameter& p = parameters.FreeParameter(k);
    const double value = *p.variable, std = found->std[k];
    const double off = p.PriorResidual();
    const bool dead =
        p.family == ParameterFamily::kGaugeGain &&
        std::abs(value) < std::max(kInsignificant * std,
                                   kDeadShare * usual * std::abs(p.initial));
    const bool contradicts =
        !dead && IsContradicted(off, shares[static_cast<Eigen::Index>(k)]);
    const bool guessed = !p.prior_std || *p.prior_std > p.vague_std;
    const bool never_unloaded =
        p.family == ParameterFamily::kGaugeOffset && guessed &&
        !HasUnloadedReading(problem, p.variable, p.gauge);
    if (dead) {
      warnings->push_back(
          {"dead_gauge",
           FormatText("gauge %d does not respond to the load: its gain is %.2g "
                      "+- %.1g V/rad",
                      p.gauge + 1, value, std),
           "check its wiring and the column it is read from; a finger without "
           "this gauge can be calibrated"});
    }
    if (contradicts) {
      list(p.name + FormatText(" (%.3g prior std off)", off), &contradicted);
    } else if (!dead && std::abs(off) > kFarFromPrior) {
      list(p.name + FormatText(" (%.3g)", off), &far);
    }
    if (never_unloaded) list(p.name, &offsets);
    if (dead || contradicts || never_unloaded) {
      found->status[k] = ParameterStatus::kUnidentifiable;
    }
  }
  if (!offsets.empty()) {
    warnings->push_back(
        {"no_free_frame",
         "no fitted frame shows the gauges without contact; only the model "
         "tells " +
             offsets,
         "record some ten frames without contact in every log, or fix "
         "gauge_offset, or give it a prior_std_V of 0.01 or less"});
  }
  if (!contradicted.empty()) {
    warnings->push_back(
        {"prior_contradicted",
         "the data contradict the priors of these parameters; the results lie "
         "between the two and shift other parameters: " +
             contradicted,
         "start from a finger closer to the truth, or leave these priors out "
         "of the plan"});
  }
  if (!far.empty()) {
    warnings->push_back(
        {"far_from_prior",
         "the logs move these parameters far from where the finger's drawing "
         "and the plan expect them, in std of their priors: " +
             far,
         "correct the finger's drawing or raise the prior's std; if both are "
         "right, the model lacks something that these parameters take up"});
  }
}

}  // namespace finray
