#include "finray/calib/finger_covariance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "calib/standard_log.h"
#include "finray/calib/calibration_result.h"
#include "finray/sensing/calibration_uncertainty.h"
#include "sensing/gauge_volts.h"

namespace finray {
namespace {

// What a calibration makes of `start`, its covariance included.
Finger Calibrated(const Finger& start, const Plan& plan,
                  const std::string& log) {
  CalibrationProblem problem(start, plan,
                             ReadCalibrationLogs({log}, start, plan), {}, 2);
  EXPECT_TRUE(problem.Solve().converged);
  Finger finger = problem.parameters().Apply(start);
  KeepCovariance(problem.parameters(), AnalyzeIdentifiability(&problem),
                 &finger);
  return finger;
}

TEST(FingerCovarianceTest, BlockSaysWhatCalibrationYamlSays) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 11);
  Plan plan = StandardPlan();
  // The origin is not the finger's, but widens what is.
  FamilyPlan& origin =
      plan.families[static_cast<int>(ParameterFamily::kObjectOrigin)];
  origin.free = true;
  origin.prior_std = 0.3;
  CalibrationProblem problem(
      Nominal(), plan, ReadCalibrationLogs({log}, Nominal(), plan), {}, 2);
  const CalibrationResult result = Calibrate(&problem, {}, 2);
  const Finger finger =
      ReadFinger(folder.Write("finger.yaml", FingerToYaml(result.finger)));
  const YAML::Node yaml = YAML::Load(
      CalibrationYaml(problem, result, {log, log, {log}, "taylor", 0, ""}));
  ASSERT_EQ(yaml["parameters"].size(), 17u);
  const ParameterCovariance& block = finger.calibration.value();
  ASSERT_EQ(block.parameters, ParametersOf(finger));
  const YAML::Node matrix = yaml["correlations"]["matrix"];
  for (int i = 0; i < 15; ++i) {
    const YAML::Node parameter = yaml["parameters"][i];
    EXPECT_EQ(parameter["name"].as<std::string>(),
              ParameterName(block.parameters[i]));
    EXPECT_EQ(parameter["value"].as<double>(),
              ParameterValue(finger, block.parameters[i]));
    EXPECT_EQ(parameter["std"].as<double>(), block.std[i]);
    for (int j = 0; j < 15; ++j) {
      EXPECT_NEAR(matrix[i][j].as<double>(), block.correlations(i, j), 1e-6);
    }
  }
  // 0.8 % of stiffness, in N mm^2.
  EXPECT_NEAR(block.std[0] / 11000, 0.008, 0.003);
}

TEST(FingerCovarianceTest, ALaterCalibrationReplacesIt) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 12);
  const Finger first = Calibrated(Nominal(), StandardPlan(), log);
  ASSERT_EQ(first.calibration->parameters.size(), 15u);
  Plan offsets;
  offsets.scene = StandardPlan().scene;
  offsets.families[static_cast<int>(ParameterFamily::kGaugeOffset)].free = true;
  const Finger second = Calibrated(first, offsets, log);
  ASSERT_EQ(second.calibration->parameters.size(), 4u);
  EXPECT_EQ(ParameterName(second.calibration->parameters[3]),
            "gauge_4_offset_V");
  // All but the offsets counts as known now.
  EXPECT_LT(second.calibration->std[3], first.calibration->std[9]);
  // Nothing of the finger was looked for: what was known still holds.
  Plan origin;
  origin.scene = StandardPlan().scene;
  origin.families[static_cast<int>(ParameterFamily::kObjectOrigin)].free = true;
  EXPECT_EQ(Calibrated(first, origin, log).calibration->std,
            first.calibration->std);
}

TEST(FingerCovarianceTest, WithoutAForceSensorForcesAreUnknownPlacesAreNot) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 5));
  log.MutableNumbers("force_N").assign(210, std::nan(""));
  log.Write(folder.Path("blind.csv"));
  Plan plan = StandardPlan();
  for (FamilyPlan& family : plan.families) family.prior_std.reset();
  const Finger finger = ReadFinger(folder.Write(
      "finger.yaml",
      FingerToYaml(Calibrated(Nominal(), plan, folder.Path("blind.csv")))));
  EquilibriumSolver solver(finger, {});
  CalibrationUncertainty uncertainty(finger, 0, &solver);
  ASSERT_TRUE(solver.Solve({{71, 3, 0}}));
  const ContactMatrix found =
      uncertainty.Of({{71, 3, 0}}, Volts(solver), Weights(finger));
  std::printf("without a force sensor: std %.3g mm, %.3g N of 3 N\n",
              std::sqrt(found(0, 0)), std::sqrt(found(1, 1)));
  EXPECT_LT(std::sqrt(found(0, 0)), 1);
  EXPECT_GT(std::sqrt(found(1, 1)), 300);
}

// Calibrations with noise, and noisy frames of the true finger under forces so
// large that the calibration's errors count for more than the frame's noise.
TEST(FingerCovarianceTest, EstimatesAreOffByWhatItSays) {
  Scene scene;
  scene.contacts = 1;
  constexpr double kForce_N = 9;
  const double places_mm[] = {25, 40, 55, 70, 85, 100};
  std::mt19937_64 generator(31);
  std::normal_distribution<double> normal;
  EquilibriumSolver truth(HiddenFinger(), {});
  double square[2] = {}, of_noise[2] = {};
  int covered[2] = {}, all = 0;
  for (unsigned seed = 101; seed <= 120; ++seed) {
    const TempFolder folder;
    const Finger finger = Calibrated(Nominal(), StandardPlan(),
                                     StandardLog(folder, HiddenFinger(), seed));
    FrameEstimator estimator(finger, scene, {});
    EquilibriumSolver solver(finger, {});
    CalibrationUncertainty uncertainty(finger, 0, &solver);
    for (const double arc_mm : places_mm) {
      ASSERT_TRUE(truth.Solve({{arc_mm, kForce_N, 0}}));
      FrameReadings readings;
      readings.gauges_V = Volts(truth);
      for (std::size_t j = 0; j < readings.gauges_V.size(); ++j) {
        readings.gauges_V[j] += finger.gauges[j].noise_V * normal(generator);
      }
      const FrameEstimate estimate = estimator.Estimate(readings);
      ASSERT_EQ(estimate.contacts, 1);
      const ContactEstimate& contact = estimate.contact[0];
      const ContactMatrix system =
          uncertainty.Of({{contact.arc_mm, contact.normal_N, 0}},
                         readings.gauges_V, Weights(finger));
      const double error[] = {contact.arc_mm - arc_mm,
                              contact.normal_N - kForce_N};
      const double noise[] = {contact.arc_std_mm, contact.normal_std_N};
      ++all;
      for (int k = 0; k < 2; ++k) {
        const double variance = noise[k] * noise[k] + system(k, k);
        square[k] += error[k] * error[k] / variance;
        of_noise[k] += error[k] * error[k] / (noise[k] * noise[k]);
        covered[k] += std::abs(error[k]) < 1.96 * std::sqrt(variance);
      }
    }
  }
  const char* names[] = {"l_c", "f_c"};
  for (int k = 0; k < 2; ++k) {
    std::printf(
        "%s of %d estimates: mean square error over variance %.2f (over that "
        "of noise alone %.2f), within 1.96 std %.1f %%\n",
        names[k], all, square[k] / all, of_noise[k] / all,
        100.0 * covered[k] / all);
    // 20 calibrations, each with errors that its six places share.
    EXPECT_NEAR(square[k] / all, 1, 0.4);
    EXPECT_GT(covered[k], 0.89 * all);
  }
  // Of the force, noise is the smaller part.
  EXPECT_GT(of_noise[1] / all, 2);
}

}  // namespace
}  // namespace finray
