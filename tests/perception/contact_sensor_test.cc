#include "finray/perception/contact_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "test_finger.h"

namespace finray {
namespace {

Measurements Readings(EquilibriumSolver* solver, const PointContact& contact) {
  EXPECT_TRUE(solver->Solve({contact}));
  Measurements readings;
  for (int j = 0; j < solver->model().gauges(); ++j) {
    readings.gauges_V.push_back(solver->gauge_angle(j));
  }
  return readings;
}

// Compares the scatter of pose and force over draws of noise with the
// covariance.
TEST(ContactSensorTest, CovarianceIsThatOfTheScatter) {
  const Finger finger = PaperFinger();
  Scene scene;
  scene.contacts = 1;
  ContactSensor sensor(finger, scene, {});
  EquilibriumSolver solver(finger, {});
  const Measurements clean = Readings(&solver, {70, 3});
  const Eigen::Vector3d pose = solver.contact_pose(0);
  const SensedFrame exact = sensor.Sense(clean);
  ASSERT_EQ(exact.contacts.size(), 1u);
  EXPECT_LT((exact.contacts[0].pose - pose).norm(), 1e-6);
  const Section there = exact.shape->At(Side::kFront, 70);
  EXPECT_NEAR(there.x_mm, pose.x(), 1e-6);

  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Eigen::Matrix4d scatter = Eigen::Matrix4d::Zero();
  constexpr int kDraws = 600;
  for (int draw = 0; draw < kDraws; ++draw) {
    Measurements noisy = clean;
    for (std::size_t j = 0; j < noisy.gauges_V.size(); ++j) {
      noisy.gauges_V[j] += finger.gauges[j].noise_V * normal(generator);
    }
    const SensedFrame frame = sensor.Sense(noisy);
    ASSERT_EQ(frame.status, FrameStatus::kOk);
    Eigen::Vector4d off;
    off << frame.contacts[0].pose - pose,
        frame.contacts[0].contact.normal_N - 3;
    scatter += off * off.transpose() / kDraws;
  }
  const Eigen::Matrix4d& covariance = exact.contacts[0].covariance;
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(std::sqrt(scatter(k, k) / covariance(k, k)), 1, 0.1) << k;
  }
  EXPECT_NEAR(scatter(1, 3) / covariance(1, 3), 1, 0.25);
}

TEST(ContactSensorTest, GivenEstimatesKeepTheirStd) {
  ContactSensor sensor(PaperFinger(), Scene(), {});
  const Eigen::Vector2d std(0.5, 0.02);
  const Eigen::Matrix2d given = std.cwiseAbs2().asDiagonal();
  const SensedFrame frame = sensor.At({{70, 3}}, given);
  ASSERT_EQ(frame.contacts.size(), 1u);
  const Eigen::Matrix4d& covariance = frame.contacts[0].covariance;
  EXPECT_NEAR(std::sqrt(covariance(3, 3)), 0.02, 1e-12);
  // Along the beam the place moves as far as l_c.
  EXPECT_NEAR(std::sqrt(covariance(1, 1)), 0.5, 0.05);
}

TEST(FingerVariationsTest, SquaresAddUpToTheCovariance) {
  Finger finger = PaperFinger();
  EXPECT_TRUE(FingerVariations(finger, 0.3).empty());
  ParameterCovariance known;
  known.parameters = {{FingerParameterKind::kFrontStiffness, 0},
                      {FingerParameterKind::kRibLength, 2}};
  known.std = Eigen::Vector2d(100, 0.05);
  known.correlations = Eigen::Matrix2d::Identity();
  known.correlations(0, 1) = known.correlations(1, 0) = 0.4;
  finger.calibration = known;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  double friction = 0;
  for (const FingerVariation& moved : FingerVariations(finger, {0.3, 0.1})) {
    const Finger& varied = moved.finger;
    Eigen::Vector2d off(
        varied.front_stiffness_N_mm2 - finger.front_stiffness_N_mm2,
        varied.ribs[2].length_mm - finger.ribs[2].length_mm);
    sum += off * off.transpose();
    friction += moved.friction * moved.friction;
    EXPECT_EQ(varied.ribs[0].length_mm, finger.ribs[0].length_mm);
  }
  EXPECT_NEAR(sum(0, 0), 1e4, 1e-6);
  EXPECT_NEAR(sum(0, 1), 0.4 * 100 * 0.05, 1e-9);
  EXPECT_NEAR(sum(1, 1), 0.0025, 1e-12);
  EXPECT_NEAR(friction, 0.01, 1e-12);
}

}  // namespace
}  // namespace finray
