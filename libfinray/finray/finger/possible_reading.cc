#include "finray/finger/possible_reading.h"

#include <algorithm>
#include <cstddef>

namespace finray {

double LargestBending_V(const Gauge& gauge) {
  const double a = kLargestGaugeAngle_rad;
  const double signal = a * (1 + std::abs(gauge.curvature_per_rad) * a +
                             std::abs(gauge.flat_share));
  return std::abs(gauge.gain_V_per_rad) * signal *
         (1 + std::abs(gauge.creep_share));
}

bool IsPossible(const Gauge& gauge, double volts, double wander_V) {
  if (std::isnan(volts)) return true;
  const double bending_V = LargestBending_V(gauge);
  const double off_V = std::abs(volts - gauge.offset_V);
  if (off_V <= bending_V) return true;
  const bool saturated = !gauge.IsInRange(volts);
  return std::abs(volts) <= kLargestReading_V &&
         (saturated || off_V <= bending_V + wander_V);
}

int FirstImpossible(const std::vector<Gauge>& gauges,
                    const std::vector<double>& readings_V, double wander_V) {
  for (std::size_t j = 0; j < std::min(gauges.size(), readings_V.size()); ++j) {
    if (!IsPossible(gauges[j], readings_V[j], wander_V)) {
      return static_cast<int>(j);
    }
  }
  return -1;
}

bool ArePossible(const std::vector<Gauge>& gauges,
                 const std::vector<double>& readings_V, double wander_V) {
  return FirstImpossible(gauges, readings_V, wander_V) < 0;
}

}  // namespace finray
