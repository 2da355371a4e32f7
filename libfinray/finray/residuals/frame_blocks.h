#ifndef FINRAY_RESIDUALS_FRAME_BLOCKS_H_
#define FINRAY_RESIDUALS_FRAME_BLOCKS_H_

#include <ceres/cost_function.h>

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "finray/residuals/frame_set.h"
#include "finray/residuals/linear_signal.h"
#include "finray/residuals/reading_history.h"
#include "finray/residuals/residual_family.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"

namespace finray {

// The heart of finray: it turns one frame with its measurements into Ceres
// blocks. Calibration calls it with parameters that Ceres varies, estimation
// with parameters that Ceres holds constant. To add a new kind of measurement,
// write its residual and one more function in frame_blocks.cc.

/// Says which measurements of a row count and gives their standard deviations.
/// A kind of measurement without a std is ignored.
struct MeasurementModel {
  std::vector<double> gauge_std_V;  ///< One per gauge.
  std::optional<double> force_std_N, contact_std_mm, pin_std_mm, tip_std_mm;
  /// Of each coordinate of a circle's centre.
  std::optional<double> object_std_mm;

  /// The model for estimation: gauges with the finger's noise, and the
  /// measurements that the scene gives a std for. Reference forces and measured
  /// contact places are ignored.
  static MeasurementModel OfScene(const Finger& finger, const Scene& scene);
};

/// A part of a gauge's reading that does not come from bending: coefficient *
/// variable.
struct ReadingTerm {
  double* variable;
  double coefficient;
};

/// Pointers to the parameters that a frame's blocks share with other frames.
/// They must stay in place while the blocks live.
struct FrameParameters {
  SharedParameters* finger = nullptr;
  double* gains_V_per_rad = nullptr;               ///< One per gauge.
  double* curvatures_per_rad = nullptr;            ///< One per gauge.
  std::vector<std::vector<ReadingTerm>> readings;  ///< One list per gauge.
  std::vector<HistoryTerm> histories;  ///< One per gauge, or none at all.
  /// One per gauge, or null if no gauge may be flat.
  double *flat_shares = nullptr, *ln_flat_widths = nullptr;
  double* ln_force_scale = nullptr;
  double* force_offset_N = nullptr;     ///< of the magnitude
  double* force_offset_xy_N = nullptr;  ///< of the components, 2
  double* force_tilt_deg = nullptr;     ///< these two: of the components
  double* force_weight_N = nullptr;     ///< 2
  /// x, y and magnitude of the log's forces, and the parameter; null if the
  /// sensor is not late.
  const std::array<LinearSignal, 3>* forces_N = nullptr;
  double* force_time_offset_s = nullptr;
  double* object_origin_mm = nullptr;  ///< 2; these three as StageFrame says
  double* object_rotation_deg = nullptr;
  double* ln_object_scale = nullptr;
  double* object_radius_mm = nullptr;  ///< of the circle
  double* camera_origin_mm = nullptr;  ///< 2
};

/// One measurement of a frame as a residual block.
struct FrameBlock {
  std::unique_ptr<ceres::CostFunction> cost;
  std::vector<double*> parameters;  ///< as ceres::Problem takes them
  ResidualFamily family;
  int gauge;         ///< for kGauge and kBench, else -1
  double std_V = 0;  ///< of the reading, for kGauge
};

/// Returns one block for each measurement in `row` that counts. `row`,
/// `evaluation` and `unknowns` (those of FrameEvaluation; null if there are
/// none) must stay in place. A row of the test bench needs the finger's gauges,
/// but neither evaluation nor unknowns.
std::vector<FrameBlock> MeasurementBlocks(const Measurements& row,
                                          const MeasurementModel& model,
                                          const FrameParameters& parameters,
                                          const std::vector<Gauge>& gauges,
                                          const FrameEvaluation* evaluation,
                                          double* unknowns);

/// The measurement blocks of rows that follow each other. They are built once,
/// and the row's numbers are exchanged: rows with the measurements of the row
/// before allocate nothing. Blocks of reference sensors are built for each row.
class FrameBlocks {
 public:
  /// All that is pointed to must stay in place; see MeasurementBlocks.
  FrameBlocks(const MeasurementModel* model, const FrameParameters* parameters,
              const std::vector<Gauge>* gauges,
              const FrameEvaluation* evaluation, double* unknowns)
      : model_(*model),
        parameters_(*parameters),
        gauges_(*gauges),
        evaluation_(evaluation),
        unknowns_(unknowns) {}
  FrameBlocks(const FrameBlocks&) = delete;

  const std::vector<FrameBlock>& Of(const Measurements& row);

 private:
  // Says whether the blocks are those of the measurements of a row.
  bool Fit(const Measurements& row) const;

  const MeasurementModel& model_;
  const FrameParameters& parameters_;
  const std::vector<Gauge>& gauges_;
  const FrameEvaluation* evaluation_;
  double* unknowns_;
  Measurements row_;
  std::vector<FrameBlock> blocks_;
};

/// Returns the blocks that hold equilibrium and rib lengths in the weighted
/// form. `weight` is that of EquilibriumResidual.
std::vector<FrameBlock> EquilibriumBlocks(const Finger& finger, double weight,
                                          const FrameParameters& parameters,
                                          const FrameEvaluation& evaluation,
                                          double* unknowns);

/// The weight that estimation ends with. At a weight of 1e6, contacts and std
/// differ from the reduced form's by about 1e-4 of a std. Above that the
/// difference falls with the square of the weight.
constexpr double kEquilibriumWeight = 1e7;

/// Holds a finger's own parameters at fixed addresses, for blocks whose
/// parameters stay constant.
class FingerParameters {
 public:
  /// The radius is that of the scene's circle, if there is one.
  FingerParameters(const Finger& finger,
                   std::optional<double> circle_radius_mm);
  FingerParameters(const FingerParameters&) = delete;

  const FrameParameters& frame() const { return frame_; }
  SharedParameters* shared() { return &shared_; }
  double* gain(int gauge) { return &gains_[gauge]; }
  double* offset(int gauge) { return &offsets_[gauge]; }
  double* curvature(int gauge) { return &curvatures_[gauge]; }
  double* flat_share(int gauge) { return &flat_shares_[gauge]; }
  double* ln_flat_width(int gauge) { return &ln_flat_widths_[gauge]; }

 private:
  SharedParameters shared_;
  std::vector<double> gains_, offsets_, curvatures_, flat_shares_,
      ln_flat_widths_;
  double ln_force_scale_ = 0, force_offset_N_ = 0;
  double force_tilt_deg_ = 0, force_weight_N_[2] = {};
  double force_offset_xy_N_[2] = {}, object_origin_mm_[2] = {},
         camera_origin_mm_[2] = {};
  double object_rotation_deg_ = 0, ln_object_scale_ = 0, object_radius_mm_;
  FrameParameters frame_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_FRAME_BLOCKS_H_
