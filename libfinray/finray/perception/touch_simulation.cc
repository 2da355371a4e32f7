#include "finray/perception/touch_simulation.h"

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <stdexcept>

#include "finray/objects/object_contact.h"
#include "finray/scene/frame_columns.h"

namespace finray {
namespace {

constexpr double kForceTolerance = 1e-4;  // of the force asked for
constexpr double kDeepestPress_mm = 40;

double Force(const ObjectContact& found) {
  double sum = 0;
  for (const PointContact& contact : found.contacts) sum += contact.normal_N;
  return sum;
}

// Presses in until the force is reached; the solver is left there.
ObjectPose Press(const RigidObject& object, double angle_rad,
                 const TouchProtocol& protocol, EquilibriumSolver* solver) {
  // The leading point has the normal +x in frame S.
  const Eigen::Vector2d leading =
      Eigen::Rotation2Dd(angle_rad) *
      object.outline.PointAt(-angle_rad).position_mm;
  ObjectPose pose{{0, protocol.height_mm - leading.y()}, angle_rad};
  double low = 0, high = kDeepestPress_mm;
  double depth = 2;
  ObjectContact found;
  for (int i = 0; i < 60; ++i) {
    pose.position_mm.x() = depth - leading.x();
    found = SolveObjectContact(object, pose, 0, solver, found.contacts);
    const bool solved = found.status == ObjectContactStatus::kContact;
    const double force = Force(found);
    if (solved && std::abs(force - protocol.force_N) <
                      kForceTolerance * protocol.force_N) {
      return pose;
    }
    const bool deep = solved ? force > protocol.force_N
                             : found.status != ObjectContactStatus::kNoContact;
    (deep ? high : low) = depth;
    // The force is nearly in proportion to the depth.
    double next = solved && force > 0 ? depth * protocol.force_N / force : 0;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    depth = next;
  }
  throw std::runtime_error("an object cannot be pressed with " +
                           std::to_string(protocol.force_N) + " N at " +
                           std::to_string(angle_rad * 180 / M_PI) + " deg");
}

}  // namespace

FrameTable SimulateTouches(const Finger& plant, const Outline& outline,
                           const Discretization& discretization,
                           const TouchProtocol& protocol,
                           const TouchNoise& noise) {
  const RigidObject object{outline, {}};
  FrameTable table(static_cast<std::size_t>(protocol.orientations));
  std::mt19937_64 generator(noise.seed);
  std::normal_distribution<double> normal;
  const auto error = [&](double std) {
    return std > 0 ? std * normal(generator) : 0.0;
  };
  EquilibriumSolver solver(plant, discretization);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double angle =
        2 * M_PI * static_cast<double>(row) / protocol.orientations;
    solver.Reset();
    const ObjectPose pose = Press(object, angle, protocol, &solver);
    for (int j = 0; j < solver.model().gauges(); ++j) {
      const Gauge& gauge = plant.gauges[static_cast<std::size_t>(j)];
      table.MutableNumbers(GaugeVolts(j))[row] =
          gauge.Volts(solver.gauge_angle(j)) +
          error(noise.gauges ? gauge.noise_V : 0);
    }
    table.MutableNumbers("object_x_mm")[row] =
        pose.position_mm.x() + error(noise.stage_std_mm);
    table.MutableNumbers("object_y_mm")[row] =
        pose.position_mm.y() + error(noise.stage_std_mm);
    table.MutableNumbers("object_angle_deg")[row] = angle * 180 / M_PI;
    table.MutableNumbers("force_N")[row] = protocol.force_N;
  }
  return table;
}

Polygon SampledOutline(const Outline& outline, int count) {
  constexpr int kNormals = 7200;
  Polygon points;
  for (int i = 0; i < kNormals; ++i) {
    points.push_back(outline.PointAt(2 * M_PI * i / kNormals).position_mm);
  }
  return EvenlySpaced(points, count);
}

}  // namespace finray
