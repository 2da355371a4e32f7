#include "finray/objects/outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace finray {
namespace {

using Eigen::Vector2d;

std::vector<Outline> Outlines() {
  return {
      Outline(CircleOutline{7}),
      Outline(EllipseOutline{12, 5}),
      Outline(EllipseOutline{3, 20}),
      Outline(RoundedPolygonOutline{{{-8, -5}, {9, -4}, {6, 7}, {-7, 6}}, 2.5}),
      Outline(RoundedPolygonOutline{{{-10, 3}, {10, 3}}, 4}),
      Outline(SupportOutline{9, {{2, -1}, {0.2, 0.1}, {0.05, -0.03}}})};
}

Vector2d Direction(double angle) { return {std::cos(angle), std::sin(angle)}; }
Vector2d Tangent(double angle) { return {-std::sin(angle), std::cos(angle)}; }

// dp/da = rho t, by central differences.
TEST(OutlineTest, CurvatureIsTheSlopeOfThePointByTheNormalAngle) {
  constexpr double kStep = 1e-6;
  for (const Outline& outline : Outlines()) {
    for (double angle = 0.05; angle < 2 * M_PI; angle += 0.37) {
      const Outline::Point at = outline.PointAt(angle);
      const Vector2d slope = (outline.PointAt(angle + kStep).position_mm -
                              outline.PointAt(angle - kStep).position_mm) /
                             (2 * kStep);
      EXPECT_LT((slope - at.curvature_radius_mm * Tangent(angle)).norm(), 1e-7);
    }
  }
}

TEST(OutlineTest, EllipsePointsObeyTheImplicitEquation) {
  const Outline outline(EllipseOutline{12, 5});
  for (double angle = -3; angle < 3; angle += 0.21) {
    const Vector2d p = outline.PointAt(angle).position_mm;
    const Vector2d gradient(p.x() / 144, p.y() / 25);
    EXPECT_NEAR(p.dot(gradient), 1, 1e-14);
    EXPECT_LT((gradient.normalized() - Direction(angle)).norm(), 1e-14);
  }
}

// The tangent with normal n lies at h = n . p from the origin.
TEST(OutlineTest, SupportSeriesIsTheDistanceOfTheTangents) {
  const Outline outline(SupportOutline{9, {{2, -1}, {0.5, 0.4}}});
  for (double angle = -3; angle < 3; angle += 0.21) {
    EXPECT_NEAR(outline.PointAt(angle).position_mm.dot(Direction(angle)),
                9 + 2 * std::cos(angle) - std::sin(angle) +
                    0.5 * std::cos(2 * angle) + 0.4 * std::sin(2 * angle),
                1e-13);
  }
}

// Seen from p + d n the nearest boundary point is p.
TEST(OutlineTest, DistanceReturnsTheHeightAboveABoundaryPoint) {
  for (const Outline& outline : Outlines()) {
    for (double angle = 0.05; angle < 2 * M_PI; angle += 0.37) {
      const Outline::Point at = outline.PointAt(angle);
      for (const double height : {-0.9, -0.01, 0.0, 1e-9, 0.5, 100.0}) {
        const double d = height < 0 ? height * at.curvature_radius_mm : height;
        const Outline::Distance found =
            outline.DistanceOf(at.position_mm + d * Direction(angle));
        // Far inside an ellipse another side may be nearer.
        if (height < -0.5) {
          EXPECT_GE(found.distance_mm, d - 1e-9);
          if (found.distance_mm > d + 1e-9) continue;
        }
        EXPECT_NEAR(found.distance_mm, d, 1e-12 * (10 + std::abs(d)));
        EXPECT_LT((found.normal - Direction(angle)).norm(), 1e-9);
        EXPECT_NEAR(found.curvature_radius_mm, at.curvature_radius_mm,
                    1e-7 * at.curvature_radius_mm);
      }
    }
  }
}

// grad d = n and grad n = t t' / (rho + d), everywhere around and at a pose.
TEST(OutlineTest, DistanceHasTheStatedDerivatives) {
  constexpr double kStep = 1e-6;
  const ObjectPose pose{{3, -2}, 0.7};
  for (const Outline& outline : Outlines()) {
    for (double x = -20.3; x < 25; x += 4.1) {
      for (double y = -21.7; y < 25; y += 4.3) {
        const Outline::Distance at = outline.DistanceOf({x, y}, pose);
        if (at.distance_mm < -1) continue;
        const auto by_x = outline.DistanceOf({x + kStep, y}, pose);
        const auto before_x = outline.DistanceOf({x - kStep, y}, pose);
        const auto by_y = outline.DistanceOf({x, y + kStep}, pose);
        const auto before_y = outline.DistanceOf({x, y - kStep}, pose);
        EXPECT_NEAR((by_x.distance_mm - before_x.distance_mm) / (2 * kStep),
                    at.normal.x(), 1e-7);
        EXPECT_NEAR((by_y.distance_mm - before_y.distance_mm) / (2 * kStep),
                    at.normal.y(), 1e-7);
        const Vector2d t(-at.normal.y(), at.normal.x());
        const double bend = 1 / (at.curvature_radius_mm + at.distance_mm);
        EXPECT_LT(
            ((by_x.normal - before_x.normal) / (2 * kStep) - bend * t.x() * t)
                .norm(),
            1e-7);
        EXPECT_LT(
            ((by_y.normal - before_y.normal) / (2 * kStep) - bend * t.y() * t)
                .norm(),
            1e-7);
      }
    }
  }
}

TEST(OutlineTest, EllipseOfEqualAxesIsACircle) {
  const Outline circle(CircleOutline{6}), ellipse(EllipseOutline{6, 6});
  for (double x = -9; x < 10; x += 1.7) {
    const auto a = circle.DistanceOf(Vector2d(x, 2.2));
    const auto b = ellipse.DistanceOf(Vector2d(x, 2.2));
    EXPECT_NEAR(a.distance_mm, b.distance_mm, 1e-13);
    EXPECT_LT((a.normal - b.normal).norm(), 1e-13);
  }
}

TEST(OutlineTest, MiddleOfAnEllipseIsNearestToItsFlanks) {
  const Outline ellipse(EllipseOutline{12, 5});
  EXPECT_NEAR(ellipse.DistanceOf(Vector2d(0, 0)).distance_mm, -5, 1e-12);
  // On the long axis between the centres of curvature of its ends.
  const Outline::Distance at = ellipse.DistanceOf(Vector2d(4, 0));
  EXPECT_GT(at.distance_mm, -5);
  EXPECT_LT(at.distance_mm, -4.5);
  EXPECT_NEAR(ellipse.DistanceOf(Vector2d(0, 9)).distance_mm, 4, 1e-12);
  EXPECT_NEAR(ellipse.DistanceOf(Vector2d(-15, 0)).distance_mm, 3, 1e-12);
}

TEST(OutlineTest, CornersAreArcsAndEdgesAreStraight) {
  const Outline square(
      RoundedPolygonOutline{{{-8, -8}, {8, -8}, {8, 8}, {-8, 8}}, 2});
  EXPECT_EQ(square.DistanceOf(Vector2d(13, 3)).distance_mm, 3);
  EXPECT_TRUE(
      std::isinf(square.DistanceOf(Vector2d(13, 3)).curvature_radius_mm));
  EXPECT_EQ(square.DistanceOf(Vector2d(9.5, 3)).distance_mm, -0.5);
  EXPECT_EQ(square.DistanceOf(Vector2d(7, 3)).distance_mm, -3);
  EXPECT_EQ(square.DistanceOf(Vector2d(11, 12)).distance_mm, 3);
  EXPECT_EQ(square.DistanceOf(Vector2d(11, 12)).curvature_radius_mm, 2);
  EXPECT_EQ(square.PointAt(0.3).position_mm,
            2 * Direction(0.3) + Vector2d(8, 8));
  const Outline clockwise(
      RoundedPolygonOutline{{{-8, 8}, {8, 8}, {8, -8}, {-8, -8}}, 2});
  EXPECT_EQ(clockwise.DistanceOf(Vector2d(13, 3)).distance_mm, 3);
  const Outline stadium(RoundedPolygonOutline{{{-8, 0}, {8, 0}}, 2});
  EXPECT_EQ(stadium.DistanceOf(Vector2d(13, 0)).distance_mm, 3);
  EXPECT_EQ(stadium.DistanceOf(Vector2d(1, -1)).distance_mm, -1);
  EXPECT_EQ(stadium.DistanceOf(Vector2d(1, 0)).distance_mm, -2);
}

TEST(OutlineTest, RefusesWhatIsNoConvexOutline) {
  const auto refuses = [](const Outline::Shape& shape) {
    EXPECT_THROW(Outline{shape}, std::invalid_argument);
  };
  refuses(CircleOutline{0});
  refuses(CircleOutline{std::nan("")});
  refuses(EllipseOutline{1, -1});
  refuses(RoundedPolygonOutline{{}, 1});
  refuses(RoundedPolygonOutline{{{0, 0}, {1, 0}, {0, 1}}, 0});
  refuses(RoundedPolygonOutline{{{0, 0}, {0, 0}}, 1});
  refuses(RoundedPolygonOutline{{{0, 0}, {1, 0}, {2, 0}}, 1});
  // A dent, and a star that turns twice.
  refuses(RoundedPolygonOutline{{{0, 0}, {4, 0}, {1, 1}, {0, 4}}, 1});
  RoundedPolygonOutline star{{}, 1};
  for (int i = 0; i < 5; ++i) {
    star.vertices_mm.push_back(10 * Direction(0.8 * M_PI * i));
  }
  refuses(star);
  // h + h'' = 9 - 8 a cos(3 angle) is 0 for a = 9 / 8.
  refuses(SupportOutline{0});
  refuses(SupportOutline{9, {{0, 0}, {0, 0}, {1.126, 0}}});
  EXPECT_NO_THROW(Outline(SupportOutline{9, {{0, 0}, {0, 0}, {1.124, 0}}}));
}

}  // namespace
}  // namespace finray
