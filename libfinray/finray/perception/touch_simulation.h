#ifndef FINRAY_PERCEPTION_TOUCH_SIMULATION_H_
#define FINRAY_PERCEPTION_TOUCH_SIMULATION_H_

#include <cstdint>
#include <string>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/io/frame_table.h"
#include "finray/objects/outline.h"
#include "finray/perception/polygon.h"

namespace finray {

/// How an object is brought to the finger, as in V-C of the paper: turned in
/// equal steps, and pressed in along +x with the point that leads, the one
/// farthest towards the finger, at a given height.
struct TouchProtocol {
  int orientations = 36;
  double height_mm = 65;
  double force_N = 3;  ///< The stage goes on until the finger is pressed so.
};

/// Noise of what is recorded: gauges have their own noise_V, the stage reads
/// its place with an error.
struct TouchNoise {
  bool gauges = true;
  double stage_std_mm = 0;
  std::uint64_t seed = 1;
};

/// The log of these touches: gauge_<j>_V, object_x_mm, object_y_mm,
/// object_angle_deg, force_N, one row an orientation. `plant` is the finger as
/// it is. Throws std::runtime_error for an object without an equilibrium.
FrameTable SimulateTouches(const Finger& plant, const Outline& outline,
                           const Discretization& discretization,
                           const TouchProtocol& protocol,
                           const TouchNoise& noise);

/// An outline as points at equal arc lengths.
Polygon SampledOutline(const Outline& outline, int count = 1440);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_TOUCH_SIMULATION_H_
