// A search that is ended in time says so (Scene::search_iteration_limit).

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "estimation/gauge_volts.h"
#include "finray/benchmark/latency.h"
#include "finray/estimation/frame_estimator.h"
#include "test_finger.h"

namespace finray {
namespace {

class SearchLimitTest : public testing::Test {
 protected:
  std::vector<FrameEstimate> Estimates(std::optional<int> contacts,
                                       std::optional<int> limit) {
    Scene scene;
    scene.contacts = contacts;
    scene.search_iteration_limit = limit;
    FrameEstimator estimator(finger_, scene);
    std::vector<FrameEstimate> estimates;
    for (const Measurements& row : log_)
      estimates.push_back(estimator.Next(row));
    return estimates;
  }

  const Finger finger_ = PaperFinger();
  // The finger is not quite the one that is estimated with, so that one contact
  // often does not explain a frame.
  const std::vector<Measurements> log_ =
      LatencyReadings(SlightlyWrong(SlightlyWrong(finger_)), 300);
};

TEST_F(SearchLimitTest, FramesAreThoseOfAWholeSearchOrFlagged) {
  for (const std::optional<int> contacts : {std::optional<int>(1), {}}) {
    const std::vector<FrameEstimate> whole = Estimates(contacts, {});
    int longest = 0;
    for (const FrameEstimate& one : whole) {
      EXPECT_FALSE(one.search_ended);
      longest = std::max(longest, one.iterations);
    }
    for (const int limit : {1, 6, 12, 40}) {
      const std::vector<FrameEstimate> limited = Estimates(contacts, limit);
      int ended = 0;
      for (std::size_t i = 0; i < whole.size(); ++i) {
        SCOPED_TRACE("frame " + std::to_string(i) + ", limit " +
                     std::to_string(limit));
        const FrameEstimate &a = limited[i], &b = whole[i];
        EXPECT_LE(a.iterations, limit);
        if (a.search_ended) {
          ++ended;
          EXPECT_TRUE(a.status == FrameStatus::kUnobservable ||
                      a.status == FrameStatus::kNotConverged);
          continue;
        }
        EXPECT_EQ(a.status, b.status);
        if (a.status != FrameStatus::kOk) continue;
        // One may be followed, the other searched.
        EXPECT_NEAR(a.contact[0].arc_mm, b.contact[0].arc_mm,
                    0.02 * b.contact[0].arc_std_mm);
        EXPECT_NEAR(a.contact[0].normal_N, b.contact[0].normal_N,
                    0.02 * b.contact[0].normal_std_N);
      }
      // A whole search may try a start twice.
      EXPECT_TRUE(ended == 0 || longest > limit);
      EXPECT_TRUE(ended > 0 || limit > 1 || contacts);
      EXPECT_LT(ended, limit > 10 ? 250 : 301);
    }
  }
}

TEST_F(SearchLimitTest, AGenerousLimitChangesNothing) {
  const auto whole = Estimates({}, {}), limited = Estimates({}, 100000);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_FALSE(limited[i].search_ended);
    EXPECT_EQ(limited[i].status, whole[i].status) << i;
  }
}

// A frame that may hold contacts is not called free because time is up. A fit
// of two contacts takes more than one iteration.
TEST_F(SearchLimitTest, NothingFoundInTimeIsNotNoContact) {
  for (const FrameEstimate& one : Estimates(2, 1)) {
    EXPECT_NE(one.status, FrameStatus::kNoContact);
    EXPECT_NE(one.status, FrameStatus::kOk);
  }
}

// The profile of a pair past the last rib takes most of its search.
TEST_F(SearchLimitTest, TheProfileOfAPairIsBoundedToo) {
  EquilibriumSolver plant(finger_, {Scheme::kTaylor8, 3});
  ASSERT_TRUE(plant.Solve({{60, 3, 0}, {122, 2, 0}}));
  Measurements row;
  row.gauges_V = Volts(plant);
  const auto estimate = [&](std::optional<int> limit) {
    Scene scene;
    scene.contacts = 2;
    scene.search_iteration_limit = limit;
    return FrameEstimator(finger_, scene).Estimate(row);
  };
  const FrameEstimate whole = estimate({});
  ASSERT_EQ(whole.contacts, 2);
  for (const int left_out : {1, 2, 5, 20}) {
    const int limit = whole.iterations - left_out;
    const FrameEstimate ended = estimate(limit);
    EXPECT_LE(ended.iterations, limit);
    EXPECT_TRUE(ended.search_ended) << limit;
    EXPECT_NE(ended.status, FrameStatus::kOk);
  }
  const FrameEstimate enough = estimate(whole.iterations + 1);
  EXPECT_FALSE(enough.search_ended);
  EXPECT_EQ(enough.status, whole.status);
  EXPECT_EQ(enough.iterations, whole.iterations);
}

}  // namespace
}  // namespace finray
