#include "finray/perception/polygon.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

const Polygon kSquare = {{2, 1}, {4, 1}, {4, 3}, {2, 3}};

Polygon Ellipse(double a, double b, int count) {
  Polygon polygon;
  for (int i = 0; i < count; ++i) {
    const double t = 2 * M_PI * i / count;
    polygon.emplace_back(a * std::cos(t), b * std::sin(t));
  }
  return polygon;
}

TEST(PolygonTest, CentroidAndRadius) {
  EXPECT_EQ(CentroidOf(kSquare), Eigen::Vector2d(3, 2));
  EXPECT_NEAR(*RadiusAt(kSquare, {3, 2}, 0), 1, 1e-15);
  EXPECT_NEAR(*RadiusAt(kSquare, {3, 2}, M_PI / 6), 1 / std::cos(M_PI / 6),
              1e-15);
  EXPECT_FALSE(RadiusAt(kSquare, {9, 2}, 0));
}

TEST(PolygonTest, EqualArcLengths) {
  const Polygon even = EvenlySpaced(kSquare, 16);
  for (std::size_t i = 0; i + 1 < even.size(); ++i) {
    EXPECT_NEAR((even[i + 1] - even[i]).norm(), 0.5, 1e-12);
  }
}

// The descriptors of a circle are zero except for c_0 and c_1.
TEST(FourierDescriptorsTest, CircleHasTwo) {
  Polygon circle = Ellipse(5, 5, 4096);
  for (auto& point : circle) point += Eigen::Vector2d(1, -2);
  const FourierDescriptors descriptors(circle, 19);
  for (int k = -9; k <= 9; ++k) {
    const std::complex<double> expected = k == 0   ? std::complex<double>(1, -2)
                                          : k == 1 ? 5.0
                                                   : 0.0;
    EXPECT_LT(std::abs(descriptors.coefficients()[k + 9] - expected), 2e-5)
        << k;
  }
  EXPECT_LT((descriptors.At(0.25) - Eigen::Vector2d(1, 3)).norm(), 4e-5);
}

TEST(FourierDescriptorsTest, MoreDescriptorsComeNearer) {
  const Polygon ellipse = Ellipse(22, 11, 4000);
  double before = 1e9;
  for (const int count : {5, 9, 19, 39}) {
    const double worst =
        CompareRadii(FourierDescriptors(ellipse, count).Sampled(2000), ellipse)
            .Largest();
    EXPECT_LT(worst, 0.5 * before);
    before = worst;
  }
}

TEST(RadialErrorTest, OfAScaledOutlineIsTheScale) {
  const Polygon truth = Ellipse(20, 10, 2000);
  Polygon larger = truth;
  for (auto& point : larger) point *= 1.02;
  const RadialError error = CompareRadii(larger, truth);
  EXPECT_EQ(error.percent.size(), 360u);
  EXPECT_NEAR(error.true_radius_mm[90], 10, 1e-4);
  EXPECT_NEAR(error.Mean(), 2, 1e-10);
  EXPECT_NEAR(error.Rms(), 2, 1e-10);
  EXPECT_NEAR(error.Largest(), 2, 1e-10);
}

}  // namespace
}  // namespace finray
