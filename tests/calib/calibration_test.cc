#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "calib/standard_log.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

std::vector<double> Truth(const Finger& finger) {
  std::vector<double> truth = {std::log(finger.front_stiffness_N_mm2),
                               std::log(finger.back_stiffness_N_mm2)};
  for (const Gauge& gauge : finger.gauges) {
    truth.push_back(gauge.gain_V_per_rad);
  }
  for (const Gauge& gauge : finger.gauges) truth.push_back(gauge.offset_V);
  for (const Rib& rib : finger.ribs) truth.push_back(rib.length_mm);
  return truth;
}

constexpr char kBeyond[] = "forces_beyond_limit";

std::vector<std::string> Codes(const CalibrationResult& result) {
  std::vector<std::string> codes;
  for (const Warning& warning : result.warnings) codes.push_back(warning.code);
  return codes;
}

TEST(CalibrationTest, StandardLogIsWithinItsStd) {
  const std::vector<double> truth = Truth(HiddenFinger());
  for (const unsigned seed : {1u, 2u, 3u}) {
    const TempFolder folder;
    const std::string log = StandardLog(folder, HiddenFinger(), seed);
    const Plan plan = StandardPlan();
    CalibrationProblem problem(
        Nominal(), plan, ReadCalibrationLogs({log}, Nominal(), plan), {}, 2);
    const CalibrationResult result = Calibrate(&problem);
    EXPECT_TRUE(result.solution.solve.converged);
    EXPECT_TRUE(result.AllIdentified());
    const CalibrationParameters& parameters = problem.parameters();
    ASSERT_EQ(parameters.free().size(), 15u);
    for (int i = 0; i < 15; ++i) {
      const CalibrationParameter& p = parameters.FreeParameter(i);
      const double std = result.identifiability.std[i];
      EXPECT_LT(std::abs(*p.variable - truth[i]), 4 * std) << p.name;
      EXPECT_EQ(result.identifiability.status[i], ParameterStatus::kEstimated);
      if (i < 2) {
        EXPECT_GT(std, 0.004);
        EXPECT_LT(std, 0.013);
      } else if (i < 6) {
        EXPECT_LT(std / truth[i], 0.005) << p.name;
        EXPECT_GT(std / truth[i], 0.0015) << p.name;
      } else if (i >= 10) {
        EXPECT_GT(std, 0.015) << p.name;
        EXPECT_LT(std, 0.045) << p.name;
      }
    }
    const auto& stds = result.identifiability.std;
    std::printf(
        "seed %u: std of stiffness %.2f and %.2f %%, gain 1 %.2f %%, rib 3 "
        "%.3f mm; force %.3f N rms\n",
        seed, 100 * stds[0], 100 * stds[1], 100 * stds[2] / truth[2], stds[12],
        result.forces.fitted.force_after_N().rms());
    double chi2 = 0, dof = 0;
    for (const auto& noise : result.identifiability.noise) {
      chi2 += noise.chi2;
      dof += noise.dof;
    }
    EXPECT_NEAR(chi2 / dof, 1, 0.15);
    EXPECT_LT(result.forces.fitted.force_after_N().rms(), 0.15);
  }
}

// Who waits for minutes reads which step the solver is at.
TEST(CalibrationTest, TellsItsSteps) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 4);
  const Plan plan = StandardPlan();
  CalibrationProblem problem(
      Nominal(), plan, ReadCalibrationLogs({log}, Nominal(), plan), {}, 1);
  std::vector<std::string> steps;
  problem.TellProgress([&](const std::string& step) { steps.push_back(step); });
  Calibrate(&problem);
  using testing::Contains;
  const std::string first =
      std::to_string(StartFrames(problem).size()) + " frames, iteration 1";
  EXPECT_THAT(steps, Contains(first));
  EXPECT_THAT(steps, Contains("start 'a third as stiff', " + first));
  EXPECT_THAT(steps, Contains("210 frames, outliers"));
  EXPECT_EQ(steps.back(), "check of forces and contacts");
}

TEST(CalibrationTest, StartsFarAwayAndArrives) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 4);
  const Plan plan = StandardPlan();
  std::vector<double> found[2];
  for (const bool far : {false, true}) {
    Finger start = Nominal();
    Plan free = plan;
    for (int i = 0; i < 5; ++i) free.families[i].prior_std.reset();
    if (far) {
      start.front_stiffness_N_mm2 *= 2;
      start.back_stiffness_N_mm2 *= 2;
      for (Gauge& gauge : start.gauges) gauge.gain_V_per_rad *= 3;
    }
    CalibrationProblem problem(start, free,
                               ReadCalibrationLogs({log}, start, free), {}, 2);
    EXPECT_TRUE(SolveOnce(&problem).solve.converged);
    for (const int i : problem.parameters().free()) {
      found[far].push_back(*problem.parameters().all()[i].variable);
    }
  }
  for (int i = 0; i < 15; ++i) EXPECT_NEAR(found[0][i], found[1][i], 1e-5);
}

// What the tool must find out by itself.
TEST(CalibrationTest, WithoutAForceSensorStiffnessIsFree) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 5));
  log.MutableNumbers("force_N").assign(210, std::nan(""));
  log.Write(folder.Path("blind.csv"));
  const Plan plan = StandardPlan();
  CalibrationProblem problem(
      Nominal(), plan,
      ReadCalibrationLogs({folder.Path("blind.csv")}, Nominal(), plan), {}, 2);
  const CalibrationResult result = Calibrate(&problem);
  EXPECT_FALSE(result.AllIdentified());
  EXPECT_EQ(result.identifiability.status[0], ParameterStatus::kUnidentifiable);
  EXPECT_EQ(result.identifiability.status[1], ParameterStatus::kUnidentifiable);
  EXPECT_EQ(result.identifiability.status[4], ParameterStatus::kEstimated);
  ASSERT_FALSE(result.identifiability.weak.empty());
  EXPECT_EQ(result.identifiability.weak[0].words,
            "front and back stiffness and all forces scale together");
  EXPECT_NE(result.identifiability.weak[0].remedy.find("force_N"),
            std::string::npos);
}

// A force sensor is known to 3 % by its data sheet: the scale that the logs
// leave free is as good as that, and no guess.
TEST(CalibrationTest, APriorOfTheForceScaleDeterminesStiffness) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 5);
  for (const double percent : {3.0, 50.0}) {
    Plan plan = StandardPlan();
    FamilyPlan& scale =
        plan.families[static_cast<int>(ParameterFamily::kForceScale)];
    scale.free = true;
    scale.prior_std = percent;
    CalibrationProblem problem(
        Nominal(), plan, ReadCalibrationLogs({log}, Nominal(), plan), {}, 2);
    const CalibrationResult result = Calibrate(&problem);
    const bool known = percent < 20;
    EXPECT_EQ(result.AllIdentified(), known);
    EXPECT_EQ(result.Verdict(), known ? "good" : "unidentifiable");
    const auto& free = problem.parameters().free();
    for (std::size_t k = 0; k < free.size(); ++k) {
      const CalibrationParameter& p = problem.parameters().FreeParameter(k);
      const bool rides = p.family == ParameterFamily::kForceScale ||
                         p.family == ParameterFamily::kFrontStiffness ||
                         p.family == ParameterFamily::kBackStiffness;
      EXPECT_EQ(result.identifiability.status[k],
                !rides  ? ParameterStatus::kEstimated
                : known ? ParameterStatus::kPriorDominated
                        : ParameterStatus::kUnidentifiable)
          << p.name;
      if (rides && known) {
        EXPECT_NEAR(result.identifiability.std[k], 0.03, 0.005) << p.name;
      }
    }
    ASSERT_FALSE(result.identifiability.weak.empty());
    const WeakDirection& weak = result.identifiability.weak[0];
    EXPECT_EQ(IsHeld(weak, result.identifiability.status), known);
    EXPECT_EQ(weak.remedy.find("give a prior") == std::string::npos, known)
        << weak.remedy;
  }
}

TEST(CalibrationTest, WithForceButNoPlaceGainsRideOnStiffness) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 6));
  log.MutableNumbers("object_x_mm").assign(210, std::nan(""));
  log.Write(folder.Path("placeless.csv"));
  Plan plan = StandardPlan();
  CalibrationProblem problem(
      Nominal(), plan,
      ReadCalibrationLogs({folder.Path("placeless.csv")}, Nominal(), plan), {},
      2);
  const CalibrationSolution solution = SolveOnce(&problem);
  EXPECT_TRUE(solution.solve.converged);
  const Identifiability found = AnalyzeIdentifiability(&problem, solution.at);
  // gains of gauges 2 and 3
  EXPECT_GT(found.correlation(3, 4), 0.9);
}

TEST(CalibrationTest, ThreadsDoNotChangeTheResult) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 7);
  const Plan plan = StandardPlan();
  std::vector<double> value[2];
  for (const int threads : {1, 2}) {
    CalibrationProblem problem(Nominal(), plan,
                               ReadCalibrationLogs({log}, Nominal(), plan), {},
                               threads);
    EXPECT_TRUE(SolveOnce(&problem).solve.converged);
    for (const int i : problem.parameters().free()) {
      value[threads - 1].push_back(*problem.parameters().all()[i].variable);
    }
  }
  EXPECT_EQ(value[0], value[1]);
}

// The same log says so below the limit, and nothing above its largest force.
TEST(CalibrationTest, ForcesBeyondTheLimitOfEstimatesAreNamed) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 4);
  Plan plan = StandardPlan();
  for (const double force_max_N : {5.0, 25.0}) {
    plan.scene.force_max_N = force_max_N;
    CalibrationProblem problem(
        Nominal(), plan, ReadCalibrationLogs({log}, Nominal(), plan), {}, 1);
    const std::vector<std::string> codes = Codes(Calibrate(&problem));
    EXPECT_EQ(testing::Value(codes, testing::Contains(kBeyond)),
              force_max_N < 7);
  }
}

// Real measurements, where they are at hand. Nothing of this finger was fitted
// by its authors to these rows.
TEST(CalibrationTest, SteelFingerAgainstItsForceSensor) {
  const std::string data = FINRAY_SOURCE_DIR "/../shared/data/";
  if (!std::filesystem::exists(data + "steel_finger.yaml")) {
    GTEST_SKIP() << "the measurements are not here";
  }
  const Finger finger = ReadFinger(data + "steel_finger.yaml");
  const Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/two_gauges_circle_r20.yaml");
  CalibrationProblem problem(
      finger, plan,
      ReadCalibrationLogs({data + "steel_finger_contact_circle_r20.csv"},
                          finger, plan),
      {}, 2);
  const CalibrationResult result = Calibrate(&problem);
  EXPECT_TRUE(result.solution.solve.converged);
  EXPECT_TRUE(result.AllIdentified());
  std::printf("steel finger: force %.2f N rms before, %.2f N after\n",
              result.forces.fitted.force_before_N().rms(),
              result.forces.fitted.force_after_N().rms());
  EXPECT_GT(result.forces.fitted.force_before_N().rms(), 2);
  EXPECT_LT(result.forces.fitted.force_after_N().rms(), 0.7);
  EXPECT_THAT(Codes(result), testing::Not(testing::Contains(kBeyond)));
  // It carries 13.8 N, and 40 EI / l_0^2 is 9.4 N.
  Plan unlimited = plan;
  unlimited.scene.force_max_N.reset();
  CalibrationProblem same(
      finger, unlimited,
      ReadCalibrationLogs({data + "steel_finger_contact_circle_r20.csv"},
                          finger, unlimited),
      {}, 2);
  EXPECT_THAT(Codes(Calibrate(&same)), testing::Contains(kBeyond));
}

}  // namespace
}  // namespace finray
