#include "finray/estimation/packed_readings.h"

#include <cmath>
#include <stdexcept>

#include "finray/estimation/free_frame.h"
#include "finray/finger/possible_reading.h"

namespace finray {

void Pack(const Finger& finger, const Scene& scene, const Measurements& row,
          PackedReadings* packed) {
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  if (row.gauges_V.size() != finger.gauges.size()) {
    throw std::invalid_argument("expected one reading for each gauge");
  }
  const Eigen::Index size = gauges + (scene.object_std_mm ? 2 : 0);
  PackedReadings& p = *packed;
  p.values.setZero(size);
  p.weights.setZero(size);
  p.gauges = p.camera = p.all = 0;
  if (!ArePossible(finger.gauges, row.gauges_V, OffsetsWander_V(scene))) return;
  for (Eigen::Index j = 0; j < gauges; ++j) {
    const Gauge& gauge = finger.gauges[j];
    if (!gauge.IsMeasured(row.gauges_V[j])) continue;
    ++p.gauges;
    p.values[j] = gauge.Angle(row.gauges_V[j]);
    p.weights[j] = std::abs(gauge.Slope(p.values[j])) /
                   row.GaugeStd_V(static_cast<std::size_t>(j), gauge.noise_V);
  }
  if (scene.pin_std_mm) p.camera += 2 * static_cast<int>(row.pins.size());
  if (scene.tip_std_mm && row.tip_mm.allFinite()) p.camera += 2;
  p.all = p.gauges + p.camera;
  if (!scene.object_std_mm) return;
  for (int i = 0; i < 2; ++i) {
    if (!std::isfinite(row.object_mm[i])) continue;
    ++p.all;
    p.values[gauges + i] = row.object_mm[i];
    p.weights[gauges + i] = 1 / *scene.object_std_mm;
  }
}

std::optional<double> MeasuredRadius(const Scene& scene) {
  return scene.object_std_mm ? scene.circle_radius_mm() : std::nullopt;
}

}  // namespace finray
