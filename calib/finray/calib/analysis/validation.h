#ifndef FINRAY_CALIB_ANALYSIS_VALIDATION_H_
#define FINRAY_CALIB_ANALYSIS_VALIDATION_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/calib/analysis/error_table.h"
#include "finray/calib/problem/calibration_log.h"
#include "finray/finger/discretization.h"
#include "finray/io/frame_table.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {

/// Returns the references of every frame, without its gauges:
///  - the force is that of the reference sensor, with the force_std_N of the
///    plan;
///  - the contact is `contact_1_mm`. If that is not measured, it is the place
///    where the front beam of `finger` touches the circle of the plan, held at
///    the measured centre, if there is one such place only. The centre tells
///    the place along the beam almost whatever the stiffness.
std::vector<FrameReference> ReferencesOf(const CalibrationLogs& logs,
                                         const Finger& finger, const Plan& plan,
                                         const Discretization& discretization,
                                         int threads);

/// Tabulates the errors of the frames for which `chosen` is true. The region of
/// a frame is that of the reference contact, or else that of the contact in
/// `placed`.
template <class Chosen>
ErrorTable TabulateErrors(const std::vector<FrameReference>& references,
                          const std::vector<FrameEstimate>& estimates,
                          const std::vector<FrameEstimate>& placed,
                          double front_length_mm, double friction,
                          const Chosen& chosen) {
  ErrorTable table;
  table.front_length_mm = front_length_mm;
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (!chosen(i)) continue;
    const double known = references[i].contact_mm;
    table.Add(references[i], estimates[i],
              known == known ? known : placed[i].contact[0].arc_mm, friction);
  }
  return table;
}

/// Compares the force sensor with the force from the gauges alone, before and
/// after the calibration. The estimate before the calibration takes the
/// readings as they are. For the estimate after it, the drift and temperature
/// that the calibration has found are removed from the readings. The reference
/// is the force of the sensor, corrected by the scale and offset that the
/// calibration has found.
struct ForceCheck {
  std::vector<FrameEstimate> before, after;  ///< One for each frame.
  /// True for the frames that were estimated with the finger as it was:
  /// kMostBefore of them, evenly spread. A finger far from the truth makes that
  /// slow.
  std::vector<bool> has_before;
  static constexpr std::size_t kMostBefore = 200;

  struct Error {
    std::size_t frames = 0, frames_before = 0;
    double before_rms_N = 0, after_rms_N = 0;
    double after_max_N = 0;
    double reference_mean_N = 0;
  };
  /// The errors over the fitted and over the held-out frames with a reference
  /// force.
  Error fitted, held_out;
};

ForceCheck CheckForces(const Finger& before, const Finger& after,
                       const Plan& plan, const CalibrationLogs& logs,
                       const CalibrationLogs& corrected,
                       const Discretization& discretization, int threads);

/// Compares a finger with logs that it was not calibrated from.
struct Validation {
  std::vector<FrameReference> references;
  std::vector<FrameEstimate> estimates, baseline;  ///< `baseline` may be empty.
  ErrorTable errors;
  std::optional<ErrorTable> baseline_errors;
};

/// Throws InputError if the logs have no reference.
Validation Validate(const Finger& finger, const std::optional<Finger>& baseline,
                    const Plan& plan, const CalibrationLogs& logs,
                    const Discretization& discretization, int threads);

/// A bound that a validation has to keep, over all frames with contact.
struct Gate {
  enum class Quantity {
    kForceRms,
    kForcePercent,
    kContactRms,
    kCoverage68,
    kCoverage95,
    kUsable,
  };
  Quantity quantity;
  double bound;
};
/// Returns the name of the flag of a gate, e.g. "most_force_rms_N". A name that
/// begins with "least" is that of a lower bound.
const char* GateName(Gate::Quantity quantity);

struct GateResult {
  Gate gate;
  double value;  ///< NaN if no frame can be used; then it fails.
  bool passed;
};
/// Checks the gates. Coverage is the lower one of force and contact. Throws
/// InputError for a gate whose quantity has no reference in the logs.
std::vector<GateResult> CheckGates(const Validation& validation,
                                   const std::vector<Gate>& gates);

/// Returns a table with a row for each frame of the finger, without the bench:
/// log, row, time, kind, reference, estimate with std, status, errors, and
/// those of the baseline.
FrameTable ValidationFrames(const CalibrationLogs& logs,
                            const Validation& validation, double friction);

struct ValidationInputs {
  std::string finger_path, baseline_path, plan_path;  ///< Plan or scene.
  std::string command;
};
/// Returns the text of validation.yaml (docs/reference/formats.md).
std::string ValidationYaml(const CalibrationLogs& logs,
                           const Validation& validation,
                           const std::vector<GateResult>& gates,
                           const ValidationInputs& inputs);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_VALIDATION_H_
