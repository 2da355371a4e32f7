#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "calib/standard_log.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/report/calibration_result.h"
#include "finray/fit/calibration_errors.h"
#include "finray/scene/clean_readings.h"

namespace finray {
namespace {

// What a calibration makes of `start`, its covariance included.
Finger CalibrateOn(const Finger& start, const Plan& plan,
                   const std::string& log, double* chi2_per_dof = nullptr) {
  CalibrationProblem problem(start, plan,
                             ReadCalibrationLogs({log}, start, plan), {}, 2);
  const CalibrationSolution solution = SolveOnce(&problem);
  EXPECT_TRUE(solution.solve.converged);
  const Identifiability found = AnalyzeIdentifiability(&problem, solution.at);
  Finger finger = problem.parameters().Apply(start);
  KeepCovariance(problem.parameters(), found, &finger);
  double chi2 = 0, dof = 0;
  for (const Identifiability::Noise& noise : found.noise) {
    chi2 += noise.chi2;
    dof += noise.dof;
  }
  if (chi2_per_dof != nullptr) *chi2_per_dof = chi2 / dof;
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
  const CalibrationResult result = Calibrate(&problem);
  const Finger finger =
      ReadFinger(folder.Write("finger.yaml", FingerToYaml(result.finger)));
  const YAML::Node yaml =
      YAML::Load(CalibrationYaml(problem, result, {log, log, "taylor", 0, ""}));
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

TEST(FingerCovarianceTest, SaysWithWhichFrictionItWasCalibrated) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 11);
  Plan plan = StandardPlan();
  plan.scene.friction_coefficient = 0.1;
  const Finger finger = CalibrateOn(Nominal(), plan, log);
  EXPECT_FALSE(finger.calibration->HasFriction());
  EXPECT_EQ(finger.calibration->friction, 0.1);
  const Finger back = ReadFinger(folder.Write("f.yaml", FingerToYaml(finger)));
  EXPECT_EQ(back.calibration->friction, 0.1);
  // Free frames say nothing of it.
  FrameTable free(20);
  free.MutableNumbers("object_x_mm").assign(20, -25);
  free.MutableNumbers("object_y_mm").assign(20, 60);
  Simulate(HiddenFinger(), StandardScene(), {}, &free);
  const std::string rows = folder.Path("free.csv");
  MakeLog(HiddenFinger(), free, {0.02, 0.05, 11}).Write(rows);
  Plan offsets;
  offsets.scene.friction_coefficient = 0.2;
  offsets.families[static_cast<int>(ParameterFamily::kGaugeOffset)].free = true;
  EXPECT_EQ(CalibrateOn(finger, offsets, rows).calibration->friction, 0.1);
  EXPECT_TRUE(
      std::isnan(CalibrateOn(Nominal(), offsets, rows).calibration->friction));
}

// A plan that frees the offsets alone leaves the std of all else.
TEST(FingerCovarianceTest, FixedParametersKeepTheirStd) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 11);
  const Finger whole = CalibrateOn(Nominal(), StandardPlan(), log);
  Plan plan;
  plan.scene = StandardScene();
  plan.families[static_cast<int>(ParameterFamily::kGaugeOffset)].free = true;
  const Finger zeroed = CalibrateOn(whole, plan, log);
  const ParameterCovariance& before = whole.calibration.value();
  const ParameterCovariance& after = zeroed.calibration.value();
  ASSERT_EQ(after.parameters, before.parameters);
  for (std::size_t k = 0; k < after.parameters.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    if (after.parameters[k].kind == FingerParameterKind::kGaugeOffset) {
      EXPECT_LT(after.std[at], before.std[at]);
    } else {
      EXPECT_EQ(after.std[at], before.std[at]);
    }
  }
  EXPECT_EQ(after.correlations(1, 0), before.correlations(1, 0));
}

TEST(FingerCovarianceTest, ALaterCalibrationReplacesIt) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 12);
  const Finger first = CalibrateOn(Nominal(), StandardPlan(), log);
  ASSERT_EQ(first.calibration->parameters.size(), 15u);
  Plan offsets;
  offsets.scene = StandardPlan().scene;
  offsets.families[static_cast<int>(ParameterFamily::kGaugeOffset)].free = true;
  const Finger second = CalibrateOn(first, offsets, log);
  ASSERT_EQ(second.calibration->parameters.size(), 15u);
  EXPECT_LT(second.calibration->std[9], first.calibration->std[9]);
  // Nothing of the finger was looked for: what was known still holds.
  Plan origin;
  origin.scene = StandardPlan().scene;
  origin.families[static_cast<int>(ParameterFamily::kObjectOrigin)].free = true;
  EXPECT_EQ(CalibrateOn(first, origin, log).calibration->std,
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
      FingerToYaml(CalibrateOn(Nominal(), plan, folder.Path("blind.csv")))));
  EquilibriumSolver solver(finger, {});
  CalibrationErrors errors(finger, Scene::OfGauges(0), {});
  ASSERT_TRUE(solver.Solve({{71, 3, 0}}));
  const ContactMatrix found = errors.Of({{71, 3, 0}}, CleanReadings(solver));
  std::printf("without a force sensor: std %.3g mm, %.3g N of 3 N\n",
              std::sqrt(found(0, 0)), std::sqrt(found(1, 1)));
  EXPECT_LT(std::sqrt(found(0, 0)), 1);
  EXPECT_GT(std::sqrt(found(1, 1)), 300);
}

// Calibrations with noise, then means of 50 noisy frames of the true finger
// under a large force: what is left of the frames' noise counts less than the
// calibration's errors, which no mean reduces.
void CheckMeans(unsigned calibrations, double tolerance) {
  Scene scene;
  scene.contacts = 1;
  constexpr double kForce_N = 9;
  constexpr int kFrames = 50;
  std::mt19937_64 generator(31);
  std::normal_distribution<double> normal;
  EquilibriumSolver truth(HiddenFinger(), {});
  Eigen::Array2d square = {0, 0}, of_noise = {0, 0}, covered = {0, 0};
  int all = 0;
  unsigned wrong = 0;
  for (unsigned seed = 101; seed <= 100 + calibrations; ++seed) {
    const TempFolder folder;
    double chi2_per_dof = 0;
    const Finger finger =
        CalibrateOn(Nominal(), StandardPlan(),
                    StandardLog(folder, HiddenFinger(), seed), &chi2_per_dof);
    // A wrong minimum, which calibration.yaml warns of.
    if (chi2_per_dof > 2) {
      ++wrong;
      continue;
    }
    Finger known = finger;
    known.calibration.reset();  // its std are those of noise alone
    FrameEstimator estimator(known, scene, {});
    // Six contacts are not worth a surface.
    CalibrationErrors errors(finger, scene, {},
                             CalibrationErrors::Surface::kNone);
    for (const double arc_mm : {25, 40, 55, 70, 85, 100}) {
      ASSERT_TRUE(truth.Solve({{arc_mm, kForce_N, 0}}));
      const Measurements clean = CleanReadings(truth);
      Eigen::Array2d mean(0, 0), noise(0, 0);
      for (int i = 0; i < kFrames; ++i) {
        Measurements readings = clean;
        for (std::size_t j = 0; j < readings.gauges_V.size(); ++j) {
          readings.gauges_V[j] += finger.gauges[j].noise_V * normal(generator);
        }
        const ContactEstimate found = estimator.Estimate(readings).contact[0];
        mean += Eigen::Array2d(found.arc_mm, found.normal_N) / kFrames;
        // Of the mean of all frames.
        noise += Eigen::Array2d(found.arc_std_mm, found.normal_std_N).square() /
                 (kFrames * kFrames);
      }
      const ContactMatrix system = errors.Of({{mean[0], mean[1], 0}}, clean);
      const Eigen::Array2d error2 =
          (mean - Eigen::Array2d(arc_mm, kForce_N)).square();
      const Eigen::Array2d variance =
          noise + Eigen::Array2d(system(0, 0), system(1, 1));
      ++all;
      square += error2 / variance;
      of_noise += error2 / noise;
      covered += (error2 < 1.96 * 1.96 * variance).cast<double>();
    }
  }
  EXPECT_LE(wrong, calibrations / 100);
  for (int k = 0; k < 2; ++k) {
    std::printf(
        "%s, means of %d frames at %d places: squared error over variance %.2f "
        "(over that of noise alone %.1f), within 1.96 std %.1f %%\n",
        k == 0 ? "l_c" : "f_c", kFrames, all, square[k] / all,
        of_noise[k] / all, 100 * covered[k] / all);
    EXPECT_NEAR(square[k] / all, 1, tolerance);
    EXPECT_GT(covered[k], 0.89 * all);
    EXPECT_GT(of_noise[k] / all, 2);
  }
}

// The six places of a calibration share its errors: as with one error of two
// components a calibration, the mean of a square is known to 1 / sqrt(n).
TEST(FingerCovarianceTest, MeansOfEstimatesAreOffByWhatItSays) {
  CheckMeans(12, 0.5);
}
TEST(FingerCovarianceTest, SlowMeansOfEstimatesAreOffByWhatItSays) {
  CheckMeans(150, 0.15);
}

}  // namespace
}  // namespace finray
