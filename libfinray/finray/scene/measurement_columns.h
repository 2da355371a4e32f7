#ifndef FINRAY_SCENE_MEASUREMENT_COLUMNS_H_
#define FINRAY_SCENE_MEASUREMENT_COLUMNS_H_

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/io/frame_table.h"
#include "finray/scene/measurements.h"

namespace finray {

/// Finds the measurement columns of a table and reads its rows. Every reader of
/// Measurements uses this class, for streams and for tables in memory.
class MeasurementColumns {
 public:
  struct Options {
    /// Accept a column gauge_<j>_rad where gauge_<j>_V is missing. The angle is
    /// converted to the volts that the finger's gauge reads there.
    bool angles = true;
    /// Accept a gauge without a column; its readings are NaN.
    bool gauges_may_lack = false;
    bool camera = false;  ///< read rib pins and the tip
  };

  /// `names` are the table's columns. Throws InputError if a gauge of the
  /// finger has no column, unless the options allow that.
  MeasurementColumns(const Finger& finger,
                     const std::vector<std::string>& names,
                     const std::string& path, const Options& options);

  /// Reads one row into `row`, whose memory is reused. number(i) returns the
  /// row's cell in column i.
  template <class Number>
  void Read(Number number, Measurements* row) const {
    const auto read = [&](Column column) {
      return column ? number(*column) : Measurements::kNotMeasured;
    };
    const auto read_point = [&](const PointColumns& point) {
      return Eigen::Vector2d(read(point[0]), read(point[1]));
    };
    row->gauges_V.resize(gauges_.size());
    for (std::size_t j = 0; j < gauges_.size(); ++j) {
      const double value = read(columns_[j].at);
      row->gauges_V[j] = columns_[j].is_angle ? gauges_[j].Volts(value) : value;
    }
    row->gauge_readings = CountOr1(read(gauge_readings_));
    row->force_readings = CountOr1(read(force_readings_));
    row->time_s = read(time_);
    row->force_N = read(force_);
    row->force_xy_N = read_point(force_xy_);
    row->object_mm = read_point(object_);
    const double angle_deg = read(object_angle_);
    row->object_angle_rad = std::isnan(angle_deg) ? 0 : angle_deg * M_PI / 180;
    row->contact_mm = read(contact_);
    row->temperature_C = read(temperature_);
    row->cylinder_radius_mm = read(cylinder_);
    row->tip_mm = read_point(tip_);
    row->pins.clear();
    for (const PinColumns& pin : pins_) {
      const Eigen::Vector2d at = read_point(pin.at);
      if (at.allFinite()) row->pins.push_back({pin.rib, pin.side, at});
    }
  }

 private:
  static double CountOr1(double readings) {
    constexpr double kMost = 1e9;
    return readings > 1 && readings < kMost ? readings : 1;
  }

  using Column = std::optional<std::size_t>;
  using PointColumns = std::array<Column, 2>;
  struct GaugeColumn {
    Column at;
    bool is_angle;
  };
  struct PinColumns {
    int rib;
    Side side;
    PointColumns at;
  };

  std::vector<Gauge> gauges_;
  std::vector<GaugeColumn> columns_;  // by gauge
  Column gauge_readings_, force_readings_;
  Column time_, force_, object_angle_, contact_, temperature_, cylinder_;
  PointColumns force_xy_, object_, tip_;
  std::vector<PinColumns> pins_;
};

/// Reads all rows of a table.
std::vector<Measurements> ReadMeasurements(
    const FrameTable& table, const Finger& finger,
    const MeasurementColumns::Options& options = {});

}  // namespace finray

#endif  // FINRAY_SCENE_MEASUREMENT_COLUMNS_H_
