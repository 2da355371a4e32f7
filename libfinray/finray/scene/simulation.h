#ifndef FINRAY_SCENE_SIMULATION_H_
#define FINRAY_SCENE_SIMULATION_H_

#include <cstdint>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/io/frame_table.h"
#include "finray/scene/scene.h"

namespace finray {

/// Counts the rows of a simulated table by outcome.
struct SimulationSummary {
  int contact = 0, free = 0, not_converged = 0;
  /// The reason why the first failed row failed.
  std::string first_failure;
};

/// Solves every row of `frames` and fills in gauges, rib forces, rib pins, tip,
/// contact poses, force_N and status. A row's load is the first of these that
/// it has:
/// - point contacts: contact_<c>_mm, normal_<c>_N, friction_<c> (default: the
///   scene's friction). The columns set their number, the scene their beams;
/// - the scene's object at object_x_mm, object_y_mm, turned by object_angle_deg
///   (default 0). With a presliding displacement the rows are in the order
///   of time: friction depends on the rows before (SlidingFriction), or is that
///   of the scene if the object touches at several points. The simulation then
///   also fills in contact_<c>, normal_<c> and, if it follows the motion,
///   friction_<c>, as many as the row with most contacts has, and
///   object_displacement_mm if the object stands on a spring;
/// - no load.
///
/// Gauges that creep lag behind the angles of the rows before, which run
/// linearly from time_s to time_s; the finger of the first row has been at
/// rest.
///
/// If `shapes` is given it receives both beams of every row in the columns row,
/// beam, arc_mm, x_mm, y_mm, angle_rad, moment_N_mm. Throws InputError with the
/// line of a load that is incomplete, negative or off the beam, and without
/// time_s if a gauge creeps.
SimulationSummary Simulate(const Finger& finger, const Scene& scene,
                           const Discretization& discretization,
                           FrameTable* frames, FrameTable* shapes = nullptr);

/// Standard deviations of the noise that a lab's log adds to the truth. The
/// gauges' noise is not here: each gauge has its own noise_V.
struct LogNoise {
  double force_std_N = 0;
  double object_std_mm = 0;
  std::uint64_t seed = 1;
  double pin_std_mm = 0;  ///< 0: no camera
};

/// Returns the log that a lab would record of simulated frames, with Gaussian
/// noise: time_s, gauge_<j>_V, force_N, the object's place if there is an
/// object (its turn without noise) and rib pins if there is a camera. The log
/// does not contain the true contacts. Rows that were not solved are left out.
FrameTable MakeLog(const Finger& finger, const FrameTable& simulated,
                   const LogNoise& noise);

}  // namespace finray

#endif  // FINRAY_SCENE_SIMULATION_H_
