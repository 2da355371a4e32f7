#include "finray/calib/calibration_log.h"

#include <algorithm>
#include <cmath>

#include "finray/io/error.h"
#include "finray/io/frame_table.h"

namespace finray {
namespace {

constexpr double kSignificant = 3;  // standard deviations
// A block of neighbouring frames is held out as one, as neighbours share
// errors.
constexpr int kHoldoutBlock = 10;

bool Touches(const CalibrationFrame& frame, const Finger& finger,
             const Plan& plan) {
  if (plan.scene.contacts) return *plan.scene.contacts > 0;
  if (frame.force_xy_N.allFinite()) {
    return frame.force_xy_N.norm() > kSignificant * plan.force_std_N;
  }
  if (std::isfinite(frame.force_N)) {
    return frame.force_N > kSignificant * plan.force_std_N;
  }
  if (frame.object_mm.allFinite() && plan.scene.circle_radius_mm()) {
    // Depth past the undeformed front beam, which lies on x = 0.
    const double nearest_y =
        std::clamp(frame.object_mm.y(), 0.0, finger.front_length_mm);
    const double over = frame.object_mm.y() - nearest_y;
    const double reach =
        frame.object_mm.x() +
        std::sqrt(std::max(
            0.0, std::pow(*plan.scene.circle_radius_mm(), 2) - over * over));
    return reach > kSignificant * plan.object_std_mm;
  }
  return true;
}

void MarkHoldout(const Plan& plan, CalibrationLogs* logs) {
  if (plan.holdout_by == HoldoutBy::kNothing) return;
  const auto every = static_cast<int>(std::lround(1 / plan.holdout_fraction));
  if (plan.holdout_by == HoldoutBy::kLog) {
    const int n = static_cast<int>(logs->paths.size());
    if (n < 2) {
      throw InputError("holdout by log needs at least 2 logs, got " +
                       std::to_string(n) + "; use {by: block}");
    }
    // Spread over the list; at least one log on either side.
    const int count = std::clamp(
        static_cast<int>(std::lround(plan.holdout_fraction * n)), 1, n - 1);
    for (CalibrationFrame& frame : logs->frames) {
      frame.held_out = (frame.log + 1) * count / n > frame.log * count / n;
    }
    return;
  }
  for (CalibrationFrame& frame : logs->frames) {
    const int block = frame.row / kHoldoutBlock;
    frame.held_out = every > 1 && block % every == every - 1;
  }
  const auto held = std::count_if(
      logs->frames.begin(), logs->frames.end(),
      [](const CalibrationFrame& frame) { return frame.held_out; });
  if (held == 0 || held == static_cast<long>(logs->frames.size())) {
    throw InputError("holdout by block: the logs are too short, " +
                     std::to_string(logs->frames.size()) +
                     " frames in all; blocks have " +
                     std::to_string(kHoldoutBlock));
  }
}

}  // namespace

CalibrationLogs ReadCalibrationLogs(const std::vector<std::string>& paths,
                                    const Finger& finger, const Plan& plan) {
  CalibrationLogs logs;
  logs.paths = paths;
  const int gauges = static_cast<int>(finger.gauges.size());
  for (std::size_t log = 0; log < paths.size(); ++log) {
    const FrameTable table = FrameTable::Read(paths[log], plan.columns);
    std::vector<const std::vector<double>*> volts;
    for (int j = 1; j <= gauges; ++j) {
      volts.push_back(&table.Numbers("gauge_" + std::to_string(j) + "_V"));
    }
    const auto column = [&](const char* name) {
      return table.NumbersOrNan(name);
    };
    const auto time = column("time_s"), force = column("force_N"),
               force_x = column("force_x_N"), force_y = column("force_y_N"),
               object_x = column("object_x_mm"),
               object_y = column("object_y_mm"),
               contact = column("contact_1_mm");
    for (std::size_t row = 0; row < table.rows(); ++row) {
      CalibrationFrame frame;
      frame.log = static_cast<int>(log);
      frame.row = static_cast<int>(row);
      frame.time_s = time[row];
      for (std::size_t j = 0; j < volts.size(); ++j) {
        const double reading = (*volts[j])[row];
        frame.gauges_V.push_back(
            IsMeasured(finger.gauges[j], reading) ? reading : std::nan(""));
      }
      frame.force_N = force[row];
      frame.force_xy_N = {force_x[row], force_y[row]};
      frame.object_mm = {object_x[row], object_y[row]};
      frame.contact_mm = contact[row];
      frame.contact = Touches(frame, finger, plan);
      logs.frames.push_back(std::move(frame));
    }
  }
  MarkHoldout(plan, &logs);
  return logs;
}

}  // namespace finray
