#ifndef FINRAY_CONTROL_TOUCH_SIGNAL_H_
#define FINRAY_CONTROL_TOUCH_SIGNAL_H_

#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"

namespace finray {

/// The bending of a finger's gauges in units of a given touch.
class TouchSignal {
 public:
  /// The unit is the least angle that a force of touch_N causes in the most
  /// bent gauge, over contacts from 0.2 to 0.8 of the front beam's length.
  TouchSignal(const Finger& finger, double touch_N,
              const Discretization& discretization);

  /// The largest bending angle of the gauges, in that unit; NaN if a gauge
  /// reads nothing or is saturated.
  double Of(const Measurements& readings) const;

 private:
  std::vector<Gauge> gauges_;
  double least_rad_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_TOUCH_SIGNAL_H_
