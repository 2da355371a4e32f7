#ifndef FINRAY_CONTROL_TOUCH_SIGNAL_H_
#define FINRAY_CONTROL_TOUCH_SIGNAL_H_

#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"

namespace finray {

/// How far a finger's gauges are bent, against a touch.
class TouchSignal {
 public:
  /// The least that touch_N does to the gauges, over contacts from 0.2 to 0.8
  /// of the front beam's length.
  TouchSignal(const Finger& finger, double touch_N,
              const Discretization& discretization);

  /// Largest bending angle of the gauges that read, over that least one; NaN
  /// if one does not read.
  double Of(const Measurements& readings) const;

 private:
  std::vector<Gauge> gauges_;
  double least_rad_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_TOUCH_SIGNAL_H_
