#ifndef FINRAY_CONTROL_GAUGE_ZERO_H_
#define FINRAY_CONTROL_GAUGE_ZERO_H_

#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"

namespace finray {

/// Zeroes a finger's gauges while nothing touches it: what their mean differs
/// from what the model of the free finger says is taken off every later
/// reading. Errors of the offsets, and what wrong rib lengths bend a free
/// finger, are gone but for the noise of the mean.
class GaugeZero {
 public:
  GaugeZero(const Finger& finger, const Discretization& discretization);

  /// A reading of the free finger.
  void Add(const Measurements& readings);
  /// Takes the zero off; without a free reading before, nothing.
  void Apply(Measurements* readings) const;

 private:
  std::vector<double> free_V_, sum_V_;
  int count_ = 0;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_GAUGE_ZERO_H_
