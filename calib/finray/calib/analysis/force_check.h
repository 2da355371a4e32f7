#ifndef FINRAY_CALIB_ANALYSIS_FORCE_CHECK_H_
#define FINRAY_CALIB_ANALYSIS_FORCE_CHECK_H_

#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {

/// What the gauges alone say of every frame, with the finger as it was and as
/// calibrated: the comparison with the force sensor that a user asks for first.
/// Before, with the gauges as they were read; after, with what the calibration
/// knows of drift and temperature taken out of them. The reference is the
/// sensor's true force by what the calibration knows of it.
struct ForceCheck {
  std::vector<FrameEstimate> before, after;  ///< one per frame
  /// Whether the frame was estimated with the finger as it was, which takes
  /// long if that makes no sense of the gauges: kMostBefore, evenly spread.
  std::vector<bool> has_before;
  static constexpr std::size_t kMostBefore = 200;

  struct Error {
    std::size_t frames = 0, frames_before = 0;
    double before_rms_N = 0, after_rms_N = 0;
    double after_max_N = 0;
    double reference_mean_N = 0;
  };
  /// Over frames with a reference force that were fitted, and held out.
  Error fitted, held_out;
};

ForceCheck CheckForces(const Finger& before, const Finger& after,
                       const Plan& plan, const CalibrationLogs& logs,
                       const CalibrationLogs& corrected,
                       const Discretization& discretization, int threads);

/// The magnitude of the reference force of a frame; NaN if not measured.
double ReferenceForce(const CalibrationFrame& frame);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_FORCE_CHECK_H_
