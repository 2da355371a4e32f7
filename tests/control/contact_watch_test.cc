#include "finray/control/contact_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "finray/statics/equilibrium.h"
#include "test_finger.h"

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

void ExpectSight(const FrameEstimate& estimate, double signal, bool seen,
                 bool free, bool light) {
  const Sight sight = Judge(estimate, signal, kSafety);
  EXPECT_EQ(sight.seen, seen);
  EXPECT_EQ(sight.free, free);
  EXPECT_EQ(sight.light, light);
  EXPECT_EQ(sight.blind(), !(seen || free || light));
}

TEST(ContactWatchTest, JudgesWhatAnEstimateIsGoodFor) {
  ExpectSight(kGood, kBent, true, false, false);
  ExpectSight(Estimate(FrameStatus::kOk, 4, 0.31), kBent, false, false, false);
  ExpectSight(kFreeFinger, kBent, false, true, false);
  ExpectSight(kLost, kBent, false, false, false);
  ExpectSight(Estimate(FrameStatus::kNotConverged, NAN, NAN), kBent, false,
              false, false);
  ExpectSight(Estimate(FrameStatus::kBadInput, NAN, NAN), NAN, false, false,
              false);
}

// 1 N +- 0.2 may be a light touch, unless it may be a heavy one elsewhere.
TEST(ContactWatchTest, LightTouches) {
  FrameEstimate light = Estimate(FrameStatus::kUnobservable, 1, 0.2);
  ExpectSight(light, kBent, false, false, true);
  light.alternative[0].normal_N = 30;
  ExpectSight(light, kBent, false, false, false);
  // The gauges hardly bend, so 50 N at the tip cannot be true.
  ExpectSight(Estimate(FrameStatus::kOk, 50, 8), 0.5, false, false, true);
}

// Judges the estimates of all fingers, each with its signal.
LoopMode Next(ContactWatch* watch, const std::vector<FrameEstimate>& estimates,
              const std::vector<double>& signals) {
  std::vector<Sight> sights;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    sights.push_back(Judge(estimates[i], signals[i], kSafety));
  }
  return watch->Next(sights);
}

// The controller takes over when the contact has been seen three times.
void Take(ContactWatch* watch, const std::vector<FrameEstimate>& estimates) {
  const std::vector<double> signals(estimates.size(), kBent);
  EXPECT_EQ(Next(watch, estimates, signals), LoopMode::kHold);
  EXPECT_EQ(Next(watch, estimates, signals), LoopMode::kHold);
  EXPECT_EQ(Next(watch, estimates, signals), LoopMode::kControl);
}

TEST(ContactWatchTest, HoldsThenStopsForGood) {
  ContactWatch watch(kSafety, 0.04);
  EXPECT_EQ(Next(&watch, {kFreeFinger}, {0}), LoopMode::kApproach);
  Take(&watch, {kGood});
  // 0.1 s is two and a half periods.
  EXPECT_EQ(Next(&watch, {kLost}, {kBent}), LoopMode::kHold);
  EXPECT_EQ(Next(&watch, {kLost}, {kBent}), LoopMode::kHold);
  Take(&watch, {kGood});
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(Next(&watch, {kLost}, {kBent}), LoopMode::kHold);
  }
  EXPECT_EQ(Next(&watch, {kLost}, {kBent}), LoopMode::kStopped);
  EXPECT_EQ(Next(&watch, {kGood}, {kBent}), LoopMode::kStopped);
}

// Single frames that look sure do not start the control.
TEST(ContactWatchTest, SingleSureFramesAreNotBelieved) {
  ContactWatch watch({0.3, 10, 1.5, 5}, 0.04);
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(Next(&watch, {i % 3 == 0 ? kLost : kGood}, {kBent}),
              LoopMode::kHold);
  }
}

// The finger moves on although it sees a light touch.
TEST(ContactWatchTest, GoesOnFromALightTouch) {
  ContactWatch watch(kSafety, 0.04);
  const FrameEstimate light = Estimate(FrameStatus::kOk, 0.8, 0.1);
  EXPECT_EQ(Next(&watch, {light}, {kBent}), LoopMode::kApproach);
  EXPECT_EQ(Next(&watch, {light}, {kBent}), LoopMode::kApproach);
  EXPECT_EQ(Next(&watch, {light}, {kBent}), LoopMode::kControl);
}

TEST(ContactWatchTest, AllFingersHaveToSee) {
  ContactWatch watch(kSafety, 0.04);
  EXPECT_EQ(Next(&watch, {kGood, kFreeFinger}, {kBent, 0}),
            LoopMode::kApproach);
  EXPECT_EQ(Next(&watch, {kGood, kLost}, {kBent, kBent}), LoopMode::kHold);
  Take(&watch, {kGood, kGood});
}

Measurements Readings(const Finger& finger, double arc_mm, double force_N) {
  EquilibriumSolver solver(finger, {});
  EXPECT_TRUE(solver.Solve({{arc_mm, force_N}}));
  Measurements readings;
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    readings.gauges_V.push_back(solver.gauge_angle(j));
  }
  return readings;
}

// A contact of touch_N between 0.2 and 0.8 of the length gives 1 or more.
TEST(TouchSignalTest, IsOneOrMoreForTheTouchItself) {
  const Finger finger = PaperFinger();
  const TouchSignal signal(finger, 1.5, {});
  double least = 1e9;
  for (double arc = 28; arc <= 112; arc += 3.5) {
    least = std::min(least, signal.Of(Readings(finger, arc, 1.5)));
  }
  EXPECT_NEAR(least, 1, 0.001);
  EXPECT_LT(signal.Of(Readings(finger, 80, 0.01)), 0.1);
}

TEST(TouchSignalTest, IsUnknownWithoutAGauge) {
  const Finger finger = PaperFinger();
  const TouchSignal signal(finger, 1.5, {});
  Measurements readings = Readings(finger, 80, 0.01);
  readings.gauges_V[2] = std::nan("");
  EXPECT_TRUE(std::isnan(signal.Of(readings)));
}

}  // namespace
}  // namespace finray
