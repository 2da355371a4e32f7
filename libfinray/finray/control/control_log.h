#ifndef FINRAY_CONTROL_CONTROL_LOG_H_
#define FINRAY_CONTROL_CONTROL_LOG_H_

#include "finray/control/control_loop.h"
#include "finray/io/frame_table.h"

namespace finray {

/// A run as a frame table, one finger of it: gauges as read, object_* as it
/// truly is in that finger's frame S, force_N what a sensor in the object
/// reads, all columns of its estimate, and those of the loop: set_point_N,
/// force_estimate_N, force_estimate_std_N, stage_mm and stage_command_mm (or
/// motor_deg, motor_command_deg), object_motion_mm, mode. finray_estimate takes
/// it.
FrameTable ControlLog(const Finger& finger, const Experiment& experiment,
                      const LoopRun& run, int finger_index);

}  // namespace finray

#endif  // FINRAY_CONTROL_CONTROL_LOG_H_
