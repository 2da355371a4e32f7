#include "finray/control/contact_watch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

constexpr double kBent = 5;  // TouchSignal of a finger that is clearly bent
constexpr Safety kSafety = {0.3, 0.1, 1.5, 5};

FrameEstimate Estimate(FrameStatus status, double force_N, double std_N) {
  FrameEstimate estimate;
  estimate.status = status;
  estimate.contact[0].normal_N = force_N;
  estimate.contact[0].normal_std_N = std_N;
  return estimate;
}

const FrameEstimate kGood = Estimate(FrameStatus::kOk, 4, 0.1);
const FrameEstimate kFreeFinger = Estimate(FrameStatus::kNoContact, 0, NAN);
const FrameEstimate kLost = Estimate(FrameStatus::kUnobservable, 4, 0.1);

TEST(ContactWatchTest, JudgesWhatAnEstimateIsGoodFor) {
  EXPECT_EQ(Judge(kGood, kBent, kSafety), Sight::kSeen);
  EXPECT_EQ(Judge(Estimate(FrameStatus::kOk, 4, 0.31), kBent, kSafety),
            Sight::kBlind);
  EXPECT_EQ(Judge(kFreeFinger, kBent, kSafety), Sight::kFree);
  EXPECT_EQ(Judge(kLost, kBent, kSafety), Sight::kBlind);
  EXPECT_EQ(
      Judge(Estimate(FrameStatus::kNotConverged, NAN, NAN), kBent, kSafety),
      Sight::kBlind);
  EXPECT_EQ(Judge(Estimate(FrameStatus::kBadInput, NAN, NAN), NAN, kSafety),
            Sight::kBlind);
}

// 1 N +- 0.2 may be a light touch, unless it may be a heavy one elsewhere.
TEST(ContactWatchTest, LightTouches) {
  FrameEstimate light = Estimate(FrameStatus::kUnobservable, 1, 0.2);
  EXPECT_EQ(Judge(light, kBent, kSafety), Sight::kLight);
  light.alternative[0].normal_N = 30;
  EXPECT_EQ(Judge(light, kBent, kSafety), Sight::kBlind);
  // Gauges that hardly bend: 50 N at the tip are not believed.
  EXPECT_EQ(Judge(Estimate(FrameStatus::kOk, 50, 8), 0.5, kSafety),
            Sight::kLight);
}

TEST(ContactWatchTest, HoldsThenStopsForGood) {
  ContactWatch watch(kSafety, 0.04);
  EXPECT_EQ(watch.Next({kFreeFinger}, {0}), LoopMode::kApproach);
  EXPECT_EQ(watch.Next({kGood}, {kBent}), LoopMode::kControl);
  // 0.1 s are two periods and a half.
  EXPECT_EQ(watch.Next({kLost}, {kBent}), LoopMode::kHold);
  EXPECT_EQ(watch.Next({kLost}, {kBent}), LoopMode::kHold);
  EXPECT_EQ(watch.Next({kGood}, {kBent}), LoopMode::kControl);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(watch.Next({kLost}, {kBent}), LoopMode::kHold);
  }
  EXPECT_EQ(watch.Next({kLost}, {kBent}), LoopMode::kStopped);
  EXPECT_EQ(watch.Next({kGood}, {kBent}), LoopMode::kStopped);
}

TEST(ContactWatchTest, AllFingersHaveToSee) {
  ContactWatch watch(kSafety, 0.04);
  EXPECT_EQ(watch.Next({kGood, kFreeFinger}, {kBent, 0}), LoopMode::kApproach);
  EXPECT_EQ(watch.Next({kGood, kLost}, {kBent, kBent}), LoopMode::kHold);
  EXPECT_EQ(watch.Next({kGood, kGood}, {kBent, kBent}), LoopMode::kControl);
}

}  // namespace
}  // namespace finray
