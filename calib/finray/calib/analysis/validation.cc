#include "finray/calib/analysis/validation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "finray/batch/batch_estimation.h"
#include "finray/io/error.h"
#include "finray/io/nan.h"
#include "finray/io/number_text.h"
#include "finray/residuals/parallel_frames.h"
#include "finray/scene/history_filter.h"

namespace finray {
namespace {

double TouchedAt(const CalibrationFrame& frame, const Plan& plan,
                 const std::vector<PointContact>& near,
                 EquilibriumSolver* solver) {
  solver->Reset();
  const ObjectContact found = SolveObjectContact(
      *plan.scene.object, {frame.object_mm},
      frame.FrictionOr(plan.scene.friction_coefficient), solver, near);
  const bool one = found.status == ObjectContactStatus::kContact &&
                   found.contacts.size() == 1;
  return one ? found.contacts[0].arc_mm : kNaN;
}

// Returns the readings of the gauges alone. Those of the bench are left out,
// because the finger does not bend there.
Measurements GaugesOnly(const CalibrationFrame& frame) {
  Measurements readings;
  readings.gauges_V = frame.gauges_V;
  readings.gauge_readings = frame.gauge_readings;
  readings.history_std_V = frame.history_std_V;
  readings.friction = frame.friction;
  if (frame.IsBench()) {
    readings.gauges_V.assign(frame.gauges_V.size(), kNaN);
  }
  return readings;
}

// Estimates all frames from the gauges alone, log by log.
std::vector<FrameEstimate> EstimateLogs(const Finger& finger, const Plan& plan,
                                        const CalibrationLogs& logs,
                                        const Discretization& discretization,
                                        int threads) {
  Scene scene = plan.scene;
  Scene moving = plan.scene;
  moving.object_std_mm = plan.object_std_mm;
  // The other measurements are the reference, so the estimate does not use
  // them.
  scene.object_std_mm = scene.pin_std_mm = scene.tip_std_mm = std::nullopt;
  std::vector<FrameEstimate> all;
  for (std::size_t i = 0; i < logs.frames.size();) {
    std::vector<Measurements> readings;
    HistoryFilter history(finger, moving);
    for (const int log = logs.frames[i].log;
         i < logs.frames.size() && logs.frames[i].log == log; ++i) {
      readings.push_back(GaugesOnly(logs.frames[i]));
      readings.back().time_s = logs.frames[i].time_s;
      readings.back().object_mm = logs.frames[i].object_mm;
      readings.back().object_angle_rad = logs.frames[i].object_angle_rad;
      history.Remove(&readings.back());
    }
    const auto some =
        EstimateFrames(finger, scene, discretization, readings, threads);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

std::vector<int> FramesToCheck(const CalibrationProblem& problem) {
  std::vector<int> chosen;
  for (const bool held_out : {false, true}) {
    std::vector<int> frames;
    for (int i = 0; i < static_cast<int>(problem.logs().frames.size()); ++i) {
      if (problem.frame(i).held_out == held_out &&
          problem.rejected().count(i) == 0) {
        frames.push_back(i);
      }
    }
    const std::size_t count = std::min(frames.size(), ForceCheck::kMostChecked);
    for (std::size_t k = 0; k < count; ++k) {
      chosen.push_back(frames[k * frames.size() / count]);
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

// Returns the place that decides the region of a frame: that of the contact in
// the reference, or else in the estimate.
double PlaceOf(const FrameReference& reference, const FrameEstimate& estimate) {
  return std::isnan(reference.contact_mm) ? estimate.contact[0].arc_mm
                                          : reference.contact_mm;
}

// A calibration's frames have one contact or none.
Scene SensedScene(const Plan& plan) {
  Scene scene = plan.scene;
  scene.most_contacts = 1;
  scene.pin_std_mm = scene.tip_std_mm = std::nullopt;
  return scene;
}

// These frames, corrected by the present values of the problem.
CalibrationLogs CorrectedFrames(CalibrationProblem* problem,
                                const Finger& calibrated,
                                const std::vector<int>& frames) {
  CalibrationLogs logs;
  logs.paths = problem->logs().paths;
  logs.names = problem->logs().names;
  for (const int i : frames) logs.frames.push_back(problem->frame(i));
  return problem->parameters().Corrected(logs, calibrated);
}

// Says whether a frame with contact has this reference.
bool HasReference(const Validation& validation,
                  double FrameReference::*quantity) {
  return std::any_of(
      validation.references.begin(), validation.references.end(),
      [&](const auto& r) { return r.contact && std::isfinite(r.*quantity); });
}

// Returns the gate of a coverage: the lower one of force and contact. It passes
// if the sample may come from a share as large as the bound.
Gate CoverageGate(const std::string& name, double bound,
                  std::size_t ErrorStatistics::*within,
                  const ErrorRow& errors) {
  Gate lower{name, bound, kNaN, false};
  for (const ErrorStatistics* of : {&errors.force_N, &errors.contact_mm}) {
    if (of->judged == 0) continue;
    const double value = 100 * static_cast<double>(of->*within) /
                         static_cast<double>(of->judged);
    if (value >= lower.value) continue;  // not if it is NaN
    lower.value = value;
    lower.range = BinomialRange(of->*within, of->judged);
    lower.passed = lower.range->second >= bound - 1e-9;
  }
  return lower;
}

// Returns the figure that a gate bounds.
double FigureOf(const std::string& gate, const ErrorRow& errors) {
  if (gate == "most_force_rms_N") return errors.force_N.rms();
  if (gate == "most_force_percent") return errors.force_N.percent();
  if (gate == "most_contact_rms_mm") return errors.contact_mm.rms();
  if (gate == "least_usable_percent") return errors.usable_percent();
  throw std::logic_error("no gate is called " + gate);
}

}  // namespace

std::vector<FrameReference> ReferencesOf(const CalibrationLogs& logs,
                                         const Finger& finger, const Plan& plan,
                                         const Discretization& discretization,
                                         int threads, const Contacts& near) {
  const auto reference_of = [&](std::size_t i, EquilibriumSolver* solver) {
    const CalibrationFrame& frame = logs.frames[i];
    FrameReference reference;
    reference.contact = frame.contact;
    reference.undecided = frame.undecided;
    reference.force_N = frame.Force().magnitude_N;
    reference.force_std_N = frame.ForceStd_N(plan);
    if (std::isfinite(frame.contact_mm)) {
      reference.contact_mm = frame.contact_mm;
      reference.contact_std_mm = plan.contact_std_mm;
    } else if (frame.contact && frame.object_mm.allFinite() &&
               plan.scene.circle_radius_mm()) {
      std::vector<PointContact> guess;
      if (!near.empty() && near[i][1] > 0) {
        guess.push_back({near[i][0], near[i][1]});
      }
      reference.contact_mm = TouchedAt(frame, plan, guess, solver);
      reference.contact_std_mm = plan.object_std_mm;
    }
    return reference;
  };
  std::vector<FrameReference> references(logs.frames.size());
  VisitInParallel(references.size(), threads,
                  EquilibriumSolver(finger, discretization),
                  [&](std::size_t i, EquilibriumSolver* solver) {
                    references[i] = reference_of(i, solver);
                  });
  return references;
}

void SensedFrames::AddTo(ErrorTable* table, std::size_t k,
                         double friction) const {
  table->Add(references[k], estimates[k], PlaceOf(references[k], estimates[k]),
             friction);
}

std::unique_ptr<const FrameEstimator> SensingEstimator(
    const CalibrationProblem& problem, const Finger& calibrated) {
  if (calibrated.gauges.size() < 2) return nullptr;
  return std::make_unique<const FrameEstimator>(
      calibrated, SensedScene(problem.parameters().Corrected(problem.plan())),
      problem.discretization());
}

std::vector<Measurements> SensedReadings(CalibrationProblem* problem,
                                         const Finger& calibrated,
                                         const std::vector<int>& frames) {
  std::vector<Measurements> readings;
  for (const CalibrationFrame& frame :
       CorrectedFrames(problem, calibrated, frames).frames) {
    readings.push_back(GaugesOnly(frame));
  }
  return readings;
}

std::vector<FrameEstimate> EstimateReadings(
    const FrameEstimator* estimator, const std::vector<Measurements>& readings,
    int threads) {
  if (estimator == nullptr) return std::vector<FrameEstimate>(readings.size());
  const auto make = [estimator]() -> FrameSolver {
    const std::shared_ptr<FrameEstimator> own = estimator->ForAnotherThread();
    return [own](const Measurements* some, std::size_t count,
                 FrameEstimate* to) { own->EstimateBlock(some, count, to); };
  };
  return EstimateFrames(make, readings, threads);
}

std::vector<FrameReference> ReferencesAt(CalibrationProblem* problem,
                                         const Finger& calibrated,
                                         const std::vector<int>& frames,
                                         const Contacts* near) {
  Plan plan = problem->parameters().Corrected(problem->plan());
  Contacts some;
  if (near != nullptr) {
    for (const int i : frames) some.push_back((*near)[i]);
  } else {
    plan.scene.object.reset();
  }
  return ReferencesOf(CorrectedFrames(problem, calibrated, frames), calibrated,
                      plan, problem->discretization(), problem->threads(),
                      some);
}

ForceCheck CheckForces(CalibrationProblem* problem, const Finger& calibrated,
                       const FrameEstimator* estimator,
                       const Contacts& contacts) {
  const Plan plan = problem->parameters().Corrected(problem->plan());
  ForceCheck check;
  check.frames = FramesToCheck(*problem);
  const std::size_t frames = check.frames.size();
  check.before.resize(frames);
  std::vector<bool> has_before(frames, false);
  const FamilyPlan& gains = plan.family(ParameterFamily::kGaugeGain);
  const bool sensed =
      calibrated.gauges.size() >= 2 &&
      (!gains.free || gains.prior_std || problem->finger().calibration);
  const std::size_t some =
      sensed ? std::min(frames, ForceCheck::kMostBefore) : 0;
  std::vector<Measurements> spread;
  for (std::size_t k = 0; k < some; ++k) {
    spread.push_back(
        GaugesOnly(problem->frame(check.frames[k * frames / some])));
  }
  std::vector<FrameEstimate> were;
  if (some > 0) {
    were =
        EstimateFrames(problem->finger(), SensedScene(plan),
                       problem->discretization(), spread, problem->threads());
  }
  for (std::size_t k = 0; k < some; ++k) {
    has_before[k * frames / some] = true;
    check.before[k * frames / some] = were[k];
  }
  SensedFrames after = {
      ReferencesAt(problem, calibrated, check.frames, &contacts),
      EstimateReadings(estimator,
                       SensedReadings(problem, calibrated, check.frames),
                       problem->threads())};
  for (ForceCheck::Errors* errors : {&check.fitted, &check.held_out}) {
    errors->before.front_length_mm = errors->after.front_length_mm =
        calibrated.front_length_mm;
  }
  const double friction = plan.scene.friction_coefficient;
  for (std::size_t i = 0; i < frames; ++i) {
    const CalibrationFrame& frame = problem->frame(check.frames[i]);
    if (frame.IsBench()) continue;
    ForceCheck::Errors& errors = frame.held_out ? check.held_out : check.fitted;
    after.AddTo(&errors.after, i, friction);
    if (!has_before[i]) continue;
    // The region is that of the frame, whichever finger senses it.
    errors.before.Add(after.references[i], check.before[i],
                      PlaceOf(after.references[i], after.estimates[i]),
                      friction);
  }
  check.after = std::move(after.estimates);
  return check;
}

Validation Validate(const Finger& finger, const std::optional<Finger>& baseline,
                    const Plan& plan, CalibrationLogs logs,
                    const Discretization& discretization, int threads) {
  Validation result;
  result.stages = AlignStages(finger, plan, discretization, threads, &logs);
  result.references = ReferencesOf(logs, finger, plan, discretization, threads);
  if (!HasReference(result, &FrameReference::force_N) &&
      !HasReference(result, &FrameReference::contact_mm)) {
    throw InputError(
        "logs: no frame with contact has a reference; expected force_N (or "
        "force_x_N, force_y_N), contact_1_mm, or object_x_mm, object_y_mm with "
        "a circle in the scene");
  }
  const auto table = [&](const std::vector<FrameEstimate>& estimates) {
    ErrorTable table;
    table.front_length_mm = finger.front_length_mm;
    for (std::size_t i = 0; i < logs.frames.size(); ++i) {
      if (logs.frames[i].IsBench()) continue;
      table.Add(result.references[i], estimates[i],
                PlaceOf(result.references[i], result.estimates[i]),
                plan.scene.friction_coefficient);
    }
    return table;
  };
  result.estimates = EstimateLogs(finger, plan, logs, discretization, threads);
  result.errors = table(result.estimates);
  if (baseline) {
    result.baseline =
        EstimateLogs(*baseline, plan, logs, discretization, threads);
    result.baseline_errors = table(result.baseline);
  }
  return result;
}

std::vector<Gate> CheckGates(
    const Validation& validation,
    const std::vector<std::pair<std::string, double>>& bounds) {
  std::vector<Gate> gates;
  for (const auto& [name, bound] : bounds) {
    if (name.find("most_force") == 0 &&
        !HasReference(validation, &FrameReference::force_N)) {
      throw InputError("--" + name + " needs force_N in the logs");
    }
    if (name == "most_contact_rms_mm" &&
        !HasReference(validation, &FrameReference::contact_mm)) {
      throw InputError("--" + name +
                       " needs contact_1_mm in the logs, or object_x_mm, "
                       "object_y_mm and a circle in the scene");
    }
    const ErrorRow& errors = validation.errors.contact;
    if (name.find("least_coverage") == 0) {
      gates.push_back(CoverageGate(name, bound,
                                   name == "least_coverage_68_percent"
                                       ? &ErrorStatistics::within_68
                                       : &ErrorStatistics::within_95,
                                   errors));
      continue;
    }
    const double value = FigureOf(name, errors);
    // A value of NaN passes no gate.
    const bool upper = name.find("most") == 0;
    const bool passed = upper ? value <= bound : value >= bound;
    gates.push_back({name, bound, value, passed});
  }
  return gates;
}

std::vector<std::string> FaultsOf(const ErrorRow& errors) {
  constexpr double kFarFrom95 = 80;
  constexpr std::size_t kEnough = 10;
  std::vector<std::string> faults;
  for (const auto& [name, of] : {std::pair("force", &errors.force_N),
                                 std::pair("place", &errors.contact_mm)}) {
    if (of->judged > 0 &&
        BinomialRange(of->within_95, of->judged).second < kFarFrom95) {
      faults.push_back(
          FormatText("%.0f %% of errors of %s lie within their 95 %% intervals",
                     of->coverage_95_percent(), name));
    }
    if (of->scored >= kEnough && of->rms_z() > kFarZ) {
      faults.push_back(FormatText("errors of %s are %.3g times their std rms",
                                  name, of->rms_z()));
    }
  }
  if (errors.force_N.percent() > kLargePercent) {  // not if it is NaN
    faults.push_back(
        FormatText("forces are off by %.3g %% rms", errors.force_N.percent()));
  }
  if (errors.usable_percent() < kFewUsablePercent) {
    faults.push_back(
        FormatText("only %.0f %% of the frames with contact are "
                   "usable",
                   errors.usable_percent()));
  }
  return faults;
}

}  // namespace finray
