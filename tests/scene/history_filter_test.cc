#include "finray/scene/history_filter.h"

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

TEST(HistoryFilterTest, TakesOutWhatTheSimulationPutsIn) {
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

  HistoryFilter filter(creeping);
  EXPECT_FALSE(filter.empty());
  EXPECT_TRUE(HistoryFilter(finger).empty());
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

TEST(HistoryFilterTest, TakesOutHysteresis) {
  Finger plain = PaperFinger();
  for (Gauge& gauge : plain.gauges) gauge.noise_V = 1e-5;
  plain.gauges[0].offset_V = 0.3;
  Finger with = plain;
  for (Gauge& gauge : with.gauges) gauge.hysteresis_rad = 1e-3;
  with.gauges[3].creep_share = 0.1;
  FrameTable expected(40), measured(40);
  for (FrameTable* frames : {&expected, &measured}) {
    for (int i = 0; i < 40; ++i) {
      frames->MutableNumbers("time_s")[i] = 3 * i;
      frames->MutableNumbers("contact_1_mm")[i] = 30 + 37 * i % 80;
      frames->MutableNumbers("normal_1_N")[i] = 1 + 5 * i % 7;
    }
  }
  ASSERT_EQ(Simulate(plain, {}, {}, &expected).not_converged, 0);
  ASSERT_EQ(Simulate(with, {}, {}, &measured).not_converged, 0);
  const auto truth = ReadMeasurements(expected, plain);
  auto rows = ReadMeasurements(measured, with);
  HistoryFilter filter(with);
  int sure = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(rows[i].gauges_V[0], truth[i].gauges_V[0],
                with.gauges[0].HysteresisV() * (1 + 1e-9));
    filter.Remove(&rows[i]);
    for (std::size_t j = 0; j < 4; ++j) {
      const double std_V = rows[i].GaugeStd_V(j, 1e-5);
      // Creep lags a little otherwise between rows of a log than of one with
      // hysteresis.
      EXPECT_NEAR(rows[i].gauges_V[j], truth[i].gauges_V[j],
                  3 * std_V + (j == 3 ? 2e-4 : 1e-6))
          << i << " " << j;
      sure += std_V < 2e-5;
    }
  }
  EXPECT_GT(sure, 100);
}

TEST(HistoryFilterTest, HysteresisNeedsNoTime) {
  Finger with = PaperFinger();
  with.gauges[0].hysteresis_rad = 1e-3;
  FrameTable frames(1);
  frames.MutableNumbers("contact_1_mm")[0] = 70;
  frames.MutableNumbers("normal_1_N")[0] = 5;
  EXPECT_EQ(Simulate(with, {}, {}, &frames).not_converged, 0);
}

TEST(HistoryFilterTest, NeedsTime) {
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
