// Two contacts from frame to frame: what a search finds, at less cost.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "finray/finger/finger_yaml.h"
#include "finray/scene/clean_readings.h"
#include "finray/sensing/frame_estimator.h"
#include "studies/gauge_frames.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr char kEightGauges[] =
    FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm_eight_gauges.yaml";

// Searches, too, end so far from a minimum where they converge slowly.
constexpr double kSame_std = 5e-5;

using PairOfContacts = std::vector<PointContact>;

// Two contacts that wander, sampled at 100 Hz.
PairOfContacts WanderingPair(int frame) {
  const double t = 0.01 * frame;
  return {{50 + 14 * std::sin(0.7 * t), 3 + 2 * std::sin(1.7 * t), 0},
          {95 + 14 * std::sin(1.1 * t + 1), 3 + 2 * std::sin(1.3 * t + 2), 0}};
}

struct PairLog {
  std::vector<PairOfContacts> truth;
  std::vector<Measurements> rows;
};

// The plant's mesh is another than the estimator's.
template <class At>
PairLog SimulatePairs(const Finger& finger, int frames, const At& at) {
  EquilibriumSolver solver(finger, {Scheme::kTaylor8, 3});
  std::mt19937_64 generator(11);
  PairLog log;
  for (int i = 0; i < frames; ++i) {
    log.truth.push_back(at(i));
    EXPECT_TRUE(solver.Solve(log.truth.back())) << i;
    log.rows.push_back(WithNoise(CleanReadings(solver), finger, &generator));
  }
  return log;
}

Finger WithLittleNoise(Finger finger) {
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 1e-4;
  return finger;
}

Scene SceneOfTwo() {
  Scene scene;
  scene.contacts = 2;
  return scene;
}

struct PairAgreement {
  int ok = 0, other_status = 0, untrue = 0;
  double farthest_std = 0;
};

// Frames in blocks of 64 against frames that are searched alone.
PairAgreement ComparePairs(const Finger& finger, const Scene& scene,
                           const PairLog& log) {
  FrameEstimator blocks(finger, scene), alone(finger, scene);
  std::vector<FrameEstimate> estimates(log.rows.size());
  for (std::size_t i = 0; i < log.rows.size(); i += 64) {
    blocks.EstimateBlock(&log.rows[i],
                         std::min<std::size_t>(64, log.rows.size() - i),
                         &estimates[i]);
  }
  PairAgreement found;
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    const FrameEstimate& one = estimates[i];
    const FrameEstimate other = alone.Estimate(log.rows[i]);
    found.other_status +=
        one.status != other.status || one.contacts != other.contacts;
    if (one.status != FrameStatus::kOk || one.contacts != 2) continue;
    ++found.ok;
    for (int c = 0; c < 2; ++c) {
      const ContactEstimate& e = one.contact[c];
      const double off = std::abs(e.arc_mm - log.truth[i][c].arc_mm);
      found.untrue += off > 5 * e.arc_std_mm;
      if (other.status != FrameStatus::kOk) continue;
      found.farthest_std = std::max(
          {found.farthest_std,
           std::abs(e.arc_mm - other.contact[c].arc_mm) / e.arc_std_mm,
           std::abs(e.normal_N - other.contact[c].normal_N) / e.normal_std_N});
    }
  }
  std::printf("%d ok, %d of another status, %d untrue, farthest %.1e std\n",
              found.ok, found.other_status, found.untrue, found.farthest_std);
  return found;
}

TEST(FollowedPairsTest, AreWhatASearchFinds) {
  const Finger eight = WithLittleNoise(ReadFinger(kEightGauges));
  const PairLog log = SimulatePairs(eight, 640, WanderingPair);
  const PairAgreement found = ComparePairs(eight, SceneOfTwo(), log);
  EXPECT_GE(found.ok, 620);
  EXPECT_EQ(found.other_status, 0);
  EXPECT_EQ(found.untrue, 0);
  EXPECT_LT(found.farthest_std, kSame_std);
}

// Four gauges leave nothing over, and some frames have two explanations.
TEST(FollowedPairsTest, SayWhereThereAreOthers) {
  const Finger four = WithLittleNoise(PaperFinger());
  const PairLog log = SimulatePairs(four, 640, WanderingPair);
  for (const Scene& scene : {Scene(), SceneOfTwo()}) {
    const PairAgreement found = ComparePairs(four, scene, log);
    EXPECT_GE(found.ok, 450);
    EXPECT_LE(found.other_status, 1);
    EXPECT_EQ(found.untrue, 0);
    EXPECT_LT(found.farthest_std, kSame_std);
  }
}

// Contacts that jump, leave and come are searched.
TEST(FollowedPairsTest, ContactsJump) {
  const Finger eight = WithLittleNoise(ReadFinger(kEightGauges));
  const PairLog log =
      SimulatePairs(eight, 128, [](int frame) -> PairOfContacts {
        if (frame % 32 >= 28) return {};
        if (frame % 32 >= 24) return {{70, 3, 0}};
        return frame % 16 < 8 ? PairOfContacts{{40, 2, 0}, {90, 4, 0}}
                              : PairOfContacts{{60, 4, 0}, {105, 2, 0}};
      });
  for (const Scene& scene : {Scene(), SceneOfTwo()}) {
    const PairAgreement found = ComparePairs(eight, scene, log);
    EXPECT_GE(found.ok, 90);
    EXPECT_EQ(found.other_status, 0);
    EXPECT_EQ(found.untrue, 0);
    EXPECT_LT(found.farthest_std, kSame_std);
  }
}

}  // namespace
}  // namespace finray
