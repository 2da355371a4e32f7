#include "finray/perception/outline_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "perception/touch_fixture.h"

namespace finray {
namespace {

using Eigen::Vector2d;

// The largest distance of the fit from an outline.
double LargestError(const OutlineFit& fit, const Outline& outline) {
  double worst = 0;
  for (int i = 0; i < 360; ++i) {
    const double arc = fit.curve.perimeter_mm() * i / 360;
    worst = std::max(
        worst,
        std::abs(outline.DistanceOf(fit.curve.At(fit.curve.NormalAngleAt(arc)))
                     .distance_mm));
  }
  return worst;
}

TEST(OutlineFitTest, EllipseFromExactTouches) {
  const Outline ellipse(EllipseOutline{22, 15});
  const OutlineFit fit = FitOutline(ExactTouches(ellipse, 36));
  EXPECT_TRUE(fit.edges.empty());
  EXPECT_LT(LargestError(fit, ellipse), 2e-3);
}

// A smooth log rho would have to swing by a factor of a hundred between the
// edges and the corners.
TEST(OutlineFitTest, SquareHasStraightEdges) {
  const Outline square(
      RoundedPolygonOutline{{{-14, -14}, {14, -14}, {14, 14}, {-14, 14}}, 4});
  const OutlineFit fit = FitOutline(ExactTouches(square, 36));
  ASSERT_EQ(fit.edges.size(), 4u);
  for (const StraightEdge& edge : fit.edges) {
    EXPECT_NEAR(edge.length_mm, 28, 0.7);
    EXPECT_NEAR(std::remainder(edge.middle_rad, M_PI / 2), 0, 5e-3);
  }
  EXPECT_LT(LargestError(fit, square), 0.15);
}

TEST(OutlineFitTest, OneTouchAstrayDoesNotBendTheRest) {
  const Outline circle(CircleOutline{18});
  std::vector<Touch> touches = ExactTouches(circle, 36);
  touches[7].point_mm -= 1.5 * touches[7].Normal();
  const OutlineFit fit = FitOutline(touches);
  EXPECT_GT(fit.distances[7], 10);
  EXPECT_LT(LargestError(fit, circle), 0.1);
}

// The rms of error / std over draws and places is 1.
TEST(OutlineFitTest, StdIsThatOfTheErrors) {
  const Outline ellipse(EllipseOutline{22, 15});
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  double squares = 0;
  int count = 0;
  for (int draw = 0; draw < 6; ++draw) {
    std::vector<Touch> touches = ExactTouches(ellipse, 36, 0.02 * draw);
    for (Touch& touch : touches) {
      touch.covariance.topLeftCorner<2, 2>() *= 4;  // 0.04 mm
      touch.point_mm += 0.04 * Vector2d(normal(generator), normal(generator));
      touch.normal_angle_rad += 5e-4 * normal(generator);
    }
    const OutlineFit fit = FitOutline(touches, 1e-3);
    for (double a = 0; a < 6.2; a += 0.4) {
      const double error =
          ellipse.DistanceOf(fit.curve.At(a)).distance_mm / fit.NormalStd(a);
      squares += error * error;
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 1, 0.35);
}

}  // namespace
}  // namespace finray
