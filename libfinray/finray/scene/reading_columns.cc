#include "finray/scene/reading_columns.h"

#include <algorithm>

#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/scene/frame_columns.h"

namespace finray {

ReadingColumns::ReadingColumns(const Finger& finger,
                               const std::vector<std::string>& names,
                               const std::string& path) {
  const auto find = [&names](const std::string& name) -> Column {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) return std::nullopt;
    return static_cast<std::size_t>(at - names.begin());
  };
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    const std::string name = GaugeVolts(static_cast<int>(j));
    const Column volts = find(name);
    const Column angle = find(GaugeAngle(static_cast<int>(j)));
    if (!volts && !angle) throw InputError(path + ": " + NoColumn(name, names));
    gauges_.push_back({volts ? *volts : *angle, !volts, gauge});
  }
  object_x_ = find("object_x_mm");
  object_y_ = find("object_y_mm");
  object_angle_ = find("object_angle_deg");
  force_ = find("force_N");
}

}  // namespace finray
