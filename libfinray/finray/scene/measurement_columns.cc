#include "finray/scene/measurement_columns.h"

#include <algorithm>

#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/scene/frame_columns.h"

namespace finray {

MeasurementColumns::MeasurementColumns(const Finger& finger,
                                       const std::vector<std::string>& names,
                                       const std::string& path,
                                       const Options& options)
    : gauges_(finger.gauges) {
  const auto find = [&names](const std::string& name) -> Column {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) return std::nullopt;
    return static_cast<std::size_t>(at - names.begin());
  };
  for (int j = 0; j < static_cast<int>(gauges_.size()); ++j) {
    const Column volts = find(GaugeVolts(j));
    const Column angle = options.angles ? find(GaugeAngle(j)) : std::nullopt;
    if (!volts && !angle && !options.gauges_may_lack) {
      throw InputError(path + ": " + NoColumn(GaugeVolts(j), names));
    }
    columns_.push_back({volts ? volts : angle, !volts && angle});
  }
  gauge_readings_ = find("gauge_readings");
  force_readings_ = find("force_readings");
  time_ = find("time_s");
  force_ = find("force_N");
  force_xy_ = {find("force_x_N"), find("force_y_N")};
  object_ = {find("object_x_mm"), find("object_y_mm")};
  object_angle_ = find("object_angle_deg");
  contact_ = find("contact_1_mm");
  temperature_ = find("temperature_C");
  cylinder_ = find("cylinder_radius_mm");
  if (!options.camera) return;
  tip_ = {find("tip_x_mm"), find("tip_y_mm")};
  for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      const PointColumns at = {find(RibPin(i, SideName(side), "x")),
                               find(RibPin(i, SideName(side), "y"))};
      if (at[0] && at[1]) pins_.push_back({i, side, at});
    }
  }
}

std::vector<Measurements> ReadMeasurements(
    const FrameTable& table, const Finger& finger,
    const MeasurementColumns::Options& options) {
  const std::vector<std::string> names = table.headers();
  const MeasurementColumns columns(finger, names, table.path(), options);
  std::vector<const std::vector<double>*> cells;
  for (const std::string& name : names) {
    cells.push_back(IsFrameColumn(name) ? &table.Numbers(name) : nullptr);
  }
  std::vector<Measurements> rows(table.rows());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    columns.Read([&](std::size_t column) { return (*cells[column])[row]; },
                 &rows[row]);
  }
  return rows;
}

}  // namespace finray
