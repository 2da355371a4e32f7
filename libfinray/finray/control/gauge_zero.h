#ifndef FINRAY_CONTROL_GAUGE_ZERO_H_
#define FINRAY_CONTROL_GAUGE_ZERO_H_

#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"

namespace finray {

/// Zeroes the gauges of a free finger. It subtracts from every later reading
/// the difference between the mean free reading and the model's. This removes
/// errors of offsets, and of rib lengths as far as they bend the free finger;
/// the noise of the mean remains.
class GaugeZero {
 public:
  /// Throws InputError if the free finger has no equilibrium.
  GaugeZero(const Finger& finger, const Discretization& discretization);

  /// Adds a reading of the free finger.
  void Add(const Measurements& readings);
  /// Corrects a reading; without any free reading it stays as it is.
  void Apply(Measurements* readings) const;

 private:
  std::vector<double> free_V_, sum_V_;
  int count_ = 0;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_GAUGE_ZERO_H_
