#ifndef FINRAY_CONTROL_CONTROL_LOOP_H_
#define FINRAY_CONTROL_CONTROL_LOOP_H_

#include <cstdint>
#include <string>
#include <vector>

#include "finray/control/contact_watch.h"
#include "finray/control/controller.h"
#include "finray/control/experiment.h"
#include "finray/control/plant.h"
#include "finray/estimation/frame_estimate.h"
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

/// The state of the loop at the start of a period.
struct LoopRow {
  double time_s = 0;
  double set_point_N = 0;
  double object_motion_mm = 0;
  double drive = 0;    ///< true position
  double command = 0;  ///< given at this time
  double force_N = 0;  ///< true force
  MeanForce seen;      ///< estimated; NaN without an estimate
  LoopMode mode = LoopMode::kApproach;
  bool sure =
      false;  ///< Every finger sees its contact or sees that it is free.
  std::vector<PlantFinger> fingers;
  std::vector<Measurements> readings;  ///< with noise, zeroed
  std::vector<FrameEstimate> estimates;
};

struct LoopRun {
  std::vector<LoopRow> rows;
  /// Why the plant has no equilibrium after the last row; empty if it has one.
  std::string failure;
};

/// Simulates a closed loop at the rate of the actuation: plant, noisy gauges
/// (zeroed before the approach, GaugeZero), a FrameEstimator for each finger,
/// ContactWatch, controller, drive with delay, plant. Estimators and
/// controllers know `finger`; the plant's fingers differ from it by the
/// experiment's model error. The seed determines fingers and noise for any
/// controller. A controller knows the finger's model, the mechanism, the
/// actuation, the friction and, if the object is a circle, its radius; other
/// objects count as points. Throws InputError if the model has no contact for
/// which the PI can be tuned.
LoopRun RunLoop(const Finger& finger, const Experiment& experiment,
                const ControllerSettings& controller,
                const Discretization& discretization, std::uint64_t seed);

}  // namespace finray

#endif  // FINRAY_CONTROL_CONTROL_LOOP_H_
