#ifndef FINRAY_TESTS_PERCEPTION_SIMULATED_TOUCHES_H_
#define FINRAY_TESTS_PERCEPTION_SIMULATED_TOUCHES_H_

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <string>

#include "finray/objects/object_contact.h"
#include "finray/perception/polygon.h"
#include "perception/noisy_log.h"

namespace finray {

/// How an object is brought to the finger, as in V-C of the paper. It is turned
/// in equal steps and pressed in along +x. The leading point, which is farthest
/// towards the finger, has a given height.
struct TouchProtocol {
  int orientations = 36;
  double height_mm = 65;
  double force_N = 3;   ///< The stage stops when the finger is pressed so.
  double friction = 0;  ///< of the contact; + towards the tip
  /// Leaves the row of an orientation empty that cannot be pressed so.
  bool may_fail = false;
};

/// Presses the object in until the protocol's force is reached, and leaves the
/// solver at that equilibrium. Throws std::runtime_error if there is none.
inline ObjectPose PressObject(const RigidObject& object, double angle_rad,
                              const TouchProtocol& protocol,
                              EquilibriumSolver* solver) {
  constexpr double kTolerance = 1e-4;  // relative
  constexpr double kDeepest_mm = 40;
  // The leading point has the normal +x in frame S.
  const Eigen::Vector2d leading =
      Eigen::Rotation2Dd(angle_rad) *
      object.outline.PointAt(-angle_rad).position_mm;
  ObjectPose pose{{0, protocol.height_mm - leading.y()}, angle_rad};
  double low = 0, high = kDeepest_mm;
  double depth = 2;
  ObjectContact found;
  for (int i = 0; i < 60; ++i) {
    pose.position_mm.x() = depth - leading.x();
    found = SolveObjectContact(object, pose, protocol.friction, solver,
                               found.contacts);
    const bool solved = found.status == ObjectContactStatus::kContact;
    double force = 0;
    for (const PointContact& c : found.contacts) force += c.normal_N;
    if (solved &&
        std::abs(force - protocol.force_N) < kTolerance * protocol.force_N) {
      return pose;
    }
    const bool deep = solved ? force > protocol.force_N
                             : found.status != ObjectContactStatus::kNoContact;
    (deep ? high : low) = depth;
    // The force is nearly proportional to the depth.
    double next = solved && force > 0 ? depth * protocol.force_N / force : 0;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    depth = next;
  }
  throw std::runtime_error("an object cannot be pressed with " +
                           std::to_string(protocol.force_N) + " N at " +
                           std::to_string(angle_rad * 180 / M_PI) + " deg");
}

/// The log of these touches, one row an orientation: gauge_<j>_V, object_x_mm,
/// object_y_mm, object_angle_deg, force_N. `plant` is the true finger.
inline FrameTable SimulateTouches(const Finger& plant, const Outline& outline,
                                  const Discretization& discretization,
                                  const TouchProtocol& protocol,
                                  const LogNoise& noise) {
  const RigidObject object{outline, {}};
  NoisyLog log(protocol.orientations, noise, noise.seed);
  EquilibriumSolver solver(plant, discretization);
  for (int row = 0; row < protocol.orientations; ++row) {
    const double angle = 2 * M_PI * row / protocol.orientations;
    solver.Reset();
    try {
      const ObjectPose pose = PressObject(object, angle, protocol, &solver);
      log.Write(row, solver, pose.position_mm, protocol.force_N);
    } catch (const std::runtime_error&) {
      if (!protocol.may_fail) throw;
    }
    log.table().MutableNumbers("object_angle_deg")[row] = angle * 180 / M_PI;
  }
  return log.table();
}

/// An outline as points at equal arc lengths.
inline Polygon SampledOutline(const Outline& outline, int count = 1440) {
  constexpr int kNormals = 7200;
  Polygon points;
  for (int i = 0; i < kNormals; ++i) {
    points.push_back(outline.PointAt(2 * M_PI * i / kNormals).position_mm);
  }
  return EvenlySpaced(points, count);
}

}  // namespace finray

#endif  // FINRAY_TESTS_PERCEPTION_SIMULATED_TOUCHES_H_
