#include "finray/calib/report/calibration_result.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>

#include "finray/calib/analysis/reading_noise.h"
#include "finray/calib/analysis/refit.h"
#include "finray/calib/report/doubts.h"
#include "finray/calib/solve/undecided.h"
#include "finray/estimation/gauge_table.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// If chi2 / dof is above it, a std in the plan is wrong.
constexpr double kTooNoisy = 2;

// Says that forces are means, whose std the log tells (force_scatter_N).
bool RowsAreMeans(const CalibrationLogs& logs) {
  return std::any_of(
      logs.frames.begin(), logs.frames.end(),
      [](const auto& frame) { return frame.force_std_times != 1; });
}

// The std of the family that the plan or the finger states, times a factor.
std::string StdInWords(ResidualFamily family, const CalibrationProblem& problem,
                       double times) {
  const Plan& plan = problem.plan();
  const auto words = [times](const char* key, std::optional<double> std) {
    return std ? FormatText(": %s: %.2g instead of %.2g fits", key,
                            times * *std, *std)
               : "";
  };
  switch (family) {
    case ResidualFamily::kGauge:
      return plan.gauge_std_V
                 ? words("gauge_std_V", plan.gauge_std_V)
                 : FormatText(": noise_V of the gauges times %.2f fits", times);
    case ResidualFamily::kForce:
      return RowsAreMeans(problem.logs())
                 ? FormatText(": force_scatter_N times %.2f fits", times)
                 : words("force_std_N", plan.force_std_N);
    case ResidualFamily::kObject:
      return words("object_std_mm", plan.object_std_mm);
    case ResidualFamily::kContact:
      return words("contact_std_mm", plan.contact_std_mm);
    case ResidualFamily::kPin:
      return words("pin_std_mm", plan.pin_std_mm);
    case ResidualFamily::kTip:
      return words("tip_std_mm", plan.tip_std_mm);
    default:
      return "";
  }
}

void WarnOfNoise(const CalibrationProblem& problem,
                 const Identifiability& found, std::vector<Warning>* warnings) {
  for (int i = 0; i < kResidualFamilies; ++i) {
    const Identifiability::Noise& noise = found.noise[i];
    if (noise.dof < Identifiability::Noise::kEnoughDof) continue;
    const double ratio = noise.chi2 / noise.dof;
    const std::string name = ResidualFamilyName(static_cast<ResidualFamily>(i));
    if (ratio > kTooNoisy) {
      warnings->push_back(
          {"noise_above_plan",
           name + FormatText(
                      " residuals are %.1f times what their std says "
                      "(chi2/dof %.3g); reported std are enlarged for it where "
                      "it is beyond doubt",
                      std::sqrt(ratio), ratio),
           "look at the residuals by frame for outliers or a wrong model; "
           "raise "
           "the std in the plan's measurements if the sensor is that noisy"});
    } else if (noise.IsTooQuiet()) {
      warnings->push_back({"noise_below_plan",
                           QuietInWords(static_cast<ResidualFamily>(i), noise) +
                               StdInWords(static_cast<ResidualFamily>(i),
                                          problem, std::sqrt(ratio)),
                           "lower that std; reported std are too large"});
    }
  }
}

void WarnOfTimes(const CalibrationProblem& problem,
                 std::vector<Warning>* warnings) {
  std::string text = TimesInWords(problem.logs());
  if (text.empty()) return;
  text += TimesAllow(ParameterFamily::kGaugeDrift, problem.logs())
              ? "; no late force sensor and no creep can be found"
              : "; no late force sensor, creep, drift or hysteresis can be "
                "found";
  for (const ParameterFamily family : problem.without_times()) {
    text +=
        std::string(", ") + FamilyKeyOf(family) + " of the plan stays fixed";
  }
  warnings->push_back({"times_do_not_rise", text,
                       "record time_s with all digits of its clock, rows in "
                       "their order, and each start of a logger as a log"});
}

void WarnOfStarts(const CalibrationSolution& solution,
                  std::vector<Warning>* warnings) {
  const auto& starts = solution.starts;
  if (starts.empty()) return;
  if (starts[0].distance_std >= StartReport::kSameSolution) {
    warnings->push_back(
        {"given_start_misleads",
         "the solver does not come to this solution from the given finger, "
         "but" +
             FormatText(" ends %.3g std away; the result is from another start",
                        starts[0].distance_std),
         "compare the result with what you know of the finger"});
  } else if (2 * solution.agreeing() <= static_cast<int>(starts.size())) {
    warnings->push_back(
        {"starts_disagree",
         FormatText("only %d of %zu starts come to this solution",
                    solution.agreeing(), starts.size()),
         "give priors, or start from a finger closer to the truth"});
  }
}

void WarnOfOutliers(const CalibrationProblem& problem,
                    const CalibrationSolution& solution,
                    std::vector<Warning>* warnings) {
  if (solution.outliers_too_many) {
    warnings->push_back(
        {"too_many_outliers",
         "more than a quarter of the frames are not explained within their "
         "noise; none was rejected",
         "check columns, units, the finger's geometry and the std in the "
         "plan's measurements"});
  }
  if (!solution.settled) {
    warnings->push_back({"outliers_unsettled",
                         "the outliers are other frames from round to round",
                         "look for what differs between the frames; raise the "
                         "std in the plan's measurements"});
  }
  if (problem.rejected().empty()) return;
  const auto& [index, reason] = *problem.rejected().begin();
  const CalibrationFrame& frame = problem.logs().frames[index];
  warnings->push_back(
      {"frames_rejected",
       std::to_string(problem.rejected().size()) +
           (problem.rejected().size() == 1 ? " frame was rejected, "
                                           : " frames were rejected, first ") +
           problem.logs().names[frame.log] + " row " +
           std::to_string(frame.row + 1) + ": " + reason,
       "look at rejected_frames in calibration.yaml for what went wrong "
       "there"});
}

void WarnOfWeakness(CalibrationProblem& problem, const Identifiability& found,
                    std::vector<Warning>* warnings) {
  std::string unidentifiable;
  const CalibrationParameters& parameters = problem.parameters();
  for (std::size_t i = 0; i < found.status.size(); ++i) {
    if (found.status[i] != ParameterStatus::kUnidentifiable) continue;
    unidentifiable +=
        (unidentifiable.empty() ? "" : ", ") + parameters.FreeParameter(i).name;
  }
  if (!unidentifiable.empty()) {
    warnings->push_back(
        {"unidentifiable", "the data do not determine " + unidentifiable,
         found.weak.empty() ? "record what tells them, or give priors that are"
                              " more than a guess"
                            : found.weak[0].remedy});
  }
  for (const WeakDirection& weak : found.weak) {
    warnings->push_back(
        {"weak_direction", weak.words + ": " + weak.how_far, weak.remedy});
  }
}

void WarnOfForces(const ForceCheck& forces, double force_std_N,
                  std::vector<Warning>* warnings) {
  const ErrorStatistics& was = forces.fitted.force_before_N();
  const ErrorStatistics& fitted = forces.fitted.force_after_N();
  const ErrorStatistics& held_out = forces.held_out.force_after_N();
  if (held_out.frames >= 10 && held_out.rms() > 2 * fitted.rms()) {
    warnings->push_back(
        {"holdout_worse",
         FormatText(
             "held-out frames are off by %.3g N rms, fitted ones by %.3g N",
             held_out.rms(), fitted.rms()),
         "look for outliers among them (held-out frames are never rejected); "
         "record logs that cover what the finger will meet: heights and "
         "loads"});
  }
  if (fitted.rms() > was.rms() + force_std_N) {  // not if one is NaN
    warnings->push_back(
        {"no_better",
         FormatText(
             "force from the gauges is off by %.3g N rms after and %.3g N "
             "before",
             fitted.rms(), was.rms()),
         "check the columns and units of the logs and the finger's geometry"});
  }
}

// Estimates end at the largest force of the scene, so that no check of forces
// sees how wrong they are beyond it.
void WarnOfForceLimit(const CalibrationProblem& problem,
                      const CalibrationResult& result,
                      std::vector<Warning>* warnings) {
  const double limit = problem.plan().scene.force_max_N.value_or(
      GaugeTable::HeaviestForce_N(result.finger));
  int beyond = 0;
  double heaviest = 0;
  for (const int i : result.solution.at.frames) {
    const CalibrationFrame& frame = problem.frame(i);
    const double force = frame.contact ? frame.Force().magnitude_N : 0;
    if (!(force > limit)) continue;  // nor if it is NaN
    ++beyond;
    heaviest = std::max(heaviest, force);
  }
  if (beyond == 0) return;
  warnings->push_back(
      {"forces_beyond_limit",
       FormatText("forces of %d frames reach %.3g N, and estimates end at %.3g "
                  "N%s",
                  beyond, heaviest, limit,
                  problem.plan().scene.force_max_N
                      ? ", the plan's force_max_N"
                      : ", 40 EI / l_0^2 unless the scene says otherwise"),
       FormatText("set force_max_N above %.3g in the plan's scene and in the "
                  "scenes of estimates",
                  heaviest)});
}

void WarnOfCorrelation(CalibrationProblem& problem,
                       const ResidualCorrelation& found,
                       std::vector<Warning>* warnings) {
  const ResidualCorrelation::Series* slowest = found.Slowest();
  if (!found.correlated() || slowest == nullptr) return;
  const IntegratedTime& time = slowest->time;
  std::string text = "residuals of neighbouring rows are correlated: ";
  text += ResidualFamilyName(slowest->family);
  if (slowest->gauge >= 0) text += " " + std::to_string(slowest->gauge + 1);
  text += FormatText(
      " by %.2f from row to row, over %.3g rows, so that %d count as %.0f",
      time.lag_1, time.tau, time.n, time.effective());
  const auto most =
      std::max_element(found.enlargement.begin(), found.enlargement.end()) -
      found.enlargement.begin();
  const CalibrationParameters& parameters = problem.parameters();
  text += FormatText("; std are enlarged for it, at most %.4g times (",
                     found.enlargement[most]) +
          parameters.FreeParameter(most).name + ")";
  warnings->push_back({"correlated_residuals", text,
                       "let the gauges warm up, free what drifts, record "
                       "heights and loads in random order; look at the "
                       "residuals over the rows for what the model lacks"});
}

void WarnOfDisagreement(CalibrationProblem& problem,
                        const LeaveOneLogOut& found,
                        std::vector<Warning>* warnings) {
  if (!found.all_converged) {
    warnings->push_back({"leave_one_log_out_not_converged",
                         "without one of the logs the solver does not converge",
                         "look at the logs one by one"});
  }
  const LeaveOneLogOut::Row* worst = found.Worst();
  if (worst == nullptr) return;
  warnings->push_back(
      {"logs_disagree",
       problem.parameters().all()[worst->parameter].name +
           FormatText(
               " changes by %.2g std of such a change when one of the logs is "
               "left out (p = %.1g)",
               worst->ratio(), worst->p_value),
       "look for what differs between the logs: mounting, temperature, object; "
       "take the spread in leave_one_log_out for the std until then"});
}

double EffectiveRows(const CalibrationProblem& problem,
                     const std::vector<int>& fitted) {
  double rows = 0;
  for (const int i : fitted) {
    const CalibrationFrame& frame = problem.frame(i);
    const double told =
        std::pow(std::max(frame.place_std_times, frame.readings_std_times), -2);
    // Each gauge is bent for itself.
    const auto readings =
        std::count_if(frame.gauges_V.begin(), frame.gauges_V.end(),
                      [](double volts) { return std::isfinite(volts); });
    rows += told * (frame.IsBench() ? static_cast<double>(readings) : 1);
  }
  return rows;
}

void WarnOfFewRows(const CalibrationResult& result,
                   std::vector<Warning>* warnings) {
  if (!result.TooFewRows()) return;
  warnings->push_back(
      {"too_few_rows",
       FormatText("%zu fitted rows count as %.3g, those that repeat each other "
                  "once; more parameters than that are estimated",
                  result.solution.at.frames.size(), result.effective_rows),
       "record the object at more places; many readings at one place share "
       "the error of that place"});
}

void DecideHeldOut(CalibrationProblem* problem) {
  std::vector<int> held_out;
  const auto& frames = problem->logs().frames;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].held_out) held_out.push_back(static_cast<int>(i));
  }
  ContactStore contacts(problem);
  DecideContacts(held_out, problem, &contacts);
}

}  // namespace

bool CalibrationResult::AllIdentified() const {
  const auto& status = identifiability.status;
  return std::count(status.begin(), status.end(),
                    ParameterStatus::kUnidentifiable) == 0;
}

bool CalibrationResult::TooFewRows() const {
  const auto& status = identifiability.status;
  return effective_rows <
         static_cast<double>(std::count(status.begin(), status.end(),
                                        ParameterStatus::kEstimated));
}

const ErrorStatistics& CalibrationResult::UnseenForces() const {
  const ErrorStatistics& held_out = forces.held_out.force_after_N();
  if (held_out.judged > 0) return held_out;
  return (with_discrepancy.folds > 0 ? with_discrepancy : cross_validation)
      .errors.contact.force_N;
}

std::string CalibrationResult::Verdict() const {
  if (!solution.solve.converged) return "not_converged";
  if (!solution.starts.empty() && solution.agreeing() < 2) {
    return "starts_disagree";
  }
  for (int i = 0; i < kResidualFamilies; ++i) {
    const Identifiability::Noise& noise = identifiability.noise[i];
    // Gauges that are not linear on the bench have a warning of their own.
    if (i == static_cast<int>(ResidualFamily::kBench)) continue;
    if (noise.dof >= Identifiability::Noise::kEnoughDof &&
        noise.chi2 > kUnexplained * kUnexplained * noise.dof) {
      return "unexplained";
    }
  }
  if (!AllIdentified() || TooFewRows()) return "unidentifiable";
  return doubts.empty() ? "good" : "doubtful";
}

namespace {

// Runs a step without which the solution stands. Returns why it failed, which a
// warning says, or "".
template <class Step>
std::string Try(const char* name, const Step& step,
                std::vector<Warning>* warnings) {
  try {
    step();
    return "";
  } catch (const std::runtime_error& error) {
    warnings->push_back(
        {"step_failed",
         std::string(name) + ": " + error.what() +
             "; the result is that of the solve, without this step",
         "start from a finger closer to the truth, give priors, or leave out "
         "rows with unusual forces"});
    return error.what();
  }
}

template <class Step>
void TryTest(const char* name, CalibrationResult* result, const Step& step) {
  const std::string why = Try(name, step, &result->warnings);
  if (!why.empty()) {
    result->not_tested.push_back(name + (" (" + why + ")"));
  }
}

// What frames say that the rest of them predicts: effects that the plan leaves
// out, cross-validated forces, what the model still misses.
void TestUnseen(CalibrationProblem* problem, const Identifiability& of_noise,
                const FrameEstimator* estimator, CalibrationResult* result) {
  std::optional<WideLinearization> wide;
  TryTest("effects that the plan leaves out", result, [&] {
    problem->Tell("effects that the plan leaves out");
    wide = LinearizeWide(*problem, result->solution);
    result->score = TestScores(*problem, result->identifiability, *wide);
    if (result->score.Best() == nullptr) return;
    const SolvedProblem at{problem, nullptr, result->solution,
                           CrossValidatedLogLikelihood(*problem, *wide)};
    result->score = TestScores(*problem, result->identifiability, *wide,
                               RefitRivals(at, result->score));
    if (result->score.Best() == nullptr) return;
    JudgeEffects(at, &result->score);
  });
  if (!wide) return;
  if (problem->plan().holdout_by == HoldoutBy::kNothing) {
    TryTest("cross-validation", result, [&] {
      result->cross_validation =
          CrossValidate(*problem, result->identifiability, *wide, estimator);
    });
  }
  TryTest("model error", result, [&] {
    const HeldOutErrors errors =
        GaugeErrorsOf(*problem, result->solution, of_noise, *wide);
    tbb::task_arena(problem->threads()).execute([&] {
      result->discrepancy = FitDiscrepancy(errors);
    });
  });
  if (!result->discrepancy || result->cross_validation.folds == 0) return;
  TryTest("cross-validation with the model error", result, [&] {
    result->with_discrepancy = CrossValidate(*problem, of_noise, *wide,
                                             estimator, result->discrepancy);
  });
}

}  // namespace

CalibrationResult Calibrate(CalibrationProblem* problem, bool leave_logs_out) {
  CalibrationResult result;
  result.solution = SolveRobustly(problem);
  TryTest("hold-out", &result, [&] {
    ZeroHeldOutLogs(problem);
    DecideHeldOut(problem);
  });
  problem->Tell("uncertainty");
  result.identifiability = AnalyzeIdentifiability(problem, result.solution.at);
  TryTest("correlation of residuals", &result, [&] {
    result.residual_correlation = AnalyzeResidualCorrelation(
        problem->logs(), result.solution.at, result.identifiability);
  });
  const Identifiability of_noise = result.identifiability;
  // One estimator serves all checks: they differ in what they say of errors
  // only. With several threads its tables are made beside the advice.
  Finger solved = problem->parameters().Apply(problem->finger());
  KeepCovariance(problem->parameters(), of_noise, &solved);
  std::future<std::unique_ptr<const FrameEstimator>> tables = std::async(
      problem->threads() > 1 ? std::launch::async : std::launch::deferred,
      [&] { return SensingEstimator(*problem, solved); });
  EnlargeStd(result.residual_correlation, &result.identifiability);
  Try(
      "what to record next",
      [&] {
        problem->Tell("what to record next");
        result.next =
            AdviseNextFrames(problem, result.solution, &result.identifiability);
      },
      &result.warnings);
  if (leave_logs_out) {
    TryTest("agreement of the logs", &result, [&] {
      result.leave_one_log_out =
          LeaveLogsOut(problem, result.solution, result.identifiability);
    });
  }
  std::unique_ptr<const FrameEstimator> estimator;
  TryTest("forces from gauges alone", &result,
          [&] { estimator = tables.get(); });
  if (result.solution.solve.converged && !result.solution.at.frames.empty()) {
    TestUnseen(problem, of_noise, estimator.get(), &result);
  }
  result.finger = problem->parameters().Apply(problem->finger());
  // What enlarges the std is in the discrepancy already, if there is one.
  KeepCovariance(problem->parameters(),
                 result.discrepancy ? of_noise : result.identifiability,
                 &result.finger);
  if (result.finger.calibration) {
    result.finger.calibration->discrepancy = result.discrepancy;
  }
  if (estimator && result.finger.calibration) {
    estimator = estimator->WithErrorsOf(*result.finger.calibration);
  }
  TryTest("check of forces and contacts", &result, [&] {
    problem->Tell("check of forces and contacts");
    result.forces = CheckForces(problem, result.finger, estimator.get(),
                                result.solution.contacts);
  });
  result.bench =
      TestBenchLinearity(problem->finger(), problem->plan(), problem->logs());
  result.free_scatter = MeasureFreeScatter(
      problem->logs(), static_cast<int>(problem->finger().gauges.size()));
  result.effective_rows = EffectiveRows(*problem, result.solution.at.frames);
  WarnOfFreeScatter(result.free_scatter, problem->finger(), &result.warnings);
  SetReadingNoise(*problem, &result.finger, &result.warnings);
  if (!result.solution.solve.converged) {
    result.warnings.push_back(
        {"not_converged",
         "the solver stopped early: " + result.solution.solve.message,
         "give priors, or start from a finger closer to the truth"});
  }
  if (problem->gauges_only()) {
    result.warnings.push_back(
        {"gauges_only",
         "frames with contact have gauges only, which alone tell nothing of "
         "the finger: they were not used",
         "record the reference force (force_N), and the object's centre "
         "(object_x_mm, object_y_mm) or the contact location (contact_1_mm)"});
  }
  WarnOfTimes(*problem, &result.warnings);
  if (!problem->logs().copies.empty()) {
    result.warnings.push_back(
        {"rows_written_twice", problem->logs().copies, kCopiesRemedy});
  }
  WarnOfStarts(result.solution, &result.warnings);
  WarnOfOutliers(*problem, result.solution, &result.warnings);
  WarnOfWeakness(*problem, result.identifiability, &result.warnings);
  // Behind the line before: these parameters have warnings of their own.
  FindUnsupported(*problem, &result.identifiability, &result.warnings);
  WarnOfFewRows(result, &result.warnings);
  WarnOfNoise(*problem, result.identifiability, &result.warnings);
  WarnOfCorrelation(*problem, result.residual_correlation, &result.warnings);
  WarnOfDisagreement(*problem, result.leave_one_log_out, &result.warnings);
  WarnOfForces(result.forces, problem->plan().force_std_N, &result.warnings);
  WarnOfForceLimit(*problem, result, &result.warnings);
  const bool curves =
      problem->plan().family(ParameterFamily::kGaugeCurvature).free;
  for (const BenchLinearity& gauge : result.bench) {
    if (gauge.IsLinear() || (curves && gauge.IsCurved())) continue;
    result.warnings.push_back(
        {"gauge_not_linear", gauge.Words(),
         "free gauge_curvature in the plan, or bend the gauge only as far as "
         "the finger will"});
  }
  result.doubts = FindDoubts(*problem, result);
  WarnOfDoubts(*problem, &result);
  return result;
}

}  // namespace finray
