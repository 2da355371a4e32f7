#ifndef FINRAY_CONTROL_CONTROL_LOOP_H_
#define FINRAY_CONTROL_CONTROL_LOOP_H_

#include <cstdint>
#include <string>
#include <vector>

#include "finray/control/contact_watch.h"
#include "finray/control/experiment.h"
#include "finray/control/observation.h"
#include "finray/control/plant.h"
#include "finray/sensing/frame_estimate.h"

namespace finray {

/// One period of the loop, at its beginning.
struct LoopRow {
  double time_s = 0;
  double set_point_N = 0;
  double object_motion_mm = 0;
  double drive = 0;    ///< truly
  double command = 0;  ///< given at this time
  double force_N = 0;  ///< truly
  SeenForce seen;      ///< by the estimators; NaN where they see nothing
  LoopMode mode = LoopMode::kApproach;
  bool sure = false;  ///< All fingers see their contact, or that there is none.
  std::vector<PlantFinger> fingers;
  std::vector<Measurements> readings;  ///< with noise, zeroed
  std::vector<FrameEstimate> estimates;
};

struct LoopRun {
  std::vector<LoopRow> rows;
  /// Why the plant has no equilibrium behind the last row; empty if it has.
  std::string failure;
};

/// A closed loop at the rate of the actuation: plant, gauges with their noise,
/// zeroed before the approach (GaugeZero), a LiveEstimator for each finger,
/// ContactWatch, controller, delay and drive, plant. `finger` is what
/// estimators and controllers know; the plant's fingers differ from it by the
/// experiment's model error. Equal seeds give equal fingers and noise to all
/// controllers.
LoopRun RunLoop(const Finger& finger, const Experiment& experiment,
                const ControllerSettings& controller,
                const Discretization& discretization, std::uint64_t seed);

}  // namespace finray

#endif  // FINRAY_CONTROL_CONTROL_LOOP_H_
