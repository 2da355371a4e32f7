#include "finray/scene/creep_filter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "finray/io/error.h"
#include "finray/scene/measurement_columns.h"
#include "finray/scene/simulation.h"
#include "test_finger.h"

namespace finray {
namespace {

// A finger that is pressed, held and let go, with rows every 2 s.
FrameTable Held() {
  FrameTable frames(60);
  for (int i = 0; i < 60; ++i) {
    frames.MutableNumbers("time_s")[i] = 100 + 2 * i;
    frames.MutableNumbers("contact_1_mm")[i] = 70;
    frames.MutableNumbers("normal_1_N")[i] = i < 10 || i > 40 ? 0 : 5;
  }
  return frames;
}

TEST(CreepFilterTest, TakesOutWhatTheSimulationPutsIn) {
  Finger finger = PaperFinger();
  finger.gauges[0].offset_V = 0.3;
  Finger creeping = finger;
  creeping.gauges[0].creep_share = 0.1;
  creeping.gauges[0].creep_time_constant_s = 15;
  creeping.gauges[2].creep_share = -0.05;
  FrameTable plain = Held(), crept = Held();
  Simulate(finger, {}, {}, &plain);
  Simulate(creeping, {}, {}, &crept);
  const auto expected = ReadMeasurements(plain, finger);
  auto rows = ReadMeasurements(crept, creeping);
  // It comes in slowly and stays for a while.
  const double pressed = expected[30].gauges_V[0] - 0.3;
  EXPECT_NEAR(rows[11].gauges_V[0], expected[11].gauges_V[0],
              0.03 * std::abs(pressed));
  EXPECT_NEAR(rows[40].gauges_V[0] - expected[40].gauges_V[0], 0.1 * pressed,
              0.01 * std::abs(pressed));
  EXPECT_GT(std::abs(rows[43].gauges_V[0] - 0.3), 0.05 * std::abs(pressed));
  EXPECT_EQ(rows[40].gauges_V[1], expected[40].gauges_V[1]);

  CreepFilter filter(creeping);
  EXPECT_FALSE(filter.empty());
  EXPECT_TRUE(CreepFilter(finger).empty());
  rows[20].gauges_V[0] = std::nan("");
  for (int pass = 0; pass < 2; ++pass) {
    auto filtered = rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      filter.Remove(&filtered[i]);
      if (i == 20) continue;
      for (int j = 0; j < 4; ++j) {
        EXPECT_NEAR(filtered[i].gauges_V[j], expected[i].gauges_V[j],
                    2e-3 * std::abs(pressed))
            << "row " << i << ", gauge " << j + 1;
      }
    }
    EXPECT_TRUE(std::isnan(filtered[20].gauges_V[0]));
    filter.Restart();
  }
}

TEST(CreepFilterTest, NeedsTime) {
  Finger creeping = PaperFinger();
  creeping.gauges[0].creep_share = 0.1;
  FrameTable frames(1);
  frames.MutableNumbers("contact_1_mm")[0] = 70;
  frames.MutableNumbers("normal_1_N")[0] = 5;
  EXPECT_THAT([&] { Simulate(creeping, {}, {}, &frames); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr(
                  "; the creep of the finger's gauges needs it")));
}

}  // namespace
}  // namespace finray
