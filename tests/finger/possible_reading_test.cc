#include "finray/finger/possible_reading.h"

#include <gtest/gtest.h>

#include <limits>

namespace finray {
namespace {

TEST(PossibleReadingTest, NothingBeyondAFullTurn) {
  const double infinity = std::numeric_limits<double>::infinity();
  Gauge gauge;
  gauge.gain_V_per_rad = -2;
  gauge.offset_V = 1;
  EXPECT_TRUE(IsPossible(gauge, std::nan("")));  // no reading
  for (const double angle : {6.28, -6.28}) {
    EXPECT_TRUE(IsPossible(gauge, gauge.Volts(angle)));
    EXPECT_FALSE(IsPossible(gauge, gauge.Volts(1.002 * angle)));
  }
  EXPECT_TRUE(IsPossible(gauge, gauge.Volts(100), infinity));  // it wanders
  for (const double volts : {infinity, -infinity, 9.9e37, -1.1e6}) {
    EXPECT_FALSE(IsPossible(gauge, volts)) << volts;
    EXPECT_FALSE(IsPossible(gauge, volts, infinity)) << volts;
  }
  // The law may bend the signal up, and creep adds to it.
  Gauge bent = gauge;
  bent.curvature_per_rad = 0.2;
  bent.creep_share = 0.1;
  EXPECT_TRUE(IsPossible(bent, 1.1 * bent.BendingVolts(6.28) + 1));
  EXPECT_FALSE(IsPossible(bent, 1.1 * bent.BendingVolts(6.29) + 1));
  // A saturated reading is only left out, but no number is as large as this.
  gauge.min_V = -10;
  EXPECT_TRUE(IsPossible(gauge, -10));
  EXPECT_TRUE(IsPossible(gauge, -30));
  EXPECT_FALSE(IsPossible(gauge, -9.9e37));
}

TEST(PossibleReadingTest, OneSpoilsItsRow) {
  const std::vector<Gauge> gauges(2);
  EXPECT_TRUE(ArePossible(gauges, {0, std::nan("")}));
  EXPECT_FALSE(ArePossible(gauges, {0, 7}));
}

}  // namespace
}  // namespace finray
