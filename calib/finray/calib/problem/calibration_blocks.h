#ifndef FINRAY_CALIB_PROBLEM_CALIBRATION_BLOCKS_H_
#define FINRAY_CALIB_PROBLEM_CALIBRATION_BLOCKS_H_

#include <ceres/loss_function.h>

#include <memory>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/parameters.h"
#include "finray/calib/problem/plan.h"
#include "finray/residuals/frame_blocks.h"

namespace finray {

/// Calls MeasurementBlocks of residuals/frame_blocks.h for the rows of a
/// calibration: with the plan's standard deviations and with the parameters
/// that the plan frees.
class CalibrationBlocks {
 public:
  /// All three arguments must stay in place.
  CalibrationBlocks(const Finger& finger, const Plan& plan,
                    CalibrationParameters* parameters);

  /// Says whether the frame can be fitted at all. Without a gauge, the place
  /// and force of a contact need two other measurements.
  bool HasEnough(const CalibrationFrame& frame) const;
  /// Says whether anything but the gauges measures the contact.
  bool HasReference(const CalibrationFrame& frame) const;

  /// Returns the blocks of a frame. The frame, `evaluation` and `unknowns`
  /// (those of FrameEvaluation, null if there are none) must stay in place. A
  /// row of the bench has no evaluation.
  std::vector<FrameBlock> Of(const CalibrationFrame& frame,
                             const FrameEvaluation* evaluation,
                             double* unknowns) const;

  double gauge_std_V(int gauge) const { return model_.gauge_std_V[gauge]; }

 private:
  const Finger& finger_;
  CalibrationParameters& parameters_;
  MeasurementModel model_;
  // The force of a free frame tells the offset of the sensor and nothing else.
  MeasurementModel free_model_;
};

/// Makes the plan's robust loss, which acts on measurements only. Returns null
/// if the plan has none.
std::unique_ptr<ceres::LossFunction> MakeLoss(const Plan& plan);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_CALIBRATION_BLOCKS_H_
