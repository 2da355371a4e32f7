#include "finray/calib/analysis/validation.h"

#include <algorithm>
#include <cmath>

#include "finray/batch/batch_estimation.h"
#include "finray/io/error.h"
#include "finray/io/nan.h"
#include "finray/residuals/parallel_frames.h"

namespace finray {
namespace {

double TouchedAt(const CalibrationFrame& frame, const Plan& plan,
                 EquilibriumSolver* solver) {
  solver->Reset();
  const ObjectContact found =
      SolveObjectContact(*plan.scene.object, {frame.object_mm},
                         plan.scene.friction_coefficient, solver);
  const bool one = found.status == ObjectContactStatus::kContact &&
                   found.contacts.size() == 1;
  return one ? found.contacts[0].arc_mm : kNaN;
}

// Returns the readings of the gauges alone. Those of the bench are left out,
// because the finger does not bend there.
Measurements GaugesOnly(const CalibrationFrame& frame) {
  Measurements readings;
  readings.gauges_V = frame.gauges_V;
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
  // The other measurements are the reference, so the estimate does not use
  // them.
  scene.object_std_mm = scene.pin_std_mm = scene.tip_std_mm = std::nullopt;
  std::vector<FrameEstimate> all;
  for (std::size_t i = 0; i < logs.frames.size();) {
    std::vector<Measurements> readings;
    for (const int log = logs.frames[i].log;
         i < logs.frames.size() && logs.frames[i].log == log; ++i) {
      readings.push_back(GaugesOnly(logs.frames[i]));
    }
    const auto some =
        EstimateFrames(finger, scene, discretization, readings, threads);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

bool HasForce(const Validation& validation) {
  return std::any_of(
      validation.references.begin(), validation.references.end(),
      [](const auto& r) { return r.contact && std::isfinite(r.force_N); });
}
bool HasPlace(const Validation& validation) {
  return std::any_of(
      validation.references.begin(), validation.references.end(),
      [](const auto& r) { return r.contact && std::isfinite(r.contact_mm); });
}

double GateValue(const ErrorRow& errors, Gate::Quantity quantity) {
  switch (quantity) {
    case Gate::Quantity::kForceRms:
      return errors.force_N.rms();
    case Gate::Quantity::kForcePercent:
      return errors.force_N.percent();
    case Gate::Quantity::kContactRms:
      return errors.contact_mm.rms();
    case Gate::Quantity::kCoverage68:
      return std::fmin(errors.force_N.coverage_68_percent(),
                       errors.contact_mm.coverage_68_percent());
    case Gate::Quantity::kCoverage95:
      return std::fmin(errors.force_N.coverage_95_percent(),
                       errors.contact_mm.coverage_95_percent());
    case Gate::Quantity::kUsable:
      return errors.usable_percent();
  }
  return kNaN;
}

}  // namespace

std::vector<FrameReference> ReferencesOf(const CalibrationLogs& logs,
                                         const Finger& finger, const Plan& plan,
                                         const Discretization& discretization,
                                         int threads) {
  const auto reference_of = [&](const CalibrationFrame& frame,
                                EquilibriumSolver* solver) {
    FrameReference reference;
    reference.contact = frame.contact;
    reference.force_N = ReferenceForce(frame);
    reference.force_std_N = plan.force_std_N;
    if (std::isfinite(frame.contact_mm)) {
      reference.contact_mm = frame.contact_mm;
      reference.contact_std_mm = plan.contact_std_mm;
    } else if (frame.contact && frame.object_mm.allFinite() &&
               plan.scene.circle_radius_mm()) {
      reference.contact_mm = TouchedAt(frame, plan, solver);
      reference.contact_std_mm = plan.object_std_mm;
    }
    return reference;
  };
  std::vector<FrameReference> references(logs.frames.size());
  VisitInParallel(references.size(), threads,
                  EquilibriumSolver(finger, discretization),
                  [&](std::size_t i, EquilibriumSolver* solver) {
                    references[i] = reference_of(logs.frames[i], solver);
                  });
  return references;
}

ForceCheck CheckForces(const Finger& before, const Finger& after,
                       const Plan& plan, const CalibrationLogs& logs,
                       const CalibrationLogs& corrected,
                       const Discretization& discretization, int threads) {
  // A calibration's frames have one contact or none.
  Scene scene = plan.scene;
  scene.most_contacts = 1;
  scene.pin_std_mm = scene.tip_std_mm = std::nullopt;
  ForceCheck check;
  check.before.resize(logs.frames.size());
  check.has_before.assign(logs.frames.size(), false);
  // A contact has two unknowns, so fewer than two gauges give no estimate.
  if (before.gauges.size() < 2) {
    check.after.resize(logs.frames.size());
    return check;
  }
  const std::size_t frames = logs.frames.size();
  const std::size_t some = std::min(frames, ForceCheck::kMostBefore);
  std::vector<Measurements> spread, all;
  for (std::size_t k = 0; k < some; ++k) {
    spread.push_back(GaugesOnly(logs.frames[k * frames / some]));
  }
  for (const CalibrationFrame& frame : corrected.frames) {
    all.push_back(GaugesOnly(frame));
  }
  const std::vector<FrameEstimate> were =
      EstimateFrames(before, scene, discretization, spread, threads);
  for (std::size_t k = 0; k < some; ++k) {
    check.has_before[k * frames / some] = true;
    check.before[k * frames / some] = were[k];
  }
  check.after = EstimateFrames(after, scene, discretization, all, threads);
  const double per_normal = std::hypot(1, plan.scene.friction_coefficient);
  for (std::size_t i = 0; i < logs.frames.size(); ++i) {
    const double force = ReferenceForce(corrected.frames[i]);
    const double was = per_normal * check.before[i].contact[0].normal_N - force;
    const double is = per_normal * check.after[i].contact[0].normal_N - force;
    ForceCheck::Error& error =
        logs.frames[i].held_out ? check.held_out : check.fitted;
    if (!std::isnan(was)) {
      ++error.frames_before;
      error.before_rms_N += was * was;
    }
    if (std::isnan(is)) continue;
    ++error.frames;
    error.after_rms_N += is * is;
    error.after_max_N = std::max(error.after_max_N, std::abs(is));
    error.reference_mean_N += force;
  }
  for (ForceCheck::Error* error : {&check.fitted, &check.held_out}) {
    if (error->frames_before > 0) {
      error->before_rms_N = std::sqrt(
          error->before_rms_N / static_cast<double>(error->frames_before));
    }
    if (error->frames == 0) continue;
    const auto n = static_cast<double>(error->frames);
    error->after_rms_N = std::sqrt(error->after_rms_N / n);
    error->reference_mean_N /= n;
  }
  return check;
}

Validation Validate(const Finger& finger, const std::optional<Finger>& baseline,
                    const Plan& plan, const CalibrationLogs& logs,
                    const Discretization& discretization, int threads) {
  Validation result;
  result.references = ReferencesOf(logs, finger, plan, discretization, threads);
  if (!HasForce(result) && !HasPlace(result)) {
    throw InputError(
        "logs: no frame with contact has a reference; expected force_N (or "
        "force_x_N, force_y_N), contact_1_mm, or object_x_mm, object_y_mm with "
        "a circle in the scene");
  }
  const auto table = [&](const std::vector<FrameEstimate>& estimates) {
    return TabulateErrors(
        result.references, estimates, result.estimates, finger.front_length_mm,
        plan.scene.friction_coefficient,
        [&](std::size_t i) { return !logs.frames[i].IsBench(); });
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

const char* GateName(Gate::Quantity quantity) {
  constexpr const char* kNames[] = {
      "most_force_rms_N",          "most_force_percent",
      "most_contact_rms_mm",       "least_coverage_68_percent",
      "least_coverage_95_percent", "least_usable_percent"};
  return kNames[static_cast<int>(quantity)];
}

std::vector<GateResult> CheckGates(const Validation& validation,
                                   const std::vector<Gate>& gates) {
  std::vector<GateResult> results;
  for (const Gate& gate : gates) {
    const bool of_force = gate.quantity == Gate::Quantity::kForceRms ||
                          gate.quantity == Gate::Quantity::kForcePercent;
    if (of_force && !HasForce(validation)) {
      throw InputError(std::string("--") + GateName(gate.quantity) +
                       " needs force_N in the logs");
    }
    if (gate.quantity == Gate::Quantity::kContactRms && !HasPlace(validation)) {
      throw InputError(std::string("--") + GateName(gate.quantity) +
                       " needs contact_1_mm in the logs, or object_x_mm, "
                       "object_y_mm and a circle in the scene");
    }
    const double value = GateValue(validation.errors.contact, gate.quantity);
    // A value of NaN passes no gate.
    const bool upper = std::string(GateName(gate.quantity)).find("most") == 0;
    const bool passed = upper ? value <= gate.bound : value >= gate.bound;
    results.push_back({gate, value, passed});
  }
  return results;
}

}  // namespace finray
