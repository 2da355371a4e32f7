#ifndef FINRAY_SCENE_READING_COLUMNS_H_
#define FINRAY_SCENE_READING_COLUMNS_H_

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/scene/frame_readings.h"

namespace finray {

/// Where a log holds what was measured: gauge_<j>_V or, where that is all there
/// is, gauge_<j>_rad; object_x_mm, object_y_mm, object_angle_deg and force_N if
/// it has them.
class ReadingColumns {
 public:
  /// Throws InputError if a gauge of the finger has no column.
  ReadingColumns(const Finger& finger, const std::vector<std::string>& names,
                 const std::string& path);

  /// Reads one row; number(i) is its cell in the column names[i].
  template <class Number>
  void Read(Number number, FrameReadings* readings) const {
    readings->gauges_V.resize(gauges_.size());
    for (std::size_t j = 0; j < gauges_.size(); ++j) {
      const GaugeColumn& of = gauges_[j];
      const double value = number(of.column);
      readings->gauges_V[j] = of.angle ? of.gauge.Volts(value) : value;
    }
    const auto read = [&](Column column, double otherwise) {
      const double value = column ? number(*column) : otherwise;
      return std::isnan(value) ? otherwise : value;
    };
    readings->object_x_mm = read(object_x_, std::nan(""));
    readings->object_y_mm = read(object_y_, std::nan(""));
    readings->object_angle_rad = read(object_angle_, 0) * M_PI / 180;
  }

  /// The reference force, NaN if there is none.
  template <class Number>
  double Force(Number number) const {
    return force_ ? number(*force_) : std::nan("");
  }

 private:
  using Column = std::optional<std::size_t>;
  struct GaugeColumn {
    std::size_t column;
    bool angle;
    Gauge gauge;
  };

  std::vector<GaugeColumn> gauges_;
  Column object_x_, object_y_, object_angle_, force_;
};

}  // namespace finray

#endif  // FINRAY_SCENE_READING_COLUMNS_H_
