#ifndef FINRAY_SCENE_FRAME_MEASUREMENT_H_
#define FINRAY_SCENE_FRAME_MEASUREMENT_H_

#include <Eigen/Core>
#include <optional>

#include "finray/finger/finger.h"
#include "finray/scene/frame_readings.h"
#include "finray/scene/scene.h"

namespace finray {

/// A frame's readings as ContactFit takes them: angles of the gauges in rad
/// and, if the scene measures it, the circle's centre in mm behind them, with
/// weights 1 / std, 0 where there is no reading or a saturated one.
struct FrameMeasurement {
  Eigen::VectorXd values, weights;
  int gauges = 0;  ///< measured ones
  int all = 0;     ///< with the centre's coordinates
};

/// Fills `measurement`, whose memory is used again. Throws
/// std::invalid_argument unless there is a reading (or NaN) for every gauge.
void Measure(const Finger& finger, const Scene& scene,
             const FrameReadings& readings, FrameMeasurement* measurement);

/// The radius of the circle whose centre the scene measures, if it does.
std::optional<double> MeasuredRadius(const Scene& scene);

}  // namespace finray

#endif  // FINRAY_SCENE_FRAME_MEASUREMENT_H_
