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
  /// All three must stay in place.
  CalibrationBlocks(const Finger& finger, const Plan& plan,
                    CalibrationParameters* parameters);

  /// True if the frame can be fitted at all: without a gauge, a contact's place
  /// and force take two other measurements.
  bool HasEnough(const CalibrationFrame& frame) const;
  /// True if anything but the gauges measures the contact.
  bool HasReference(const CalibrationFrame& frame) const;

  /// The blocks of a frame, which must stay in place, as must `evaluation` and
  /// `unknowns` (of FrameEvaluation; null if there are none). On the bench
  /// there is no evaluation.
  std::vector<FrameBlock> Of(const CalibrationFrame& frame,
                             const FrameEvaluation* evaluation,
                             double* unknowns) const;

  double gauge_std_V(int gauge) const { return model_.gauge_std_V[gauge]; }

 private:
  const Finger& finger_;
  CalibrationParameters& parameters_;
  MeasurementModel model_;
  // A free frame's force tells the sensor's offset and nothing else.
  MeasurementModel free_model_;
};

/// The plan's robust loss, which acts on measurements only; null for none.
std::unique_ptr<ceres::LossFunction> MakeLoss(const Plan& plan);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_CALIBRATION_BLOCKS_H_
