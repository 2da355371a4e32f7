#include "finray/calib/calibration_result.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "finray/calib/finger_covariance.h"

namespace finray {
namespace {

std::string Text(const char* format, double a, double b = 0) {
  char text[256];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

// A chi2 / dof beyond these says that a std in the plan is not what it is.
constexpr double kTooNoisy = 2;
constexpr double kTooQuiet = 0.5;
constexpr double kEnoughDof = 5;

void WarnOfNoise(const Identifiability& found,
                 std::vector<CalibrationWarning>* warnings) {
  for (int i = 0; i < kResidualFamilies; ++i) {
    const Identifiability::Noise& noise = found.noise[i];
    if (noise.dof < kEnoughDof) continue;
    const double ratio = noise.chi2 / noise.dof;
    const std::string name = ResidualFamilyName(static_cast<ResidualFamily>(i));
    if (ratio > kTooNoisy) {
      warnings->push_back(
          {"noise_above_plan",
           name + Text(" residuals are %.1f times what their std says "
                       "(chi2/dof %.3g); reported std are too small by that",
                       std::sqrt(ratio), ratio),
           "look at the residuals by frame for outliers or a wrong model; "
           "raise "
           "the std in the plan's measurements if the sensor is that noisy"});
    } else if (ratio < kTooQuiet) {
      warnings->push_back(
          {"noise_below_plan",
           name + Text(" residuals are %.2f of what their std says (chi2/dof "
                       "%.3g)",
                       std::sqrt(ratio), ratio),
           "lower the std in the plan's measurements; reported std are too "
           "large"});
    }
  }
}

void WarnOfWeakness(CalibrationProblem& problem, const Identifiability& found,
                    std::vector<CalibrationWarning>* warnings) {
  std::string unidentifiable;
  const CalibrationParameters& parameters = problem.parameters();
  for (std::size_t i = 0; i < found.status.size(); ++i) {
    if (found.status[i] != ParameterStatus::kUnidentifiable) continue;
    unidentifiable += (unidentifiable.empty() ? "" : ", ") +
                      parameters.all()[parameters.free()[i]].name;
  }
  if (!unidentifiable.empty()) {
    warnings->push_back({"unidentifiable",
                         "the data do not determine " + unidentifiable,
                         found.weak.empty() ? "" : found.weak[0].remedy});
  }
  for (const WeakDirection& weak : found.weak) {
    warnings->push_back(
        {"weak_direction",
         weak.words + (weak.null ? std::string(": the data do not say how far")
                                 : Text(": the data leave a std of %.3g times "
                                        "the prior's",
                                        weak.std_over_prior)),
         weak.remedy});
  }
}

void WarnOfForces(const ForceCheck& forces, double force_std_N,
                  std::vector<CalibrationWarning>* warnings) {
  const ForceCheck::Error& held_out = forces.held_out;
  if (held_out.frames >= 10 &&
      held_out.after_rms_N > 2 * forces.fitted.after_rms_N) {
    warnings->push_back(
        {"holdout_worse",
         Text("held-out frames are off by %.3g N rms, fitted ones by %.3g N",
              held_out.after_rms_N, forces.fitted.after_rms_N),
         "record logs that cover what the finger will meet: heights and "
         "loads"});
  }
  if (forces.fitted.frames > 0 &&
      forces.fitted.after_rms_N > forces.fitted.before_rms_N + force_std_N) {
    warnings->push_back(
        {"no_better",
         Text("force from the gauges is off by %.3g N rms after and %.3g N "
              "before",
              forces.fitted.after_rms_N, forces.fitted.before_rms_N),
         "check the columns and units of the logs and the finger's geometry"});
  }
}

}  // namespace

bool CalibrationResult::AllIdentified() const {
  return std::none_of(
      identifiability.status.begin(), identifiability.status.end(),
      [](ParameterStatus s) { return s == ParameterStatus::kUnidentifiable; });
}

CalibrationResult Calibrate(CalibrationProblem* problem,
                            const Discretization& discretization, int threads) {
  CalibrationResult result;
  result.solve = problem->Solve();
  problem->ZeroHeldOutLogs();
  result.identifiability = AnalyzeIdentifiability(problem);
  result.finger = problem->parameters().Apply(problem->finger());
  KeepCovariance(problem->parameters(), result.identifiability, &result.finger);
  result.forces = CheckForces(
      problem->finger(), result.finger, problem->plan(), problem->logs(),
      problem->parameters().Corrected(problem->logs(), result.finger),
      discretization, threads);
  result.bench =
      TestBenchLinearity(problem->finger(), problem->plan(), problem->logs());
  if (!result.solve.converged) {
    result.warnings.push_back(
        {"not_converged", "the solver stopped early: " + result.solve.message,
         "give priors, or start from a finger closer to the truth"});
  }
  WarnOfWeakness(*problem, result.identifiability, &result.warnings);
  WarnOfNoise(result.identifiability, &result.warnings);
  WarnOfForces(result.forces, problem->plan().force_std_N, &result.warnings);
  for (const BenchLinearity& gauge : result.bench) {
    if (gauge.IsLinear()) continue;
    result.warnings.push_back(
        {"gauge_not_linear", gauge.Words(),
         "bend the gauge only as far as the finger will, or calibrate its gain "
         "on the finger against a force sensor"});
  }
  return result;
}

}  // namespace finray
