#include "finray/estimation/log_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "estimation/wandering_log.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/io/error.h"
#include "test_finger.h"

namespace finray {
namespace {

Scene WalkingScene() {
  Scene scene;
  scene.gauge_offset_walk = {0.05, 0.001};
  return scene;
}

WanderingLog Log(double duration_s, unsigned seed = 1) {
  WanderingLogSettings settings;
  settings.duration_s = duration_s;
  settings.seed = seed;
  return WanderingLog(PaperFinger(), {Scheme::kTaylor12, 96}, settings);
}

std::vector<FrameEstimate> Estimate(const Scene& scene,
                                    const std::vector<Measurements>& rows,
                                    int threads = 1) {
  std::vector<FrameEstimate> estimates;
  LogEstimator estimator(
      PaperFinger(), scene, {}, threads,
      [&](const FrameEstimate& e) { estimates.push_back(e); });
  for (const Measurements& row : rows) estimator.Add(row);
  estimator.Finish();
  return estimates;
}

TEST(LogEstimatorTest, FindsForcesUnderOffsetsThatWander) {
  const WanderingLog log = Log(300);
  const std::vector<FrameEstimate> estimates =
      Estimate(WalkingScene(), log.rows);
  ASSERT_EQ(estimates.size(), log.rows.size());
  double squares = 0;
  int touching = 0, missed = 0, imagined = 0, within = 0, ok = 0;
  for (std::size_t t = 0; t < estimates.size(); ++t) {
    const double truth = log.truth[t].normal_N;
    const ContactEstimate& contact = estimates[t].contact[0];
    if (truth <= 0) {
      imagined += estimates[t].contacts > 0;
      continue;
    }
    ++touching;
    missed += estimates[t].contacts == 0;
    if (std::isnan(contact.normal_N)) continue;
    squares += std::pow(contact.normal_N - truth, 2);
    if (estimates[t].status != FrameStatus::kOk) continue;
    ++ok;
    within += std::abs(contact.normal_N - truth) < 1.96 * contact.normal_std_N;
  }
  EXPECT_LT(std::sqrt(squares / touching), 0.4);
  EXPECT_LT(missed, 0.03 * touching);
  EXPECT_LE(imagined, 3);
  // Frames of one touch err together.
  EXPECT_GT(within, 0.85 * ok);
  for (std::size_t j = 0; j < 4; ++j) {
    for (const std::size_t t : {500, 2000}) {
      EXPECT_NEAR(estimates[t].gauge_offset_V[j], log.offsets_V[t][j],
                  4 * estimates[t].gauge_offset_std_V[j]);
    }
  }
}

TEST(LogEstimatorTest, WindowsTellWhatOneProblemTells) {
  // Over kWindow frames with a gap: two windows against one.
  const WanderingLog log = Log(240, 2);
  ASSERT_GT(log.rows.size(), LogEstimator::kWindow);
  const std::vector<FrameEstimate> windows = Estimate(WalkingScene(), log.rows);
  // The last 150 s of the log need not be there for its first frames.
  const std::vector<Measurements> begin(
      log.rows.begin(), log.rows.begin() + LogEstimator::kWindow - 1);
  const std::vector<FrameEstimate> one = Estimate(WalkingScene(), begin);
  int compared = 0;
  for (std::size_t t = 0; t < 1500; ++t) {
    if (windows[t].contacts == 0 || one[t].contacts == 0) continue;
    ++compared;
    const ContactEstimate& a = windows[t].contact[0];
    const ContactEstimate& b = one[t].contact[0];
    EXPECT_NEAR(a.normal_N, b.normal_N, 0.2 * b.normal_std_N) << t;
    EXPECT_NEAR(a.normal_std_N / b.normal_std_N, 1, 0.1) << t;
  }
  EXPECT_GT(compared, 500);
}

TEST(LogEstimatorTest, HoldsNoMoreFramesOfALongerLog) {
  WanderingLogSettings settings;
  settings.duration_s = 1600;
  settings.shortest_touch_s = 1;
  settings.longest_touch_s = 2;
  settings.shortest_gap_s = 20;
  settings.longest_gap_s = 60;
  const WanderingLog log(PaperFinger(), {Scheme::kTaylor12, 96}, settings);
  std::size_t taken = 0, added = 0, most = 0;
  LogEstimator estimator(PaperFinger(), WalkingScene(), {}, 1,
                         [&](const FrameEstimate&) { ++taken; });
  for (const Measurements& row : log.rows) {
    most = std::max(most, ++added - taken);
    estimator.Add(row);
  }
  estimator.Finish();
  EXPECT_EQ(taken, log.rows.size());
  EXPECT_LT(most, 3 * LogEstimator::kWindow);
}

TEST(LogEstimatorTest, WithoutAWalkFramesAreThoseOfTheFrameEstimator) {
  WanderingLogSettings settings;
  settings.duration_s = 30;
  settings.walk_V_per_sqrt_s = settings.start_std_V = 0;
  const WanderingLog log(PaperFinger(), {Scheme::kTaylor12, 96}, settings);
  const std::vector<FrameEstimate> estimates = Estimate(Scene(), log.rows);
  FrameEstimator frames(PaperFinger(), {}, {});
  int ok = 0, other = 0;
  for (std::size_t t = 0; t < estimates.size(); ++t) {
    EXPECT_TRUE(estimates[t].gauge_offset_V.empty());
    const FrameEstimate alone = frames.Estimate(log.rows[t]);
    other += estimates[t].status != alone.status;
    if (estimates[t].status != FrameStatus::kOk || alone.contacts != 1)
      continue;
    ++ok;
    const ContactEstimate &a = estimates[t].contact[0], &b = alone.contact[0];
    // The whole log has weak priors and a robust loss.
    EXPECT_NEAR(a.arc_mm, b.arc_mm, 0.1 * b.arc_std_mm) << t;
    EXPECT_NEAR(a.normal_N, b.normal_N, 0.1 * b.normal_std_N) << t;
    // Only frames by themselves look along the valley.
    if (alone.valley) continue;
    EXPECT_NEAR(a.normal_std_N / b.normal_std_N, 1, 0.1) << t;
  }
  EXPECT_GT(ok, 150);
  EXPECT_LE(other, 2);
}

// How the frames of a log are judged.
struct Tally {
  int touching = 0, missed = 0, ok = 0, far = 0, imagined = 0;
  WalkIncrements walk;
  std::size_t alone = 0;
};

Tally Judged(const WanderingLogSettings& settings, double told_V_per_sqrt_s) {
  const WanderingLog log(PaperFinger(), {Scheme::kTaylor12, 96}, settings);
  Scene scene;
  scene.gauge_offset_walk = {0.05, told_V_per_sqrt_s};
  std::vector<FrameEstimate> estimates;
  LogEstimator estimator(
      PaperFinger(), scene, {}, 1,
      [&](const FrameEstimate& e) { estimates.push_back(e); });
  for (const Measurements& row : log.rows) estimator.Add(row);
  estimator.Finish();
  Tally tally;
  tally.walk = estimator.walk();
  tally.alone = estimator.alone();
  for (std::size_t t = 0; t < estimates.size(); ++t) {
    const double truth = log.truth[t].normal_N;
    const ContactEstimate& contact = estimates[t].contact[0];
    const bool ok = estimates[t].status == FrameStatus::kOk;
    tally.touching += truth > 0;
    // Frames of the weak begin and end are not counted.
    tally.missed +=
        truth > 0.3 && estimates[t].status == FrameStatus::kNoContact;
    tally.ok += ok;
    tally.imagined += ok && truth == 0;
    tally.far +=
        ok && std::abs(contact.normal_N - truth) > 5 * contact.normal_std_N;
  }
  return tally;
}

WanderingLogSettings Held(unsigned seed) {
  WanderingLogSettings settings;
  settings.rate_Hz = 5;
  settings.duration_s = 320;
  settings.shortest_touch_s = settings.longest_touch_s = 300;
  settings.shortest_gap_s = settings.longest_gap_s = 10;
  settings.start_std_V = 5e-3;
  settings.least_N = settings.most_N = 2;
  settings.lowest_mm = settings.highest_mm = 70;
  settings.seed = seed;
  return settings;
}

TEST(LogEstimatorTest, AContactThatIsHeldDoesNotBecomeAnOffset) {
  for (const unsigned seed : {1U, 2U}) {
    WanderingLogSettings settings = Held(seed);
    settings.walk_V_per_sqrt_s = 1e-4;
    const Tally wide = Judged(settings, 1e-3);
    EXPECT_GT(wide.touching, 1400);
    EXPECT_EQ(wide.missed, 0);
    EXPECT_EQ(wide.imagined, 0);
    EXPECT_EQ(wide.far, 0);
    EXPECT_EQ(wide.alone, 0U);
    EXPECT_GT(wide.ok, 200);
    EXPECT_EQ(wide.walk.Judge(), WalkIncrements::Verdict::kTooLarge);
    EXPECT_NEAR(std::log(wide.walk.FittingWalk() / 1e-4), 0, std::log(2));
    const Tally told = Judged(settings, 1e-4);
    EXPECT_GT(told.ok, 1400);
    EXPECT_EQ(told.missed, 0);
    EXPECT_EQ(told.walk.Judge(), WalkIncrements::Verdict::kFits);
  }
}

// Each frame adds a little that draws the force, by its weak prior and by the
// walk of its place. The frames of a long touch at a high rate are many.
TEST(LogEstimatorTest, ManyFramesOfATouchDoNotDrawItsForce) {
  WanderingLogSettings settings = Held(5);
  settings.rate_Hz = 30;
  settings.duration_s = 170;
  settings.shortest_touch_s = settings.longest_touch_s = 160;
  settings.shortest_gap_s = settings.longest_gap_s = 5;
  settings.walk_V_per_sqrt_s = 1e-4;
  const Tally tally = Judged(settings, 1e-4);
  EXPECT_GT(tally.ok, 4500);
  EXPECT_EQ(tally.far, 0);
  EXPECT_EQ(tally.walk.Judge(), WalkIncrements::Verdict::kFits);
}

TEST(LogEstimatorTest, AContactThatIsHeldToTheEndIsNoOffset) {
  WanderingLogSettings settings = Held(3);
  settings.duration_s = 300;
  settings.walk_V_per_sqrt_s = 1e-4;
  const Tally tally = Judged(settings, 1e-3);
  EXPECT_EQ(tally.missed, 0);
  EXPECT_EQ(tally.far, 0);
}

TEST(LogEstimatorTest, ASteadyDriftIsNoWalk) {
  WanderingLogSettings settings;
  settings.rate_Hz = 10;
  settings.duration_s = 300;
  settings.walk_V_per_sqrt_s = 0;
  settings.start_std_V = 0;
  settings.drift_V_per_s = 1e-4;
  settings.shortest_touch_s = settings.longest_touch_s = 27;
  settings.shortest_gap_s = settings.longest_gap_s = 3;
  settings.least_N = settings.most_N = 2;
  settings.lowest_mm = settings.highest_mm = 70;
  const Tally tally = Judged(settings, 1e-4);
  EXPECT_EQ(tally.imagined, 0);
  EXPECT_EQ(tally.far, 0);
  EXPECT_EQ(tally.walk.Judge(), WalkIncrements::Verdict::kDrift);
}

TEST(LogEstimatorTest, AWalkThatIsLargerThanToldIsFound) {
  WanderingLogSettings settings;
  settings.rate_Hz = 5;
  settings.duration_s = 200;
  const Tally larger = Judged(settings, 2e-4);
  EXPECT_EQ(larger.ok, 0);
  EXPECT_TRUE(larger.alone > 0 ||
              larger.walk.Judge() == WalkIncrements::Verdict::kTooSmall);
  const Tally told = Judged(settings, 1e-3);
  EXPECT_GT(told.ok, 300);
  EXPECT_EQ(told.walk.Judge(), WalkIncrements::Verdict::kFits);
}

// The finger has no equilibrium at the readings of the odd row.
TEST(LogEstimatorTest, OneOddRowLeavesTheOthers) {
  std::vector<Measurements> rows(21);
  for (std::size_t t = 0; t < rows.size(); ++t) {
    rows[t].time_s = 0.1 * static_cast<double>(t);
    rows[t].gauges_V = {0, 0, 0, 0};
  }
  rows[10].gauges_V = {0.036, -0.3524, -0.0401, 0.5546};
  Scene scene;
  scene.gauge_offset_walk = {0.05, 1e-4};
  const std::vector<FrameEstimate> estimates = Estimate(scene, rows);
  ASSERT_EQ(estimates.size(), rows.size());
  for (std::size_t t = 0; t < rows.size(); ++t) {
    EXPECT_EQ(estimates[t].status,
              t == 10 ? FrameStatus::kUnobservable : FrameStatus::kNoContact)
        << t;
  }
}

TEST(LogEstimatorTest, ASceneWithoutContactsHasNone) {
  WanderingLogSettings settings;
  settings.duration_s = 30;
  const WanderingLog log(PaperFinger(), {Scheme::kTaylor12, 96}, settings);
  Scene scene = WalkingScene();
  scene.contacts = 0;
  int free = 0, unobservable = 0;
  for (const FrameEstimate& estimate : Estimate(scene, log.rows)) {
    // The touches of the log are explained by nothing that the scene has.
    free += estimate.status == FrameStatus::kNoContact;
    unobservable += estimate.status == FrameStatus::kUnobservable;
    EXPECT_EQ(estimate.contacts, 0);
  }
  EXPECT_EQ(free + unobservable, static_cast<int>(log.rows.size()));
  EXPECT_GT(unobservable, 0);
}

TEST(LogEstimatorTest, RefusesTimesThatDoNotAscend) {
  LogEstimator estimator(PaperFinger(), WalkingScene(), {}, 1,
                         [](const FrameEstimate&) {});
  Measurements row;
  row.gauges_V = {0, 0, 0, 0};
  EXPECT_THROW(estimator.Add(row), InputError);
  row.time_s = 1;
  estimator.Add(row);
  EXPECT_THROW(estimator.Add(row), InputError);
}

TEST(LogEstimatorTest, RefusesTwoContacts) {
  Scene scene = WalkingScene();
  scene.contacts = 2;
  EXPECT_THROW(
      LogEstimator(PaperFinger(), scene, {}, 1, [](const FrameEstimate&) {}),
      InputError);
}

}  // namespace
}  // namespace finray
