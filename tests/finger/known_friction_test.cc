#include "finray/finger/known_friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test_finger.h"

namespace finray {
namespace {

// Calibrated together with a friction of 0.31 +- 0.02.
Finger OfFrictionFound() {
  Finger finger = PaperFinger();
  ParameterCovariance covariance;
  covariance.parameters = {{FingerParameterKind::kFrontStiffness},
                           {FingerParameterKind::kFriction}};
  covariance.std = Eigen::Vector2d(100, 0.02);
  covariance.correlations = Eigen::Matrix2d::Identity();
  covariance.correlations(0, 1) = covariance.correlations(1, 0) = 0.4;
  covariance.friction = 0.31;
  finger.calibration = covariance;
  return finger;
}

TEST(KnownFrictionTest, ErrorsGoTogetherInContactsOfItsKind) {
  const Finger finger = OfFrictionFound();
  const ParameterCovariance same = *ForFriction(finger, 0.3).calibration;
  EXPECT_TRUE(IsFrictionOf(*finger.calibration, 0.3));
  EXPECT_EQ(same.friction, 0.3);
  EXPECT_EQ(same.std, finger.calibration->std);
  EXPECT_EQ(same.correlations, finger.calibration->correlations);
  EXPECT_FALSE(IsFrictionOf(*finger.calibration, 0));
  const ParameterCovariance other = *ForFriction(finger, 0).calibration;
  EXPECT_FALSE(other.HasFriction());
  ASSERT_EQ(other.std.size(), 1);
  EXPECT_EQ(other.std[0], 100);
  EXPECT_EQ(other.correlations(0, 0), 1);
}

TEST(KnownFrictionTest, WhatIsKnownWorseIsAnErrorOfItsOwn) {
  const Finger finger = OfFrictionFound();
  const ParameterCovariance worse =
      *ForFriction(finger, {0.3, 0.1}).calibration;
  EXPECT_EQ(worse.std[1], 0.1);
  // Of 0.1, 0.02 goes with the finger.
  EXPECT_NEAR(worse.correlations(1, 0), 0.4 * 0.2, 1e-15);
  EXPECT_NEAR(worse.correlations(0, 1), 0.4 * 0.2, 1e-15);
  // What is known better is not believed.
  EXPECT_EQ(ForFriction(finger, {0.3, 0.01}).calibration->std[1], 0.02);
}

TEST(KnownFrictionTest, OtherObjectsHaveAnErrorOfTheirOwn) {
  const Finger finger = OfFrictionFound();
  const ParameterCovariance other =
      *ForFriction(finger, {0.6, 0.1}).calibration;
  ASSERT_TRUE(other.HasFriction());
  EXPECT_EQ(other.friction, 0.6);
  EXPECT_EQ(other.std, Eigen::VectorXd(Eigen::Vector2d(100, 0.1)));
  EXPECT_EQ(other.correlations(1, 0), 0);
}

TEST(KnownFrictionTest, AFingerWithoutACalibration) {
  EXPECT_FALSE(ForFriction(PaperFinger(), 0.3).calibration.has_value());
  const Finger finger = ForFriction(PaperFinger(), {0.3, 0.1});
  ASSERT_TRUE(finger.calibration.has_value());
  ASSERT_TRUE(finger.calibration->HasFriction());
  EXPECT_EQ(finger.calibration->std[0], 0.1);
  // A file that does not say with which friction it was calibrated.
  ParameterCovariance unknown = *OfFrictionFound().calibration;
  unknown.friction = kNaN;
  EXPECT_FALSE(IsFrictionOf(unknown, 0));
}

}  // namespace
}  // namespace finray
