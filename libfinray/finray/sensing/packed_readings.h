#ifndef FINRAY_SENSING_PACKED_READINGS_H_
#define FINRAY_SENSING_PACKED_READINGS_H_

#include <Eigen/Core>
#include <optional>

#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"

namespace finray {

/// A row as tables and the fast solver take it: angles of the gauges in rad
/// and, if the scene measures it, the circle's centre in mm behind them, with
/// weights 1 / std, 0 where there is no reading or a saturated one.
struct PackedReadings {
  Eigen::VectorXd values, weights;
  int gauges = 0;  ///< Gauges with a reading.
  int camera = 0;  ///< Coordinates of pins and of the tip.
  int all = 0;     ///< Both, and the coordinates of the circle's centre.
};

/// Fills `packed`, whose memory is used again. Throws
/// std::invalid_argument unless there is a reading (or NaN) for every gauge.
void Pack(const Finger& finger, const Scene& scene, const Measurements& row,
          PackedReadings* packed);

/// The radius of the circle whose centre the scene measures, if it does.
std::optional<double> MeasuredRadius(const Scene& scene);

}  // namespace finray

#endif  // FINRAY_SENSING_PACKED_READINGS_H_
