// The approaches of a bent beam to objects against a dense sampling of it.

#include "finray/objects/approaches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test_finger.h"

namespace finray {
namespace {

constexpr double kLength_mm = 140;

struct Lowest {
  double arc_mm, distance_mm;
};

// All local minima of 14001 samples, those at the ends too.
std::vector<Lowest> DenseMinima(const Shape& shape, const Outline& outline,
                                const ObjectPose& pose) {
  constexpr int kCount = 14000;
  std::vector<double> distance;
  for (int i = 0; i <= kCount; ++i) {
    const Section at = shape.SurfaceAt(Side::kFront, kLength_mm * i / kCount);
    distance.push_back(
        outline.DistanceOf({at.x_mm, at.y_mm}, pose).distance_mm);
  }
  std::vector<Lowest> minima;
  for (int i = 0; i <= kCount; ++i) {
    if ((i == 0 || distance[i] < distance[i - 1]) &&
        (i == kCount || distance[i] <= distance[i + 1])) {
      minima.push_back({kLength_mm * i / kCount, distance[i]});
    }
  }
  return minima;
}

// Returns the number of approaches, the most below one of the bounds.
size_t ExpectDenseMinima(const Shape& shape,
                         const std::vector<PointContact>& contacts,
                         const Outline& outline, const ObjectPose& pose) {
  const std::vector<Lowest> dense = DenseMinima(shape, outline, pose);
  const double least = std::min_element(dense.begin(), dense.end(),
                                        [](const Lowest& a, const Lowest& b) {
                                          return a.distance_mm < b.distance_mm;
                                        })
                           ->distance_mm;
  // Deep inside an object the nearest point of its outline jumps.
  if (least < -2) return 0;
  size_t most = 0;
  for (const double below : {-0.5, 0., 6.}) {
    const std::vector<Approach> found =
        FindApproaches(shape, kLength_mm, contacts, outline, pose, below);
    EXPECT_FALSE(found.empty());
    for (const Approach& a : found) {
      // None is invented, and each is at the bottom.
      const auto near =
          std::find_if(dense.begin(), dense.end(), [&](const Lowest& d) {
            return std::abs(d.distance_mm - a.distance_mm) < 1e-5;
          });
      EXPECT_TRUE(near != dense.end()) << a.arc_mm;
      EXPECT_TRUE(a.distance_mm <= below || a.distance_mm < least + 1e-5);
    }
    // None is missed.
    for (const Lowest& d : dense) {
      if (d.distance_mm > below - 1e-5 && d.distance_mm > least + 1e-5) {
        continue;
      }
      EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                              [&](const Approach& a) {
                                return std::abs(a.distance_mm - d.distance_mm) <
                                       1e-5;
                              }))
          << d.arc_mm << " " << d.distance_mm;
    }
    most = std::max(most, found.size());
  }
  return most;
}

TEST(ApproachesTest, AreThoseOfADenseSampling) {
  Finger finger = PaperFinger();
  finger.front_surface_mm = 1.5;
  EquilibriumSolver solver(finger, {});
  const Outline outlines[] = {
      Outline(CircleOutline{15}), Outline(EllipseOutline{40, 12}),
      Outline(
          RoundedPolygonOutline{{{-20, -60}, {0, -60}, {0, 60}, {-20, 60}}, 3}),
      Outline(SupportOutline{60, {{0, 0}, {3, 2}, {0, 1}}})};
  for (const double force : {0., 4., 25.}) {
    const std::vector<PointContact> contacts = {{45, force, 0},
                                                {95, 0.6 * force, 0}};
    ASSERT_TRUE(solver.Solve(contacts));
    const Shape shape(solver, contacts);
    for (const Outline& outline : outlines) {
      for (int i = 0; i < 80; ++i) {
        ObjectPose pose;
        pose.position_mm = {-60. + 4 * (i % 11), 2. * i - 10};
        pose.angle_rad = 0.15 * (i % 5);
        ExpectDenseMinima(shape, contacts, outline, pose);
      }
    }
  }
}

// A beam that is pressed in its middle is hollow, and a plate on it is near at
// both ends.
TEST(ApproachesTest, AHollowBeamHasTwoToAPlate) {
  const Finger finger = PaperFinger();
  EquilibriumSolver solver(finger, {});
  const std::vector<PointContact> contacts = {{65, 15, 0}};
  ASSERT_TRUE(solver.Solve(contacts));
  const Shape shape(solver, contacts);
  const Outline plate(
      RoundedPolygonOutline{{{-20, -40}, {0, -40}, {0, 40}, {-20, 40}}, 3});
  const Section from = shape.SurfaceAt(Side::kFront, 20);
  const Section to = shape.SurfaceAt(Side::kFront, 120);
  const double along = std::atan2(to.y_mm - from.y_mm, to.x_mm - from.x_mm);
  for (const double turn : {-0.02, 0., 0.02}) {
    ObjectPose pose;
    pose.angle_rad = along - M_PI / 2 + turn;
    pose.position_mm = {
        (from.x_mm + to.x_mm) / 2 - 3 * std::cos(pose.angle_rad),
        (from.y_mm + to.y_mm) / 2 - 3 * std::sin(pose.angle_rad)};
    EXPECT_EQ(ExpectDenseMinima(shape, contacts, plate, pose), 2u) << turn;
  }
}

}  // namespace
}  // namespace finray
