#ifndef FINRAY_SCENE_SIMULATION_H_
#define FINRAY_SCENE_SIMULATION_H_

#include <cstdint>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/io/frame_table.h"
#include "finray/scene/scene.h"

namespace finray {

/// Counts of a simulated table by row.
struct SimulationSummary {
  int contact = 0, free = 0, not_converged = 0;
  /// Why the first row that failed did.
  std::string first_failure;
};

/// Solves every row of `frames` and fills in gauges, rib forces and pins, tip,
/// contact poses, force_N and status. A row's load is, in this order:
///  - point contacts: contact_<c>_mm, normal_<c>_N, friction_<c> (default the
///    scene's), as many as the columns give, each on the beam that the scene
///    says;
///  - the scene's object at object_x_mm, object_y_mm, turned by
///    object_angle_deg (default 0). Its contacts are filled in too:
///    contact_<c>, normal_<c> for as many as the row with most has, and
///    object_displacement_mm if it stands on a spring;
///  - nothing.
/// If `shapes` is given it receives both beams of every row: columns row, beam,
/// arc_mm, x_mm, y_mm, angle_rad, moment_N_mm. Throws InputError naming the
/// line of a load that is incomplete, negative or off the beam.
SimulationSummary Simulate(const Finger& finger, const Scene& scene,
                           const Discretization& discretization,
                           FrameTable* frames, FrameTable* shapes = nullptr);

/// Standard deviations of what a lab's log adds to the truth; gauges have their
/// own noise_V.
struct LogNoise {
  double force_std_N = 0;
  double object_std_mm = 0;
  std::uint64_t seed = 1;
  double pin_std_mm = 0;  ///< 0: no camera
};

/// What a lab would have recorded of simulated frames: time_s, gauge_<j>_V,
/// force_N, the object's place (its turn without noise) where there is one and
/// rib pins where there is a camera, with Gaussian noise, and nothing of the
/// truth. Rows that were not solved are left out.
FrameTable MakeLog(const Finger& finger, const FrameTable& simulated,
                   const LogNoise& noise);

}  // namespace finray

#endif  // FINRAY_SCENE_SIMULATION_H_
