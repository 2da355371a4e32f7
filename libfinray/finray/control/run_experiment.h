#ifndef FINRAY_CONTROL_RUN_EXPERIMENT_H_
#define FINRAY_CONTROL_RUN_EXPERIMENT_H_

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "finray/control/control_loop.h"
#include "finray/io/frame_table.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// Sums of errors. Sums of several draws can be added.
struct ErrorSums {
  std::size_t count = 0;
  double sum = 0, squares = 0, most = 0;

  void Add(double error) { Add({1, error, error * error, std::abs(error)}); }
  void Add(const ErrorSums& other);
  double mean() const { return sum / static_cast<double>(count); }
  double rms() const { return std::sqrt(squares / static_cast<double>(count)); }
};

/// Statistics of the runs of one controller, over the rows from measure_from_s.
struct ControlStatistics {
  std::size_t runs = 0, failed_runs = 0, stopped_runs = 0;
  std::size_t periods = 0;     ///< number of rows counted
  std::size_t controlled = 0;  ///< number of these in mode control
  ErrorSums control;           ///< true force minus set-point
  ErrorSums settled;           ///< the same, from settled_after_s after a step
  /// Estimated minus true force, in the rows where every finger is sure.
  ErrorSums estimate;
  double worst_rms_N = 0;  ///< of the control errors of one run
  double best_rms_N = std::numeric_limits<double>::infinity();
  std::string failure;  ///< of the first run that ended early

  /// Returns the errors of the control, or those of the estimate if there is no
  /// controller.
  const ErrorSums& errors() const {
    return control.count > 0 ? control : estimate;
  }
  void Add(const ControlStatistics& other);
};

/// Statistics of one run. A run without a controller has no control error.
ControlStatistics StatisticsOf(const LoopRun& run, const Experiment& experiment,
                               bool controlled);

/// The lag of the force behind the set-point: the shift, from -0.2 to 0.6 s in
/// steps of 1 ms, with the least sum of squared errors from measure_from_s.
double LagSeconds(const LoopRun& run, const Experiment& experiment);

/// The result of one controller in an experiment.
struct ControllerResult {
  ControllerSettings controller;
  LoopRun first;                 ///< the run of the first draw
  ControlStatistics statistics;  ///< over all draws
  std::optional<double> lag_s;   ///< of `first`, for a harmonic set-point
};

/// Runs all controllers over all draws. Draw d has the seed `seed` + d, so
/// results do not depend on the threads. After every run `progress` gets its
/// number of periods; calls do not overlap.
std::vector<ControllerResult> RunExperiment(
    const Finger& finger, const Experiment& experiment,
    const Discretization& discretization, std::uint64_t seed, int threads,
    const std::function<void(std::size_t)>& progress = {});

/// Names of the logs of a controller's first draw:
/// "<experiment>.<controller>.csv", with ".finger_1" and ".finger_2" before
/// ".csv" for a gripper.
std::vector<std::string> ControlLogNames(const Experiment& experiment,
                                         const ControllerSettings& controller);

/// One finger's part of a run as a frame table that finray_estimate reads:
/// gauges as read, object_* as it truly is in that finger's frame S, force_N as
/// a sensor in the object reads it, all columns of the estimate, and the loop's
/// own columns set_point_N, force_estimate_N, force_estimate_std_N, stage_mm
/// and stage_command_mm (or motor_deg, motor_command_deg), object_motion_mm,
/// mode.
FrameTable ControlLog(const Finger& finger, const Experiment& experiment,
                      const LoopRun& run, int finger_index);

/// Writes one experiment of a summary.yaml (docs/reference/formats.md) as a
/// mapping.
void EmitExperiment(const std::string& path, const Experiment& experiment,
                    const std::vector<ControllerResult>& results,
                    YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_CONTROL_RUN_EXPERIMENT_H_
