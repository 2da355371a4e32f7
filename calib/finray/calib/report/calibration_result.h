#ifndef FINRAY_CALIB_REPORT_CALIBRATION_RESULT_H_
#define FINRAY_CALIB_REPORT_CALIBRATION_RESULT_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/analysis/bench_linearity.h"
#include "finray/calib/analysis/cross_validation.h"
#include "finray/calib/analysis/discrepancy.h"
#include "finray/calib/analysis/free_scatter.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/analysis/leave_one_log_out.h"
#include "finray/calib/analysis/next_frames.h"
#include "finray/calib/analysis/residual_correlation.h"
#include "finray/calib/analysis/score_test.h"
#include "finray/calib/analysis/unsupported.h"
#include "finray/calib/analysis/validation.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"
#include "finray/io/frame_table.h"

namespace finray {

/// The whole result of a calibration.
struct CalibrationResult {
  CalibrationSolution solution;
  Identifiability identifiability;
  ForceCheck forces;
  ResidualCorrelation residual_correlation;
  LeaveOneLogOut leave_one_log_out;
  NextRecording next;                     ///< What to record next.
  std::vector<FreeScatter> free_scatter;  ///< Noise of gauges.
  std::vector<BenchLinearity> bench;      ///< Of gauges with bench readings.
  /// The number of fitted rows, those that repeat each other counted once.
  double effective_rows = 0;
  ScoreTest score;  ///< Which fixed effect the residuals look like.
  /// Done if the plan holds nothing out.
  CrossValidation cross_validation;
  /// What the model still misses, also in `finger`; empty if it shows nothing.
  std::optional<GaugeDiscrepancy> discrepancy;
  /// As cross_validation, with the discrepancy in the intervals; not done
  /// without one, nor with a hold-out.
  CrossValidation with_discrepancy;
  /// Tests that could not be made, with the reason. A test that is not made
  /// shows nothing, so each is a doubt.
  std::vector<std::string> not_tested;
  /// Why the result is doubtful, in words (doubts.h).
  std::vector<std::string> doubts;
  Finger finger;  ///< The calibrated finger.
  std::vector<Warning> warnings;

  bool AllIdentified() const;
  /// More parameters count as estimated than rows differ. Then no residual can
  /// show what is wrong.
  bool TooFewRows() const;
  /// Returns one of these: `not_converged`; `starts_disagree`, if fewer than
  /// two of the starts agree; `unexplained`, if residuals of a family are at
  /// least kUnexplained times their std; `unidentifiable`, also if
  /// there are TooFewRows; `doubtful`, if there are `doubts`; `good`.
  std::string Verdict() const;
  static constexpr double kUnexplained = 5;
  /// Errors of forces in frames that the calibration has not seen, with all
  /// that widens the intervals of estimates: of the hold-out, or by
  /// cross-validation.
  const ErrorStatistics& UnseenForces() const;
};

/// Solves the problem, analyses it and checks it against the references.
/// `leave_logs_out` repeats the solve without each log, if there are several.
/// Throws std::runtime_error if there is no solution. What fails behind it
/// leaves the solution, and a warning `step_failed`.
CalibrationResult Calibrate(CalibrationProblem* problem,
                            bool leave_logs_out = false);

/// The inputs of a calibration, for its record.
struct CalibrationInputs {
  std::string finger_path, plan_path;
  std::string scheme;
  int resolution = 0;
  std::string command;
  /// The text of each input that is no file, by the name that stands for its
  /// path.
  std::map<std::string, std::string> texts = {};

  /// The SHA-256 of an input.
  std::string Sha256Of(const std::string& path) const;
};

/// Returns the text of calibration.yaml (docs/reference/formats.md).
std::string CalibrationYaml(CalibrationProblem& problem,
                            const CalibrationResult& result,
                            const CalibrationInputs& inputs);

/// Writes finger.yaml, calibration.yaml, calibration.frames.csv and
/// calibration.shape.csv into `out_dir`, which is made if it is missing. With
/// `report`, report.html follows. Returns why there is none, or "".
std::string WriteCalibration(CalibrationProblem& problem,
                             const CalibrationResult& result,
                             const CalibrationInputs& inputs,
                             const std::string& out_dir, bool report);

/// Returns a table with a row for each frame: log, time, kind (contact, free,
/// bench), held_out, reference force, force and place from the gauges before
/// and after, l_c and f_c of the fit, gauge residuals in std (empty if held out
/// or rejected), and why the frame was rejected.
FrameTable CalibrationFrames(CalibrationProblem& problem,
                             const CalibrationResult& result);

/// Returns both beams for drawing, undeformed and in the heaviest fitted frame.
/// The columns are state (undeformed, deformed), part (front, back, rib_<i>,
/// contact), x_mm, y_mm. The contact has two rows: its point, and the tip of an
/// arrow against the normal.
FrameTable CalibrationShape(CalibrationProblem& problem,
                            const CalibrationResult& result);

}  // namespace finray

#endif  // FINRAY_CALIB_REPORT_CALIBRATION_RESULT_H_
