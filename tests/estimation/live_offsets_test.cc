#include "finray/estimation/live_offsets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimation/wandering_log.h"
#include "finray/estimation/frame_estimator.h"
#include "test_finger.h"

namespace finray {
namespace {

struct LiveTally {
  int touching = 0, missed = 0, ok = 0, far = 0, within = 0, imagined = 0,
      free = 0;
};

LiveTally Followed(const WanderingLogSettings& settings,
                   double told_V_per_sqrt_s, double restart_s = INFINITY) {
  WanderingLog log(PaperFinger(), {Scheme::kTaylor12, 96}, settings);
  Scene scene;
  scene.most_contacts = 1;
  scene.gauge_offset_walk = {0.02, told_V_per_sqrt_s};
  FrameEstimator estimator(PaperFinger(), scene);
  LiveTally tally;
  for (std::size_t t = 0; t < log.rows.size(); ++t) {
    if (log.rows[t].time_s >= restart_s) log.rows[t].time_s -= restart_s;
    const FrameEstimate estimate = estimator.Next(log.rows[t]);
    const double truth = log.truth[t].normal_N;
    const ContactEstimate& contact = estimate.contact[0];
    const bool ok = estimate.status == FrameStatus::kOk;
    const double off =
        std::abs(contact.normal_N - truth) / contact.normal_std_N;
    tally.touching += truth > 0;
    tally.missed += truth > 0.3 && estimate.status == FrameStatus::kNoContact;
    tally.free += truth == 0 && estimate.status == FrameStatus::kNoContact;
    tally.ok += ok;
    tally.imagined += ok && truth == 0;
    tally.far += ok && off > 5;
    tally.within += ok && off < 1.96;
  }
  return tally;
}

TEST(LiveOffsetsTest, ForcesUnderOffsetsThatWander) {
  WanderingLogSettings settings;
  settings.duration_s = 300;
  const LiveTally tally = Followed(settings, settings.walk_V_per_sqrt_s);
  EXPECT_GT(tally.ok, 0.5 * tally.touching);
  EXPECT_GT(tally.free, 500);
  EXPECT_LE(tally.imagined, 3);
  EXPECT_LE(tally.missed, 0.01 * tally.touching);
  EXPECT_EQ(tally.far, 0);
  // Frames of one touch err together.
  EXPECT_GT(tally.within, 0.85 * tally.ok);
}

TEST(LiveOffsetsTest, AClockThatStartsAnewHoldsNothingUp) {
  WanderingLogSettings settings;
  settings.duration_s = 300;
  const LiveTally tally = Followed(settings, settings.walk_V_per_sqrt_s, 200);
  EXPECT_GT(tally.ok, 0.5 * tally.touching);
  EXPECT_GT(tally.free, 500);
  EXPECT_LE(tally.missed, 0.01 * tally.touching);
  EXPECT_EQ(tally.far, 0);
}

TEST(LiveOffsetsTest, DriftUnderLoadIsNoForce) {
  WanderingLogSettings settings;
  settings.rate_Hz = 5;
  settings.duration_s = 340;
  settings.walk_V_per_sqrt_s = settings.start_std_V = 0;
  settings.drift_V_per_s = 1e-4;
  settings.shortest_touch_s = settings.longest_touch_s = 310;
  settings.shortest_gap_s = settings.longest_gap_s = 10;
  settings.least_N = settings.most_N = 2;
  settings.lowest_mm = settings.highest_mm = 70;
  const LiveTally tally = Followed(settings, 5e-4);
  EXPECT_GT(tally.ok, 50);
  EXPECT_EQ(tally.missed, 0);
  EXPECT_EQ(tally.imagined, 0);
  EXPECT_EQ(tally.far, 0);
}

TEST(LiveOffsetsTest, ANewLogBeginsAfresh) {
  WanderingLogSettings settings;
  settings.duration_s = 10;
  const WanderingLog log(PaperFinger(), {Scheme::kTaylor12, 96}, settings);
  Scene scene;
  scene.gauge_offset_walk = {0.05, 1e-3};
  FrameEstimator used(PaperFinger(), scene), fresh(PaperFinger(), scene);
  for (const Measurements& row : log.rows) used.Next(row);
  used.Restart();
  EXPECT_EQ(used.Next(log.rows[0]).gauge_offset_V,
            fresh.Next(log.rows[0]).gauge_offset_V);
}

}  // namespace
}  // namespace finray
