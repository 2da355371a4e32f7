#ifndef FINRAY_CALIB_ANALYSIS_FORCE_CHECK_H_
#define FINRAY_CALIB_ANALYSIS_FORCE_CHECK_H_

#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {

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

/// Returns the readings of the gauges alone. Those of the bench are left out,
/// because the finger does not bend there.
Measurements GaugesOnly(const CalibrationFrame& frame);

ForceCheck CheckForces(const Finger& before, const Finger& after,
                       const Plan& plan, const CalibrationLogs& logs,
                       const CalibrationLogs& corrected,
                       const Discretization& discretization, int threads);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_FORCE_CHECK_H_
