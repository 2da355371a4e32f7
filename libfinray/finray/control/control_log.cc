#include "finray/control/control_log.h"

#include <cmath>

#include "finray/batch/result_columns.h"
#include "finray/scene/frame_columns.h"

namespace finray {

FrameTable ControlLog(const Finger& finger, const Experiment& experiment,
                      const LoopRun& run, int finger_index) {
  FrameTable log(run.rows.size());
  const auto fill = [&](const std::string& name, auto value) {
    std::vector<double>& cells = log.MutableNumbers(name);
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      cells[i] = value(run.rows[i]);
    }
  };
  const bool gripper = experiment.mechanism.is_gripper();
  const double unit = gripper ? 180 / M_PI : 1;
  const std::string drive = gripper ? "motor" : "stage";
  const std::string suffix = gripper ? "_deg" : "_mm";
  fill("time_s", [](const LoopRow& r) { return r.time_s; });
  fill("set_point_N", [](const LoopRow& r) { return r.set_point_N; });
  fill("force_N", [](const LoopRow& r) { return r.force_N; });
  fill("force_estimate_N", [](const LoopRow& r) { return r.seen.force_N; });
  fill("force_estimate_std_N", [](const LoopRow& r) { return r.seen.std_N; });
  fill(drive + suffix, [&](const LoopRow& r) { return unit * r.drive; });
  fill(drive + "_command" + suffix,
       [&](const LoopRow& r) { return unit * r.command; });
  fill("object_motion_mm", [](const LoopRow& r) { return r.object_motion_mm; });
  fill("object_x_mm", [&](const LoopRow& r) {
    return r.fingers[finger_index].object.position_mm.x();
  });
  fill("object_y_mm", [&](const LoopRow& r) {
    return r.fingers[finger_index].object.position_mm.y();
  });
  fill("object_angle_deg", [&](const LoopRow& r) {
    return r.fingers[finger_index].object.angle_rad * 180 / M_PI;
  });
  if (experiment.scene.object->spring) {
    fill("object_displacement_mm", [&](const LoopRow& r) {
      return r.fingers[finger_index].displacement_mm;
    });
  }
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    fill(GaugeVolts(j), [&](const LoopRow& r) {
      return r.readings[finger_index].gauges_V[j];
    });
  }
  Scene one = experiment.scene;
  one.contacts = 1;
  const ResultColumns columns(finger, one);
  std::vector<double> values(columns.names().size());
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    columns.Values(run.rows[i].readings[finger_index],
                   run.rows[i].estimates[finger_index], values.data());
    for (std::size_t c = 0; c < values.size(); ++c) {
      log.MutableNumbers(columns.names()[c])[i] = values[c];
    }
  }
  std::vector<std::string>& mode = log.MutableText("mode");
  std::vector<std::string>& status = log.MutableText("status");
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    mode[i] = LoopModeName(run.rows[i].mode);
    status[i] = StatusName(run.rows[i].estimates[finger_index].status);
  }
  return log;
}

}  // namespace finray
