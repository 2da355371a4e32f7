#ifndef FINRAY_CALIB_DESIGN_RECORDING_PLAN_H_
#define FINRAY_CALIB_DESIGN_RECORDING_PLAN_H_

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/design/planned_recording.h"
#include "finray/calib/design/recording_shortfall.h"
#include "finray/calib/problem/plan.h"
#include "finray/scene/stage_frame.h"

namespace finray {

/// What the bench can do. Places are those of the circle's centre as the stage
/// counts them, mm.
struct RecordingLimits {
  Eigen::Vector2d from_mm, to_mm;
  double force_max_N;
};

/// What the calibrated finger shall sense: contacts of `normal_N` in a region
/// of the front beam. The target is the rms error of one frame over the region,
/// noise included, and holds with the given confidence.
struct RecordingTarget {
  double from_mm, to_mm, normal_N;
  std::optional<double> place_mm, force_N;
  double confidence = 0.95;
};

/// What is known of a finger before the recording: the drawing with the priors
/// of the plan, or a first recording.
struct KnownFinger {
  Finger finger;  ///< Its noise_V is that of one reading.
  StageFrame stage;
  /// The information on the free parameters of a PlannedRecording of this
  /// finger, in their units.
  Eigen::MatrixXd information;
  std::size_t rows = 0;     ///< Rows of logs that told it.
  std::string copies = {};  ///< CalibrationLogs::copies of these logs.
};
KnownFinger FromDrawing(const Finger& finger, const Plan& plan,
                        const Discretization& discretization);
/// Calibrates the finger from the logs. Parameters that belong to single logs
/// (offsets by log, drift) are as unknown in the next log as the plan says.
/// Throws InputError for logs without any reading of a gauge.
KnownFinger FromLogs(const Finger& finger, const Plan& plan,
                     const std::vector<std::string>& logs,
                     const Discretization& discretization, int threads);

/// A row of the recording: drive the stage there, wait, record.
struct RecordingRow {
  bool touches;
  Eigen::Vector2d object_mm;  ///< The place of the circle, stage coordinates.
  double contact_mm;          ///< Where the known finger touches it; else NaN.
  double force_N;             ///< Of the known finger.
  /// The least and the largest force of the drawn fingers.
  double force_low_N, force_high_N;
  std::vector<double> gauges_V;  ///< Of the known finger.
};

struct RecordingPlan {
  std::vector<RecordingRow> rows;  ///< In the order to record them.
  /// The share of fingers and recordings that meet the target with so many
  /// rows, and with none.
  double met, met_before;
  bool suffices;                 ///< met >= confidence
  RecordingShortfall shortfall;  ///< Set unless it suffices.
  /// The rms error over the region: of noise alone, and the predicted median
  /// with the calibration's; of place and force.
  double noise_mm, noise_N, median_mm, median_N;
  double worst_mm, worst_N;  ///< The std of noise where it is largest.
  /// The largest force of all drawn fingers and rows.
  double largest_N;
};

/// Plans a recording. Candidates are spread over heights and loads
/// (SpreadContacts) at places that the stage reaches. `kDraws` fingers are
/// drawn from what is known; each meets the same stage places with contacts of
/// its own, and leaves rows out that exceed force_max_N. After n rows a draw's
/// parameters have the covariance (P + sum J'J)^-1. Errors drawn from it give
/// the rms error over the region,
///
///   rms^2 = mean over the region of (E'E)^-1 + (g d)^2,   g as GaugedContact.
///
/// n is the least number for which the share of draws below the target is the
/// confidence. Throws InputError if the plan has no circle, or if the stage
/// reaches no contact or cannot leave the finger.
RecordingPlan PlanRecording(const KnownFinger& known, const Plan& plan,
                            const RecordingLimits& limits,
                            const RecordingTarget& target, std::uint64_t seed,
                            std::size_t most_frames,
                            const Discretization& discretization);
constexpr int kRecordingDraws = 24;

/// Draws a finger, and where the stage is, from what is known.
KnownFinger DrawFrom(const KnownFinger& known, const Plan& plan,
                     std::uint64_t seed, const Discretization& discretization);

}  // namespace finray

#endif  // FINRAY_CALIB_DESIGN_RECORDING_PLAN_H_
