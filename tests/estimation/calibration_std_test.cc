// The std of estimates on fingers that are known with errors, against estimates
// of fingers that have these errors.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "estimation/gauge_volts.h"
#include "estimation/uncertain_finger.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/fit/calibration_errors.h"
#include "finray/scene/clean_readings.h"
#include "test_finger.h"

namespace finray {
namespace {

// They widen std, explain what noise does not, and move nothing.
TEST(CalibrationStdTest, ModelErrorsNeverMoveAnEstimate) {
  Finger discrepant = UncertainFinger();
  discrepant.calibration->discrepancy = TypicalDiscrepancy(4);
  Finger plain = discrepant;
  plain.calibration.reset();
  Scene scene;
  scene.contacts = 1;
  FrameEstimator without(plain, scene, {}), with(discrepant, scene, {});
  EquilibriumSolver solver(plain, {});
  ASSERT_TRUE(solver.Solve({{70, 5, 0}}));
  Measurements row;
  row.gauges_V = Volts(solver);
  row.gauges_V[0] += 2e-3 * plain.gauges[0].gain_V_per_rad;
  const FrameEstimate a = without.Estimate(row), b = with.Estimate(row);
  EXPECT_LT(a.p_value(), FrameEstimate::kUnexplained);
  EXPECT_GT(b.p_value(), 0.05);
  EXPECT_EQ(a.contact[0].arc_mm, b.contact[0].arc_mm);
  EXPECT_EQ(a.contact[0].normal_N, b.contact[0].normal_N);
  EXPECT_EQ(a.chi2, b.chi2);
  EXPECT_EQ(b.noise_scale(), 1);
  EXPECT_GT(a.noise_scale(), 2);
}

// Fingers are drawn from the covariance; their noise-free volts are read with
// the nominal finger.
TEST(CalibrationStdTest, EstimatesOfWrongFingersSpreadAsItSays) {
  Finger nominal = UncertainFinger();
  // The errors are small, so that contacts move in proportion to them.
  nominal.calibration->std *= 0.4;
  const Eigen::MatrixXd factor = nominal.calibration->Factor();
  for (const double friction : {0.0, 0.3}) {
    Scene scene;
    scene.contacts = 1;
    scene.friction_coefficient = friction;
    FrameEstimator estimator(nominal, scene, {});
    EquilibriumSolver solver(nominal, {});
    CalibrationErrors errors(nominal, scene, {});
    std::mt19937_64 generator(21);
    std::normal_distribution<double> normal;
    for (const auto& [arc_mm, normal_N] :
         {std::pair{30.0, 8.0}, {55.0, 2.0}, {75.0, 5.0}, {100.0, 4.0}}) {
      const std::vector<PointContact> truth = {{arc_mm, normal_N, friction}};
      ASSERT_TRUE(solver.Solve(truth));
      const ContactMatrix predicted = errors.Of(truth, CleanReadings(solver));
      Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
      constexpr int kDraws = 800;
      for (int i = 0; i < kDraws; ++i) {
        const Eigen::VectorXd change =
            factor * Eigen::VectorXd::NullaryExpr(
                         factor.cols(), [&] { return normal(generator); });
        Finger finger = nominal;
        for (Eigen::Index k = 0; k < change.size(); ++k) {
          const FingerParameter& p = nominal.calibration->parameters[k];
          SetParameter(p, ParameterValue(nominal, p) + change[k], &finger);
        }
        EquilibriumSolver other(finger, {});
        ASSERT_TRUE(other.Solve(truth));
        Measurements readings;
        readings.gauges_V = Volts(other);
        const FrameEstimate estimate = estimator.Estimate(readings);
        const Eigen::Vector2d error(estimate.contact[0].arc_mm - arc_mm,
                                    estimate.contact[0].normal_N - normal_N);
        spread += error * error.transpose() / kDraws;
      }
      const double arc = std::sqrt(spread(0, 0) / predicted(0, 0));
      const double force = std::sqrt(spread(1, 1) / predicted(1, 1));
      std::printf(
          "%.0f mm, %.0f N, mu %.1f: std %.3f mm, %.4f N; spread over "
          "it %.3f, %.3f\n",
          arc_mm, normal_N, friction, std::sqrt(predicted(0, 0)),
          std::sqrt(predicted(1, 1)), arc, force);
      // The spread of 800 draws is known to 2.5 %.
      EXPECT_NEAR(arc, 1, 0.1);
      EXPECT_NEAR(force, 1, 0.1);
      EXPECT_NEAR(
          spread(0, 1) / std::sqrt(spread(0, 0) * spread(1, 1)),
          predicted(0, 1) / std::sqrt(predicted(0, 0) * predicted(1, 1)), 0.1);
    }
  }
}

// The move of a noise-free estimate with the scene's friction, by the true one.
Eigen::VectorXd MoveByFriction(const Finger& finger, const Scene& scene,
                               FrameMethod method,
                               std::vector<PointContact> contacts) {
  constexpr double kStep = 0.01;
  FrameEstimator estimator(finger, scene, {}, method);
  EquilibriumSolver solver(finger, {});
  std::vector<Eigen::VectorXd> found;
  for (const double step : {-kStep, kStep}) {
    for (PointContact& contact : contacts) {
      contact.friction = scene.friction_coefficient + step;
    }
    EXPECT_TRUE(solver.Solve(contacts));
    Measurements readings;
    readings.gauges_V = Volts(solver);
    const FrameEstimate estimate = estimator.Estimate(readings);
    EXPECT_EQ(estimate.contacts, static_cast<int>(contacts.size()));
    Eigen::VectorXd x(2 * estimate.contacts);
    for (int c = 0; c < estimate.contacts; ++c) {
      x[2 * c] = estimate.contact[c].arc_mm;
      x[2 * c + 1] = estimate.contact[c].normal_N;
    }
    found.push_back(x);
  }
  return (found[1] - found[0]) / (2 * kStep);
}

TEST(CalibrationStdTest, FrictionOfASceneIsOneMoreParameter) {
  constexpr double kStd = 0.1;
  Finger calibrated = PaperFinger();
  calibrated.calibration = TypicalCovariance(calibrated);
  for (const Finger& finger : {PaperFinger(), calibrated}) {
    for (const auto& [method, friction] : {std::pair{FrameMethod::kFast, 0.0},
                                           {FrameMethod::kFast, 0.3},
                                           {FrameMethod::kCeresReduced, 0.3}}) {
      for (const auto& contacts : std::vector<std::vector<PointContact>>{
               {{70, 4, friction}}, {{45, 4, friction}, {105, 3, friction}}}) {
        Scene scene;
        scene.contacts = static_cast<int>(contacts.size());
        scene.friction_coefficient = friction;
        const Eigen::VectorXd moved =
            kStd * MoveByFriction(finger, scene, method, contacts);
        EquilibriumSolver solver(finger, {});
        ASSERT_TRUE(solver.Solve(contacts));
        Measurements readings;
        readings.gauges_V = Volts(solver);
        const auto covariance = [&] {
          FrameEstimator estimator(finger, scene, {}, method);
          const FrameEstimate estimate = estimator.Estimate(readings);
          return estimate.calibration_covariance.size() > 0
                     ? Eigen::MatrixXd(estimate.calibration_covariance)
                     : Eigen::MatrixXd(
                           Eigen::MatrixXd::Zero(moved.size(), moved.size()));
        };
        const Eigen::MatrixXd without = covariance();
        scene.friction_std = kStd;
        const Eigen::MatrixXd with = covariance();
        for (Eigen::Index i = 0; i < moved.size(); ++i) {
          EXPECT_NEAR(std::sqrt(with(i, i) - without(i, i)), std::abs(moved[i]),
                      0.05 * std::abs(moved[i]) + 1e-4)
              << "mu " << friction << ", unknown " << i;
        }
      }
    }
  }
}

// A row whose friction the object's motion tells has the std of a scene with
// that friction.
TEST(CalibrationStdTest, ASlidingRowHasTheStdOfItsFriction) {
  Finger finger = PaperFinger();
  finger.calibration = TypicalCovariance(finger);
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({{70, 4, 0.1}}));
  Measurements row = CleanReadings(solver);
  Scene scene;
  scene.contacts = 1;
  scene.friction_coefficient = 0.1;
  const FrameEstimate expected = FrameEstimator(finger, scene).Estimate(row);
  row.friction = 0.1;
  scene.friction_coefficient = 0.3;
  FrameEstimator estimator(finger, scene);
  const FrameEstimate found = estimator.Estimate(row);
  row.friction = 0.3;
  const FrameEstimate other = estimator.Estimate(row);
  for (int k = 0; k < 2; ++k) {
    const double std = std::sqrt(expected.calibration_covariance(k, k));
    EXPECT_NEAR(std::sqrt(found.calibration_covariance(k, k)), std, 1e-3 * std);
  }
  EXPECT_NEAR(found.force_std_N, expected.force_std_N,
              1e-3 * expected.force_std_N);
  // The friction matters.
  EXPECT_GT(std::abs(other.force_std_N - expected.force_std_N),
            1e-2 * expected.force_std_N);
}

// Noise and one friction a log: the intervals hold as often as they say.
TEST(CalibrationStdTest, IntervalsHoldWhereFrictionIsUncertain) {
  const Finger finger = PaperFinger();
  constexpr int kLogs = 300, kFrames = 5;
  double within[2][2][2] = {};  // without, with; place, force; 68, 95 %
  int frames = 0;
  Scene scene;
  scene.contacts = 1;
  scene.friction_coefficient = 0.3;
  FrameEstimator plain(finger, scene, {});
  scene.friction_std = 0.1;
  FrameEstimator told(finger, scene, {});
  EquilibriumSolver solver(finger, {});
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  for (int log = 0; log < kLogs; ++log) {
    const double friction = 0.3 + 0.1 * normal(generator);
    for (int i = 0; i < kFrames; ++i) {
      const PointContact truth{35 + 70 * uniform(generator),
                               1 + 7 * uniform(generator), friction};
      solver.Reset();
      ASSERT_TRUE(solver.Solve({truth}));
      Measurements readings;
      readings.gauges_V = Volts(solver);
      for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
        readings.gauges_V[j] += finger.gauges[j].noise_V * normal(generator);
      }
      ++frames;
      int which = 0;
      for (FrameEstimator* estimator : {&plain, &told}) {
        const ContactEstimate found = estimator->Estimate(readings).contact[0];
        const double z[] = {
            std::abs(found.arc_mm - truth.arc_mm) / found.arc_std_mm,
            std::abs(found.normal_N - truth.normal_N) / found.normal_std_N};
        for (int k = 0; k < 2; ++k) {
          within[which][k][0] += z[k] < 1;
          within[which][k][1] += z[k] < 1.96;
        }
        ++which;
      }
    }
  }
  for (int which = 0; which < 2; ++which) {
    for (int k = 0; k < 2; ++k) {
      double* of = within[which][k];
      for (int level : {0, 1}) of[level] *= 100.0 / frames;
      std::printf(
          "%s friction_std, %s: %.1f and %.1f %% within 1 and 1.96 std\n",
          which == 0 ? "without" : "with   ", k == 0 ? "place" : "force", of[0],
          of[1]);
    }
  }
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(within[1][k][0], 68.3, 5) << k;
    EXPECT_NEAR(within[1][k][1], 95, 2.5) << k;
  }
  EXPECT_LT(within[0][1][0], 60);
}

}  // namespace
}  // namespace finray
