#include "finray/estimation/frame_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimation/gauge_volts.h"
#include "estimation/uncertain_finger.h"
#include "finray/estimation/chi_squared.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/scene/simulation.h"
#include "studies/coverage.h"

namespace finray {
namespace {

// The reference force of a simulated frame of two contacts.
TEST(FrameEstimateTest, IsWhatASensorUnderTheFingerMeasures) {
  Scene scene;
  scene.friction_coefficient = 0.3;
  FrameTable frames(1);
  const double arc[] = {40, 110}, normal[] = {3, 2};
  for (int c = 0; c < 2; ++c) {
    const std::string index = std::to_string(c + 1);
    frames.MutableNumbers("contact_" + index + "_mm")[0] = arc[c];
    frames.MutableNumbers("normal_" + index + "_N")[0] = normal[c];
  }
  Simulate(PaperFinger(), scene, {}, &frames);
  FrameEstimate estimate;
  estimate.contacts = 2;
  for (int c = 0; c < 2; ++c) {
    estimate.contact[c].arc_mm = arc[c];
    estimate.contact[c].normal_N = normal[c];
    estimate.contact[c].pose.z() =
        frames.Numbers("contact_" + std::to_string(c + 1) + "_angle_rad")[0];
  }
  const double force = EstimatedForce(estimate, 0.3);
  EXPECT_NEAR(force, frames.Numbers("force_N")[0], 1e-12);
  EXPECT_LT(force, 5 * std::hypot(1, 0.3) - 1e-3);  // they are not parallel

  estimate.contacts = 1;
  EXPECT_NEAR(EstimatedForce(estimate, 0.3), 3 * std::hypot(1, 0.3), 1e-14);
  EXPECT_TRUE(std::isnan(EstimatedForce(FrameEstimate(), 0.3)));
}

// Two contacts on their bounds leave a chi2 although there is no freedom left.
TEST(FrameEstimateTest, AChi2WithoutFreedomIsUnexplained) {
  FrameEstimate estimate;
  estimate.contacts = 2;
  estimate.dof = 0;
  estimate.chi2 = 1e-9;
  EXPECT_FALSE(estimate.IsUnexplained());
  estimate.chi2 = 2e6;
  EXPECT_TRUE(estimate.IsUnexplained());
  EXPECT_EQ(estimate.noise_scale(), 1);
  estimate.dof = 2;
  estimate.chi2 = 5;
  EXPECT_FALSE(estimate.IsUnexplained());
}

// The mean of many frames with one calibration is as exact as the two parts of
// the std say. The plant has other elements than the estimator.
TEST(FrameEstimateTest, NoiseIsWhatAveragingReduces) {
  Finger finger = PaperFingerWithNoise(3e-4);
  finger.calibration = TypicalCovariance(finger);
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(finger, scene);
  EquilibriumSolver plant(finger, {Scheme::kTaylor12, 96});
  ASSERT_TRUE(plant.Solve({{70, 2, 0}}));
  const std::vector<double> clean = Volts(plant);
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal(0, 3e-4);
  constexpr int kFrames = 1000;
  double squares[2] = {}, noise[2] = {};
  for (int i = 0; i < kFrames; ++i) {
    Measurements row;
    for (const double volts : clean) {
      row.gauges_V.push_back(volts + normal(generator));
    }
    const FrameEstimate estimate = estimator.Next(row);
    ASSERT_EQ(estimate.contacts, 1);
    const ContactEstimate& contact = estimate.contact[0];
    squares[0] += std::pow(contact.arc_mm - 70, 2) / kFrames;
    squares[1] += std::pow(contact.normal_N - 2, 2) / kFrames;
    noise[0] += std::pow(contact.arc_noise_mm, 2) / kFrames;
    noise[1] += std::pow(contact.normal_noise_N, 2) / kFrames;
    if (estimate.noise_scale() > 1) continue;
    const auto& shared = estimate.calibration_covariance;
    EXPECT_NEAR(std::hypot(contact.arc_noise_mm, std::sqrt(shared(0, 0))),
                contact.arc_std_mm, 1e-12);
    EXPECT_NEAR(std::hypot(contact.normal_noise_N, std::sqrt(shared(1, 1))),
                contact.normal_std_N, 1e-12);
    EXPECT_LT(contact.normal_noise_N, 0.9 * contact.normal_std_N);
  }
  for (const int k : {0, 1}) {
    EXPECT_NEAR(std::sqrt(squares[k] / noise[k]), 1, 0.07) << k;
  }
}

// After a calibration by light loads the offsets are off by more than the noise
// of a reading. Noise alone then explains few frames of a clean log.
TEST(FrameEstimateTest, ErrorsOfTheCalibrationExplainAFrame) {
  Finger finger = PaperFingerWithNoise(1e-4);
  finger.calibration = TypicalCovariance(finger);
  const Eigen::MatrixXd factor = finger.calibration->Factor();
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(finger, scene);
  std::mt19937_64 generator(6);
  std::normal_distribution<double> normal;
  int frames = 0, by_noise = 0, unexplained = 0;
  for (int fingers = 0; fingers < 60; ++fingers) {
    const Eigen::VectorXd error =
        factor * Eigen::VectorXd::NullaryExpr(
                     factor.cols(), [&] { return normal(generator); });
    Finger true_finger = finger;
    for (Eigen::Index i = 0; i < error.size(); ++i) {
      const FingerParameter& p = finger.calibration->parameters[i];
      SetParameter(p, ParameterValue(finger, p) + error[i], &true_finger);
    }
    EquilibriumSolver plant(true_finger, {Scheme::kTaylor12, 96});
    for (const double arc : {45., 60., 75., 90.}) {
      ASSERT_TRUE(plant.Solve({{arc, 3, 0}}));
      Measurements row;
      for (const double volts : Volts(plant)) {
        row.gauges_V.push_back(volts + 1e-4 * normal(generator));
      }
      for (const bool live : {false, true}) {
        const FrameEstimate estimate =
            live ? estimator.Next(row) : estimator.Estimate(row);
        ++frames;
        by_noise += ChiSquaredTail(estimate.chi2, estimate.dof) < 0.001;
        unexplained += estimate.IsUnexplained();
      }
    }
  }
  EXPECT_GT(by_noise, 0.2 * frames);
  EXPECT_LE(unexplained, 0.005 * frames);
}

}  // namespace
}  // namespace finray
