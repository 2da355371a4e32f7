#ifndef FINRAY_ESTIMATION_PACKED_READINGS_H_
#define FINRAY_ESTIMATION_PACKED_READINGS_H_

#include <Eigen/Core>
#include <optional>

#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"

namespace finray {

/// A row in the form that the tables take: the gauges'
/// angles in rad and, if the scene measures it, the circle's centre in mm
/// behind them. Weights are 1 / std, or 0 for missing and saturated readings.
struct PackedReadings {
  Eigen::VectorXd values, weights;
  int gauges = 0;        ///< Number of gauges with a reading.
  int camera = 0;        ///< Number of coordinates of pins and tip.
  int all = 0;           ///< Both, plus the coordinates of the circle's centre.
  double free_chi2 = 0;  ///< Of the free finger; the caller of Pack() sets it.
};

/// Fills `packed`, whose memory is reused. Throws std::invalid_argument unless
/// the row has a reading (or NaN) for every gauge.
void Pack(const Finger& finger, const Scene& scene, const Measurements& row,
          PackedReadings* packed);

/// The radius of the circle whose centre the scene measures; empty if there is
/// none.
std::optional<double> MeasuredRadius(const Scene& scene);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_PACKED_READINGS_H_
