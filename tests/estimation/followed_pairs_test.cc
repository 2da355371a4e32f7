// Two contacts from frame to frame: what a search finds, at less cost.

#include <gtest/gtest.h>

#include "finray/finger/finger_yaml.h"
#include "studies/pair_log.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr char kEightGauges[] =
    FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm_eight_gauges.yaml";

// Searches, too, end so far from a minimum where they converge slowly.
constexpr double kSame_std = 5e-5;

void ExpectPairs(const PairAgreement& found, int ok, int other_status) {
  EXPECT_GE(found.ok, ok);
  EXPECT_LE(found.other_status, other_status);
  EXPECT_EQ(found.untrue, 0);
  EXPECT_LT(found.farthest_std, kSame_std);
}

TEST(FollowedPairsTest, AreWhatASearchFinds) {
  const Finger eight = WithLittleNoise(ReadFinger(kEightGauges));
  const PairLog log = SimulatePairs(eight, 640, WanderingPair);
  const PairAgreement found = ComparePairs(eight, SceneOfTwo(), log);
  ExpectPairs(found, 620, 0);
}

// Four gauges leave nothing over, and some frames have two explanations.
TEST(FollowedPairsTest, SayWhereThereAreOthers) {
  const Finger four = WithLittleNoise(PaperFinger());
  const PairLog log = SimulatePairs(four, 640, WanderingPair);
  ExpectPairs(ComparePairs(four, SceneOfTwo(), log), 450, 1);
  // Nothing is left that could doubt a pair on four gauges.
  EXPECT_EQ(ComparePairs(four, Scene(), log).ok, 0);
}

// Live frames go on from pair to pair too.
TEST(FollowedPairsTest, LiveFramesAreWhatASearchFinds) {
  const Finger eight = WithLittleNoise(ReadFinger(kEightGauges));
  const PairLog log = SimulatePairs(eight, 320, WanderingPair);
  FrameEstimator live(eight, SceneOfTwo()), alone(eight, SceneOfTwo());
  int iterations = 0, searched = 0;
  for (const Measurements& row : log.rows) {
    const FrameEstimate one = live.Next(row), other = alone.Estimate(row);
    ASSERT_EQ(one.status, other.status);
    ASSERT_EQ(one.contacts, 2);
    iterations += one.iterations;
    searched += other.iterations;
    for (int c = 0; c < 2; ++c) {
      const ContactEstimate &a = one.contact[c], &b = other.contact[c];
      EXPECT_NEAR(a.arc_mm, b.arc_mm, kSame_std * b.arc_std_mm);
      EXPECT_NEAR(a.normal_N, b.normal_N, kSame_std * b.normal_std_N);
    }
  }
  EXPECT_LT(iterations, 0.8 * searched);
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
    ExpectPairs(found, 90, 0);
  }
}

}  // namespace
}  // namespace finray
