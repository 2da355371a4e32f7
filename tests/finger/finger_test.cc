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
