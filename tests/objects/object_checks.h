#ifndef FINRAY_TESTS_OBJECTS_OBJECT_CHECKS_H_
#define FINRAY_TESTS_OBJECTS_OBJECT_CHECKS_H_

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "finray/objects/object_contact.h"
#include "finray/statics/shape.h"
#include "statics/equilibrium_values.h"
#include "statics/strain_energy.h"

namespace finray {

constexpr ObjectContactStatus kContact = ObjectContactStatus::kContact;

inline RigidObject Circle(double radius) {
  return {Outline(CircleOutline{radius}), {}};
}

/// The force of an object on the finger.
inline Eigen::Vector2d TotalForce(const ObjectContact& found,
                                  const EquilibriumSolver& solver) {
  Eigen::Vector2d force(0, 0);
  for (std::size_t c = 0; c < found.contacts.size(); ++c) {
    const double theta = solver.contact_pose(static_cast<int>(c)).z();
    const Eigen::Vector2d t(std::cos(theta), std::sin(theta));
    force += found.contacts[c].normal_N *
             (Eigen::Vector2d(t.y(), -t.x()) + found.contacts[c].friction * t);
  }
  return force;
}

/// Least distance of the front beam, sampled densely, from an object at rest.
inline double Clearance(const RigidObject& object, const ObjectPose& pose,
                        const ObjectContact& found,
                        const EquilibriumSolver& solver) {
  const Shape shape(solver, found.contacts);
  const double length = solver.model().finger().front_length_mm;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 2800; ++i) {
    const Section at = shape.At(Side::kFront, length * i / 2800);
    least = std::min(
        least, object.outline.DistanceOf({at.x_mm, at.y_mm}, pose).distance_mm);
  }
  return least;
}

/// Every contact lies on the outline and pushes; no point of the beam is inside
/// the object; the clamps carry the contact force. A single contact is tangent
/// on the outer side.
inline void ExpectContact(const RigidObject& object, const ObjectPose& pose,
                          const ObjectContact& found,
                          const EquilibriumSolver& solver) {
  ASSERT_FALSE(found.contacts.empty());
  for (std::size_t c = 0; c < found.contacts.size(); ++c) {
    EXPECT_GT(found.contacts[c].normal_N, 0);
    const Eigen::Vector3d at = solver.contact_pose(static_cast<int>(c));
    const Outline::Distance distance =
        object.outline.DistanceOf(at.head<2>(), pose);
    EXPECT_NEAR(distance.distance_mm, 0, 1e-9);
    const Eigen::Vector2d normal(std::sin(at.z()), -std::cos(at.z()));
    EXPECT_LT((distance.normal - normal).norm(),
              found.contacts.size() == 1 ? 1e-9 : 1e-2);
  }
  EXPECT_GT(Clearance(object, pose, found, solver), -1e-6);
  const Eigen::Vector3d reaction =
      BaseReaction(solver, Side::kFront) + BaseReaction(solver, Side::kBack);
  const Eigen::Vector2d force = TotalForce(found, solver);
  EXPECT_LT((reaction.tail<2>() + force).norm(), 1e-7 * (1 + force.norm()));
}

}  // namespace finray

#endif  // FINRAY_TESTS_OBJECTS_OBJECT_CHECKS_H_
