#ifndef FINRAY_CALIB_PROBLEM_MEASUREMENT_BLOCKS_H_
#define FINRAY_CALIB_PROBLEM_MEASUREMENT_BLOCKS_H_

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <memory>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/parameters.h"
#include "finray/calib/problem/plan.h"
#include "finray/calib/problem/residual_family.h"
#include "finray/residuals/frame_evaluation.h"

namespace finray {

/// One measurement of a frame as a residual block.
struct MeasurementBlock {
  std::unique_ptr<ceres::CostFunction> cost;
  std::vector<double*> parameters;
  ResidualFamily family;
  int gauge;  ///< for kGauge and kBench, else -1
};

/// Turns a row of a log into residual blocks, whichever measurements it has:
/// gauge readings, reference force, object centre, contact location, rib pins
/// and tip; or gauge readings on the bench.
class MeasurementBlocks {
 public:
  /// All three must stay in place.
  MeasurementBlocks(const Finger& finger, const Plan& plan,
                    CalibrationParameters* parameters)
      : finger_(finger), plan_(plan), parameters_(*parameters) {}

  /// Whether the frame can be fitted at all: without a gauge, a contact's place
  /// and force take two other measurements.
  bool HasEnough(const CalibrationFrame& frame) const;
  /// Whether anything but gauges tells of the contact.
  bool HasReference(const CalibrationFrame& frame) const;

  /// The blocks of a frame, which must stay in place, as must `evaluation` and
  /// `unknowns` (of FrameEvaluation; null if there are none). On the bench
  /// there is no evaluation.
  std::vector<MeasurementBlock> Of(const CalibrationFrame& frame,
                                   const FrameEvaluation* evaluation,
                                   double* unknowns) const;

  double gauge_std_V(int gauge) const {
    return plan_.gauge_std_V.value_or(finger_.gauges[gauge].noise_V);
  }

 private:
  using Blocks = std::vector<MeasurementBlock>;

  // Offset, drift and temperature of a reading follow the other blocks.
  std::vector<double> AddTerms(const CalibrationFrame& frame, int gauge,
                               std::vector<double*>* blocks) const;
  void AddBench(const CalibrationFrame& frame, Blocks* out) const;
  void AddReadings(const CalibrationFrame& frame,
                   const FrameEvaluation& evaluation,
                   const std::vector<double*>& model, Blocks* out) const;
  void AddForce(const CalibrationFrame& frame,
                const FrameEvaluation& evaluation, double* unknowns,
                const std::vector<double*>& model, Blocks* out) const;
  void AddPlace(const CalibrationFrame& frame,
                const FrameEvaluation& evaluation, double* unknowns,
                const std::vector<double*>& model, Blocks* out) const;
  void AddPoints(const CalibrationFrame& frame,
                 const FrameEvaluation& evaluation,
                 const std::vector<double*>& model, Blocks* out) const;

  const Finger& finger_;
  const Plan& plan_;
  CalibrationParameters& parameters_;
};

/// The plan's robust loss, which acts on measurements only; null for none.
std::unique_ptr<ceres::LossFunction> MakeLoss(const Plan& plan);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_MEASUREMENT_BLOCKS_H_
