#include "finray/finger/finger.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

TEST(GaugeTest, VoltsAndAngleInvertEachOther) {
  Gauge gauge;
  gauge.gain_V_per_rad = -2.5;
  gauge.offset_V = 0.75;
  EXPECT_DOUBLE_EQ(gauge.Volts(0.1), 0.5);
  EXPECT_DOUBLE_EQ(gauge.Angle(0.5), 0.1);
  EXPECT_EQ(gauge.Volts(0), gauge.offset_V);
  EXPECT_TRUE(std::isnan(gauge.Angle(std::nan(""))));
}

TEST(GaugeTest, AngleWeightIsPositiveForANegativeGain) {
  Gauge gauge;
  gauge.gain_V_per_rad = -2.5;
  gauge.noise_V = 0.005;
  EXPECT_DOUBLE_EQ(gauge.AngleWeight(), 500);
}

TEST(GaugeTest, ACurveInvertsOnTheBranchThroughZero) {
  for (const double gain : {2.0, -2.5}) {
    for (const double curvature : {0.8, -0.8}) {
      Gauge gauge;
      gauge.gain_V_per_rad = gain;
      gauge.offset_V = 0.1;
      gauge.curvature_per_rad = curvature;
      for (const double angle : {-0.6, -0.01, 0.0, 1e-9, 0.3, 0.6}) {
        const double volts = gauge.Volts(angle);
        EXPECT_NEAR(volts, 0.1 + gain * (angle + curvature * angle * angle),
                    1e-15);
        EXPECT_NEAR(gauge.Angle(volts), angle, 1e-14);
        EXPECT_TRUE(gauge.IsMeasured(volts));
        const double step = 1e-6;
        EXPECT_NEAR(gauge.Slope(angle),
                    (gauge.Volts(angle + step) - gauge.Volts(angle - step)) /
                        (2 * step),
                    1e-8);
        EXPECT_NEAR(gauge.AngleWeight(angle),
                    std::abs(gauge.Slope(angle)) / gauge.noise_V, 1e-9);
      }
      // No angle reads volts beyond the vertex.
      const double beyond =
          gauge.Volts(-0.5 / curvature) - 1e-3 * gain * curvature;
      EXPECT_TRUE(std::isnan(gauge.Angle(beyond)));
      EXPECT_FALSE(gauge.IsMeasured(beyond));
    }
  }
}

TEST(GaugeTest, AGaugeThatIsLessSensitiveWhenFlat) {
  for (const double share : {0.2, 0.9, -0.5}) {
    for (const double curvature : {0.0, 0.4, -0.4}) {
      Gauge gauge;
      gauge.gain_V_per_rad = -2;
      gauge.offset_V = 0.1;
      gauge.curvature_per_rad = curvature;
      gauge.flat_share = share;
      gauge.flat_width_rad = 0.03;
      EXPECT_NEAR(gauge.Slope(0), -2 * (1 - share), 1e-14);
      for (const double angle : {-0.4, -0.03, -1e-4, 0.0, 0.01, 0.08, 0.4}) {
        const double volts = gauge.Volts(angle);
        EXPECT_NEAR(gauge.Angle(volts), angle, 1e-12);
        EXPECT_TRUE(gauge.IsMeasured(volts));
        const double step = 1e-6;
        EXPECT_NEAR(gauge.Slope(angle),
                    (gauge.Volts(angle + step) - gauge.Volts(angle - step)) /
                        (2 * step),
                    1e-8);
        const auto with = [&](double other_share, double width) {
          Gauge other = gauge;
          other.flat_share = other_share;
          other.flat_width_rad = width;
          return other.Signal(angle);
        };
        EXPECT_NEAR(
            gauge.SignalByFlatShare(angle),
            (with(share + step, 0.03) - with(share - step, 0.03)) / (2 * step),
            1e-8);
        EXPECT_NEAR(
            gauge.SignalByFlatWidth(angle),
            (with(share, 0.03 + step) - with(share, 0.03 - step)) / (2 * step),
            1e-7);
      }
    }
  }
  Gauge gauge;
  gauge.flat_share = 0.2;
  EXPECT_TRUE(gauge.IsMeasured(1e3));
  gauge.curvature_per_rad = -0.5;
  EXPECT_FALSE(gauge.IsMeasured(0.6));  // beyond the vertex at 0.5
}

TEST(GaugeTest, MissingAndSaturatedReadingsAreNotMeasured) {
  Gauge gauge;
  EXPECT_TRUE(gauge.IsMeasured(1e300));
  EXPECT_FALSE(gauge.IsMeasured(std::nan("")));
  gauge.min_V = -2.5;
  gauge.max_V = 5;
  EXPECT_TRUE(gauge.IsMeasured(4.999));
  EXPECT_FALSE(gauge.IsMeasured(5));
  EXPECT_FALSE(gauge.IsMeasured(-2.5));
}

}  // namespace
}  // namespace finray
