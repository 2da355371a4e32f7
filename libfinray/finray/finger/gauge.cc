#include <algorithm>
#include <limits>

#include "finray/finger/finger.h"

namespace finray {

// Newton's steps from the angle that the curvature alone gives. The signal is
// convex or concave from 0 on, so that all steps but the first come from one
// side.
double Gauge::FlatAngle(double signal) const {
  constexpr int kMostSteps = 60;
  constexpr double kTolerance_rad = 1e-13;
  double angle = Unbend(signal);
  for (int step = 0; step < kMostSteps; ++step) {
    const double slope = Slope(angle) / gain_V_per_rad;
    if (!(slope > 0)) break;
    const double change = (signal - Signal(angle)) / slope;
    angle += change;
    if (std::abs(change) < kTolerance_rad) return angle;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

bool HasFlatGauges(const Finger& finger) {
  if (finger.calibration) {
    for (const FingerParameter& p : finger.calibration->parameters) {
      if (p.kind == FingerParameterKind::kGaugeFlatShare) return true;
    }
  }
  return std::any_of(finger.gauges.begin(), finger.gauges.end(),
                     [](const Gauge& gauge) { return gauge.flat_share != 0; });
}

}  // namespace finray
