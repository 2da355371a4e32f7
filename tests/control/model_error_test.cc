#include <gtest/gtest.h>

#include <cmath>

#include "finray/control/plant.h"
#include "test_finger.h"

namespace finray {
namespace {

// Each parameter has the given spread; nothing else changes.
TEST(ModelErrorTest, SpreadsAsItSays) {
  const Finger finger = PaperFinger();
  std::mt19937_64 generator(1);
  double stiffness = 0, gain = 0, offset = 0, rib = 0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    const Finger other = Perturbed(finger, {1, 0.3, 5e-4, 0.03}, &generator);
    stiffness += std::pow(other.front_stiffness_N_mm2 / 12500 - 1, 2);
    gain += std::pow(other.gauges[2].gain_V_per_rad - 1, 2);
    offset += std::pow(other.gauges[0].offset_V, 2);
    rib += std::pow(other.ribs[4].length_mm - finger.ribs[4].length_mm, 2);
    EXPECT_EQ(other.gauges[1].noise_V, finger.gauges[1].noise_V);
    EXPECT_EQ(other.ribs[0].front_mm, finger.ribs[0].front_mm);
  }
  // The std of a std from 2000 draws is 1.6 %; this is three times that.
  EXPECT_NEAR(std::sqrt(stiffness / kDraws), 0.01, 0.0005);
  EXPECT_NEAR(std::sqrt(gain / kDraws), 0.003, 0.00015);
  EXPECT_NEAR(std::sqrt(offset / kDraws), 5e-4, 2.5e-5);
  EXPECT_NEAR(std::sqrt(rib / kDraws), 0.03, 0.0015);
}

}  // namespace
}  // namespace finray
