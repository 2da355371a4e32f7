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
  // The gauges hardly bend, so 50 N at the tip cannot be true.
  EXPECT_EQ(Judge(Estimate(FrameStatus::kOk, 50, 8), 0.5, kSafety),
            Sight::kLight);
}

// The controller takes over when the contact has been seen three times.
void Take(ContactWatch* watch, const std::vector<FrameEstimate>& estimates) {
  const std::vector<double> signals(estimates.size(), kBent);
  EXPECT_EQ(watch->Next(estimates, signals), LoopMode::kHold);
  EXPECT_EQ(watch->Next(estimates, signals), LoopMode::kHold);
  EXPECT_EQ(watch->Next(estimates, signals), LoopMode::kControl);
}

TEST(ContactWatchTest, HoldsThenStopsForGood) {
  ContactWatch watch(kSafety, 0.04);
  EXPECT_EQ(watch.Next({kFreeFinger}, {0}), LoopMode::kApproach);
  Take(&watch, {kGood});
  // 0.1 s is two and a half periods.
  EXPECT_EQ(watch.Next({kLost}, {kBent}), LoopMode::kHold);
  EXPECT_EQ(watch.Next({kLost}, {kBent}), LoopMode::kHold);
  Take(&watch, {kGood});
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(watch.Next({kLost}, {kBent}), LoopMode::kHold);
  }
  EXPECT_EQ(watch.Next({kLost}, {kBent}), LoopMode::kStopped);
  EXPECT_EQ(watch.Next({kGood}, {kBent}), LoopMode::kStopped);
}

// Single frames that look sure do not start the control.
TEST(ContactWatchTest, SingleSureFramesAreNotBelieved) {
  ContactWatch watch({0.3, 10, 1.5, 5}, 0.04);
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(watch.Next({i % 3 == 0 ? kLost : kGood}, {kBent}),
              LoopMode::kHold);
  }
}

// The finger moves on although it sees a light touch.
TEST(ContactWatchTest, GoesOnFromALightTouch) {
  ContactWatch watch(kSafety, 0.04);
  const FrameEstimate light = Estimate(FrameStatus::kOk, 0.8, 0.1);
  EXPECT_EQ(watch.Next({light}, {kBent}), LoopMode::kApproach);
  EXPECT_EQ(watch.Next({light}, {kBent}), LoopMode::kApproach);
  EXPECT_EQ(watch.Next({light}, {kBent}), LoopMode::kControl);
}

TEST(ContactWatchTest, AllFingersHaveToSee) {
  ContactWatch watch(kSafety, 0.04);
  EXPECT_EQ(watch.Next({kGood, kFreeFinger}, {kBent, 0}), LoopMode::kApproach);
  EXPECT_EQ(watch.Next({kGood, kLost}, {kBent, kBent}), LoopMode::kHold);
  Take(&watch, {kGood, kGood});
}

}  // namespace
}  // namespace finray
