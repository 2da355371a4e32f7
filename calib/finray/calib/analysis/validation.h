#ifndef FINRAY_CALIB_ANALYSIS_VALIDATION_H_
#define FINRAY_CALIB_ANALYSIS_VALIDATION_H_

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "finray/calib/analysis/error_table.h"
#include "finray/calib/analysis/gate.h"
#include "finray/calib/analysis/stage_fit.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/io/frame_table.h"

namespace finray {

/// Returns the references of every frame, without its gauges:
///  - the force is that of the reference sensor, with the force_std_N of the
///    plan;
///  - the contact is `contact_1_mm`. If that is not measured, it is the place
///    where the front beam of `finger` touches the circle of the plan, held at
///    the measured centre, if there is one such place only. The centre tells
///    the place along the beam almost whatever the stiffness. The search for it
///    starts at the frame's contact of `near`, if that has one.
std::vector<FrameReference> ReferencesOf(const CalibrationLogs& logs,
                                         const Finger& finger, const Plan& plan,
                                         const Discretization& discretization,
                                         int threads,
                                         const Contacts& near = {});

/// What the gauges alone and the references say of some frames.
struct SensedFrames {
  std::vector<FrameReference> references;
  std::vector<FrameEstimate> estimates;

  /// Adds the k-th of them to a table.
  void AddTo(ErrorTable* table, std::size_t k, double friction) const;
};

/// Makes an estimator of `calibrated`, which is the finger at the present
/// values of the problem. It is null with fewer than two gauges: a contact has
/// two unknowns.
std::unique_ptr<const FrameEstimator> SensingEstimator(
    const CalibrationProblem& problem, const Finger& calibrated);

/// Returns the gauges' readings of these frames, corrected by the present
/// values of the problem, as estimates of `calibrated` take it.
std::vector<Measurements> SensedReadings(CalibrationProblem* problem,
                                         const Finger& calibrated,
                                         const std::vector<int>& frames);

/// Estimates readings with the estimator of SensingEstimator, with the same
/// results on any number of threads. Without an estimator no frame is solved.
std::vector<FrameEstimate> EstimateReadings(
    const FrameEstimator* estimator, const std::vector<Measurements>& readings,
    int threads);

/// The references of frames, corrected by the present values of the problem.
/// The place of a circle costs as much as an estimate, and is a reference only
/// with `near`, the contacts of the solution.
std::vector<FrameReference> ReferencesAt(CalibrationProblem* problem,
                                         const Finger& calibrated,
                                         const std::vector<int>& frames,
                                         const Contacts* near);

/// Compares the references with the gauges alone, before and after a
/// calibration. The estimate before the calibration takes the readings as they
/// are. For the estimate after it, the drift and temperature that the
/// calibration has found are removed from the readings. The reference force is
/// that of the sensor, corrected by the scale and offset that the calibration
/// has found.
struct ForceCheck {
  /// The frames that are compared, as indices into the frames of the logs. If
  /// there are many, these are kMostChecked of the fitted ones and kMostChecked
  /// of those held out, evenly spread.
  std::vector<int> frames;
  static constexpr std::size_t kMostChecked = 1000;
  /// An estimate for each of these frames. `before` is known for kMostBefore of
  /// them, evenly spread. A finger far from the truth makes that slow. It is
  /// not known if gains are free without a prior and no calibration has found
  /// them: such a finger cannot sense.
  std::vector<FrameEstimate> before, after;
  static constexpr std::size_t kMostBefore = 200;

  /// The errors of force are those of the tables: over frames with contact that
  /// have a usable estimate. `before` is empty if nobody knew the gains.
  struct Errors {
    ErrorTable before, after;
    const ErrorStatistics& force_before_N() const {
      return before.contact.force_N;
    }
    const ErrorStatistics& force_after_N() const {
      return after.contact.force_N;
    }
  } fitted, held_out;
};

/// `calibrated` is the finger of the problem at its solution, `estimator` one
/// of it, and `contacts` are those of the solution.
ForceCheck CheckForces(CalibrationProblem* problem, const Finger& calibrated,
                       const FrameEstimator* estimator,
                       const Contacts& contacts);

/// Compares a finger with logs that it was not calibrated from.
struct Validation {
  std::vector<FittedStage> stages;  ///< Of the logs that were aligned.
  std::vector<FrameReference> references;
  std::vector<FrameEstimate> estimates, baseline;  ///< `baseline` may be empty.
  ErrorTable errors;
  std::optional<ErrorTable> baseline_errors;
};

/// Aligns the stages of the logs where the plan frees them (AlignStages), and
/// judges what is left. Rows are judged by the noise of one reading, the
/// finger's noise_V, over the root of their gauge_readings, so `logs` are read
/// without a gauge_std_V: that is the noise of the rows of a calibration.
/// Throws InputError if the logs have no reference.
Validation Validate(const Finger& finger, const std::optional<Finger>& baseline,
                    const Plan& plan, CalibrationLogs logs,
                    const Discretization& discretization, int threads);

/// Checks gates over all frames with contact, by their names and bounds. The
/// names are most_force_rms_N, most_force_percent, most_contact_rms_mm,
/// least_coverage_68_percent, least_coverage_95_percent (the lower one of force
/// and contact, and it fails only if BinomialRange lies below the bound) and
/// least_usable_percent. Throws InputError for a gate whose
/// quantity has no reference in the logs.
std::vector<Gate> CheckGates(
    const Validation& validation,
    const std::vector<std::pair<std::string, double>>& bounds);

/// Says in words what a gate would have said, lest wrong estimates look good:
/// coverage far below 95 %, errors of kFarZ std rms, forces that are off by
/// kLargePercent rms, few usable frames. Empty if there is nothing to say.
std::vector<std::string> FaultsOf(const ErrorRow& errors);
constexpr double kFarZ = 2, kLargePercent = 25, kFewUsablePercent = 50;

/// Returns a table with a row for each frame of the finger, without the bench:
/// log, row, time, kind, reference, estimate with std, status, errors, and
/// those of the baseline.
FrameTable ValidationFrames(const CalibrationLogs& logs,
                            const Validation& validation, double friction);

struct ValidationInputs {
  std::string finger_path, baseline_path, plan_path;  ///< Plan or scene.
  std::string columns_path;  ///< The file of the mapping, if it has one.
  std::string command;
};
/// Returns the text of validation.yaml (docs/reference/formats.md).
std::string ValidationYaml(const CalibrationLogs& logs,
                           const Validation& validation,
                           const std::vector<Gate>& gates,
                           const ValidationInputs& inputs);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_VALIDATION_H_
