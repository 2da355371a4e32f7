#include "finray/calib/analysis/stage_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {
namespace {

// Frees nothing but where each log's stage is.
Plan StageOnly(const Plan& plan) {
  Plan only = plan;
  for (int i = 0; i < kParameterFamilies; ++i) {
    only.Fix(static_cast<ParameterFamily>(i));
  }
  only.holdout_by = HoldoutBy::kNothing;
  for (const ParameterFamily which :
       {ParameterFamily::kObjectOrigin, ParameterFamily::kObjectRotation}) {
    FamilyPlan& family = only.families[static_cast<int>(which)];
    family = plan.family(which);
    family.per_log = true;
  }
  return only;
}

// Says that no stage makes the log that of this finger. The errors of its
// calibration may be some times the noise of means, and pass.
bool IsUnexplained(const Identifiability& found) {
  constexpr double kMostStd = 5, kEnoughDof = 5;
  return std::any_of(std::begin(found.noise), std::end(found.noise),
                     [](const Identifiability::Noise& noise) {
                       return noise.dof >= kEnoughDof &&
                              noise.chi2 > kMostStd * kMostStd * noise.dof;
                     });
}

}  // namespace

std::vector<FittedStage> AlignStages(const Finger& finger, const Plan& plan,
                                     const Discretization& discretization,
                                     int threads, CalibrationLogs* logs) {
  if (!plan.family(ParameterFamily::kObjectOrigin).free ||
      !plan.scene.circle_radius_mm()) {
    return {};
  }
  std::vector<int> places(logs->paths.size());
  for (const CalibrationFrame& frame : logs->frames) {
    places[frame.log] += frame.contact && frame.object_mm.allFinite();
  }
  // A log with few places lends none to the fit, and so has no parameters.
  CalibrationLogs aligned = *logs;
  for (CalibrationFrame& frame : aligned.frames) {
    frame.held_out = places[frame.log] < kFewestAligned;
  }
  if (std::all_of(aligned.frames.begin(), aligned.frames.end(),
                  [](const auto& frame) { return frame.held_out; })) {
    return {};
  }
  CalibrationProblem problem(finger, StageOnly(plan), aligned, discretization,
                             threads);
  CalibrationSolution solution;
  try {
    solution = SolveRobustly(&problem);
  } catch (const std::runtime_error&) {
    return {};
  }
  if (!solution.solve.converged || solution.outliers_too_many) return {};
  const Identifiability found = AnalyzeIdentifiability(&problem, solution.at);
  if (IsUnexplained(found)) return {};
  CalibrationParameters& parameters = problem.parameters();
  std::vector<FittedStage> stages;
  for (int log = 0; log < static_cast<int>(places.size()); ++log) {
    if (places[log] < kFewestAligned) continue;
    const StageFrame stage = parameters.Stage(log);
    FittedStage fitted{log, stage.origin_mm, {0, 0}};
    fitted.rotation_deg = stage.rotation_deg;
    for (std::size_t k = 0; k < parameters.free().size(); ++k) {
      const CalibrationParameter& p = parameters.FreeParameter(k);
      const double* const origin = parameters.object_origin_mm(log);
      const bool x = p.variable == origin, y = p.variable == origin + 1;
      if (!x && !y && p.variable != parameters.object_rotation_deg(log)) {
        continue;
      }
      (x   ? fitted.origin_std_mm.x()
       : y ? fitted.origin_std_mm.y()
           : fitted.rotation_std_deg) = found.bounded_std[k];
      if (!p.prior_std) continue;
      fitted.over_prior = std::max(
          fitted.over_prior, std::abs(*p.variable - p.initial) / *p.prior_std);
    }
    stages.push_back(fitted);
  }
  for (CalibrationFrame& frame : logs->frames) {
    if (places[frame.log] < kFewestAligned) continue;
    frame.object_mm = parameters.Stage(frame.log).InS(frame.object_mm);
  }
  return stages;
}

}  // namespace finray
