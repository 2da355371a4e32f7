#include "finray/control/touch_signal.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/statics/equilibrium.h"

namespace finray {
namespace {

constexpr double kFrom = 0.2, kTo = 0.8;  // of the front beam's length
constexpr int kPlaces = 25;

}  // namespace

TouchSignal::TouchSignal(const Finger& finger, double touch_N,
                         const Discretization& discretization)
    : gauges_(finger.gauges),
      least_rad_(std::numeric_limits<double>::infinity()) {
  EquilibriumSolver solver(finger, discretization);
  for (int i = 0; i < kPlaces; ++i) {
    const double share = kFrom + (kTo - kFrom) * i / (kPlaces - 1);
    if (!solver.Solve({{share * finger.front_length_mm, touch_N}})) continue;
    double largest = 0;
    for (int j = 0; j < static_cast<int>(gauges_.size()); ++j) {
      largest = std::max(largest, std::abs(solver.gauge_angle(j)));
    }
    least_rad_ = std::min(least_rad_, largest);
  }
}

double TouchSignal::Of(const Measurements& readings) const {
  double largest = 0;
  for (std::size_t j = 0; j < gauges_.size(); ++j) {
    const double reading_V = readings.gauges_V[j];
    if (!gauges_[j].IsMeasured(reading_V)) return std::nan("");
    largest = std::max(largest, std::abs(gauges_[j].Angle(reading_V)));
  }
  return largest / least_rad_;
}

}  // namespace finray
