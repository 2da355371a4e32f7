#ifndef FINRAY_CONTROL_CONTROL_FILES_H_
#define FINRAY_CONTROL_CONTROL_FILES_H_

#include <string>
#include <vector>

#include "finray/control/run_experiment.h"
#include "finray/io/frame_table.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

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

#endif  // FINRAY_CONTROL_CONTROL_FILES_H_
