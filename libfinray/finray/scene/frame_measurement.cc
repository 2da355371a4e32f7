#include "finray/scene/frame_measurement.h"

#include <cmath>
#include <stdexcept>

namespace finray {

void Measure(const Finger& finger, const Scene& scene,
             const FrameReadings& readings, FrameMeasurement* measurement) {
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  if (readings.gauges_V.size() != finger.gauges.size()) {
    throw std::invalid_argument("expected one reading for each gauge");
  }
  const Eigen::Index rows = gauges + (scene.object_std_mm ? 2 : 0);
  FrameMeasurement& m = *measurement;
  m.values.setZero(rows);
  m.weights.setZero(rows);
  m.gauges = 0;
  for (Eigen::Index j = 0; j < gauges; ++j) {
    const Gauge& gauge = finger.gauges[j];
    const double reading = readings.gauges_V[j];
    if (!gauge.IsMeasured(reading)) continue;
    ++m.gauges;
    m.values[j] = gauge.Angle(reading);
    m.weights[j] = gauge.AngleWeight();
  }
  m.all = m.gauges;
  if (!scene.object_std_mm) return;
  const double place[] = {readings.object_x_mm, readings.object_y_mm};
  for (int i = 0; i < 2; ++i) {
    if (!std::isfinite(place[i])) continue;
    ++m.all;
    m.values[gauges + i] = place[i];
    m.weights[gauges + i] = 1 / *scene.object_std_mm;
  }
}

std::optional<double> MeasuredRadius(const Scene& scene) {
  return scene.object_std_mm ? scene.circle_radius_mm() : std::nullopt;
}

}  // namespace finray
