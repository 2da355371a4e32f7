#include "finray/calib/analysis/bench_linearity.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <random>

#include "finray/calib/report/calibration_result.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kNoise_V = 0.005;
const double kRadii_mm[] = {INFINITY, 272, 203, 134, 100, 80, 67, 57, 50};

// Each cylinder twice; the gauge is the paper's first one, 18 mm long.
CalibrationLogs Bench(const std::function<double(double)>& volts,
                      unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise(0, kNoise_V);
  CalibrationLogs logs;
  logs.paths = logs.names = {"bench.csv"};
  for (int trial = 0; trial < 2; ++trial) {
    for (const double radius : kRadii_mm) {
      CalibrationFrame frame;
      frame.cylinder_radius_mm = radius;
      frame.gauges_V = {volts(18 / radius) + noise(generator), NAN, NAN, NAN};
      logs.frames.push_back(frame);
    }
  }
  return logs;
}

// A linear gauge is called otherwise as often as the level says.
TEST(BenchLinearityTest, FalseAlarms) {
  int curved = 0, lacking = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    const auto found =
        TestBenchLinearity(PaperFinger(), Plan(),
                           Bench([](double a) { return 1.5 + 0.8 * a; }, seed));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].readings, 18);
    curved += found[0].quadratic_p_value < 0.1;
    lacking += found[0].lack_of_fit_p_value < 0.1;
  }
  EXPECT_NEAR(curved, 100, 30);
  EXPECT_NEAR(lacking, 100, 30);
}

TEST(BenchLinearityTest, ACurveIsFoundAndMeasured) {
  int within = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const auto found = TestBenchLinearity(
        PaperFinger(), Plan(),
        Bench([](double a) { return 1.5 + 0.8 * a + 0.6 * a * a; }, seed));
    EXPECT_TRUE(found[0].IsCurved());
    within += std::abs(found[0].quadratic_V_per_rad2 - 0.6) <
              2 * found[0].quadratic_std;
    EXPECT_NEAR(found[0].bow_V, 0.6 * 0.36 * 0.36 / 4, 0.01);
    EXPECT_LT(found[0].first_gain_V_per_rad, found[0].last_gain_V_per_rad);
  }
  EXPECT_NEAR(within, 0.93 * 200, 12);  // Student's t of 15 degrees
}

// A shape that is as high on the left as on the right has no quadratic term.
TEST(BenchLinearityTest, LackOfFitSeesOtherShapes) {
  const auto found = TestBenchLinearity(
      PaperFinger(), Plan(),
      Bench([](double a) { return 1.5 + 0.8 * a + 0.015 * std::sin(35 * a); },
            3));
  EXPECT_LT(found[0].lack_of_fit_p_value, 1e-3);
  EXPECT_FALSE(found[0].IsLinear());
}

// Readings of a converter of 10 mV: repeats are the same number, and off the
// line by as much as that.
TEST(BenchLinearityTest, RoundedRepeatsAreNoPureError) {
  CalibrationLogs logs = Bench([](double) { return 0; }, 1);
  for (CalibrationFrame& frame : logs.frames) {
    const double volts = 1.5 + 0.8 * 18 / frame.cylinder_radius_mm;
    frame.gauges_V[0] = 0.01 * std::round(volts / 0.01);
  }
  Finger finger = PaperFinger();
  finger.gauges[0].noise_V = 0.01 / std::sqrt(12);
  const auto found = TestBenchLinearity(finger, {}, logs);
  EXPECT_TRUE(found[0].IsLinear());
  EXPECT_GT(found[0].lack_of_fit_F, 0.1);
  EXPECT_LT(found[0].lack_of_fit_F, 4);

  // No scatter at all: what the reading's std leaves of q, from the normal
  // equations.
  Eigen::MatrixXd columns(logs.frames.size(), 3);
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    const double angle = 18 / logs.frames[i].cylinder_radius_mm;
    logs.frames[i].gauges_V[0] = 1 + angle;
    columns.row(i) << 1, angle, angle * angle;
  }
  const double variance = (columns.transpose() * columns).inverse()(2, 2);
  const auto exact = TestBenchLinearity(finger, {}, logs);
  EXPECT_NEAR(exact[0].quadratic_std,
              finger.gauges[0].noise_V * std::sqrt(variance), 1e-9);
  EXPECT_TRUE(exact[0].IsLinear());
}

TEST(BenchLinearityTest, NothingToSayOfTooLittle) {
  CalibrationLogs logs = Bench([](double a) { return a; }, 1);
  logs.frames.resize(3);
  EXPECT_TRUE(TestBenchLinearity(PaperFinger(), Plan(), logs).empty());
}

// The bench alone gives gains and offsets; of gauges that were not there
// nothing.
TEST(BenchLinearityTest, PlanOfItsOwn) {
  const TempFolder folder;
  std::string text = "cylinder_radius_mm,gauge_1_V,gauge_2_V\n";
  std::mt19937_64 generator(4);
  std::normal_distribution<double> noise(0, 3e-3);
  for (const double radius : kRadii_mm) {
    text += (std::isinf(radius) ? "inf" : std::to_string(radius)) + "," +
            std::to_string(1.5 + 0.8 * 18 / radius + noise(generator)) + "," +
            std::to_string(0.2 - 2.0 * 18 / radius + noise(generator)) + "\n";
  }
  const std::string path = folder.Write("bench.csv", text);
  Finger finger = PaperFinger();
  finger.gauges.resize(2);
  Plan plan;
  plan.gauge_std_V = 3e-3;
  for (const ParameterFamily family :
       {ParameterFamily::kGaugeGain, ParameterFamily::kGaugeOffset}) {
    plan.families[static_cast<int>(family)].free = true;
  }
  CalibrationProblem problem(finger, plan,
                             ReadCalibrationLogs({path}, finger, plan), {}, 1);
  const CalibrationResult result = Calibrate(&problem);
  EXPECT_TRUE(result.solution.solve.converged);
  EXPECT_TRUE(result.AllIdentified());
  const auto& std = result.identifiability.std;
  EXPECT_NEAR(result.finger.gauges[0].gain_V_per_rad, 0.8, 4 * std[0]);
  EXPECT_NEAR(result.finger.gauges[1].gain_V_per_rad, -2.0, 4 * std[1]);
  EXPECT_NEAR(result.finger.gauges[0].offset_V, 1.5, 4 * std[2]);
  EXPECT_LT(std[0], 0.02);
  ASSERT_EQ(result.bench.size(), 2u);
  const auto& noise_found =
      result.identifiability.noise[static_cast<int>(ResidualFamily::kBench)];
  EXPECT_EQ(noise_found.residuals, 18);

  finger.gauges.push_back(PaperFinger().gauges[2]);
  CalibrationProblem more(finger, plan,
                          ReadCalibrationLogs({path}, finger, plan), {}, 1);
  EXPECT_FALSE(Calibrate(&more).AllIdentified());
}

// Real gauges, 38 mm long, where the measurements are at hand. Each was bent
// twice, and had moved in between.
TEST(BenchLinearityTest, RealGaugesAreNotLinear) {
  const std::string data = FINRAY_SOURCE_DIR "/../shared/data/";
  const std::string path = data + "gauge_cylinder_calibration.csv";
  if (!std::filesystem::exists(path)) {
    GTEST_SKIP() << "the measurements are not here";
  }
  ColumnMapping volts;
  ColumnRule& rule = volts.rules.emplace_back();
  rule.from = "voltage_V";
  rule.to = "gauge_1_V";
  FrameTable table = FrameTable::Read(path, volts);
  std::map<std::string, std::map<std::string, std::string>> trials;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (table.MutableText("excluded_by_author")[i] != "0") continue;
    const std::string sensor = table.MutableText("sensor")[i];
    const double radius = table.Numbers("cylinder_radius_mm")[i];
    trials[sensor][table.MutableText("session")[i] + "_" +
                   table.MutableText("trial")[i]] +=
        (std::isinf(radius) ? "inf" : std::to_string(radius)) + "," +
        std::to_string(table.Numbers("gauge_1_V")[i]) + "\n";
  }
  Finger finger = ReadFinger(data + "steel_finger.yaml");
  finger.gauges.resize(1);
  finger.gauges[0].length_mm = 38;
  Plan plan;
  plan.gauge_std_V = 0.01;
  FamilyPlan& gain =
      plan.families[static_cast<int>(ParameterFamily::kGaugeGain)];
  FamilyPlan& offset =
      plan.families[static_cast<int>(ParameterFamily::kGaugeOffset)];
  gain.free = offset.free = offset.per_log = true;
  for (const char* sensor : {"rod1", "rod2", "rod3"}) {
    const TempFolder folder;
    std::vector<std::string> logs;
    for (const auto& [name, rows] : trials[sensor]) {
      logs.push_back(
          folder.Write(name + ".csv", "cylinder_radius_mm,gauge_1_V\n" + rows));
    }
    ASSERT_EQ(logs.size(), 2u);
    CalibrationProblem problem(finger, plan,
                               ReadCalibrationLogs(logs, finger, plan), {}, 1);
    const CalibrationResult result = Calibrate(&problem);
    ASSERT_EQ(result.bench.size(), 1u);
    const BenchLinearity& bench = result.bench[0];
    const auto& noise =
        result.identifiability.noise[static_cast<int>(ResidualFamily::kBench)];
    std::printf(
        "%s: gain %.3f +- %.3f V/rad, chi2/dof %.1f at 10 mV; flat %.2f, bent "
        "%.2f V/rad, bow %.3f V, quadratic %.2f +- %.2f V/rad^2 (p %.0e), lack "
        "of fit F %.1f (p %.0e)\n",
        sensor, result.finger.gauges[0].gain_V_per_rad,
        result.identifiability.std[0], noise.chi2 / noise.dof,
        bench.first_gain_V_per_rad, bench.last_gain_V_per_rad, bench.bow_V,
        bench.quadratic_V_per_rad2, bench.quadratic_std,
        bench.quadratic_p_value, bench.lack_of_fit_F,
        bench.lack_of_fit_p_value);
    EXPECT_FALSE(bench.IsLinear());
    EXPECT_EQ(result.warnings.back().code, "gauge_not_linear");

    Plan curved = plan;
    curved.families[static_cast<int>(ParameterFamily::kGaugeCurvature)].free =
        true;
    CalibrationProblem with(finger, curved,
                            ReadCalibrationLogs(logs, finger, curved), {}, 1);
    const CalibrationResult bent = Calibrate(&with);
    const auto& rest =
        bent.identifiability.noise[static_cast<int>(ResidualFamily::kBench)];
    const Gauge& gauge = bent.finger.gauges[0];
    std::printf(
        "  with a curve: %.3f per rad, chi2/dof %.1f, %zu instead of %zu rows "
        "rejected\n",
        gauge.curvature_per_rad, rest.chi2 / rest.dof, with.rejected().size(),
        problem.rejected().size());
    EXPECT_GT(gauge.gain_V_per_rad * gauge.curvature_per_rad, 0);
    for (const Warning& warning : bent.warnings) {
      EXPECT_NE(warning.code, "gauge_not_linear");
    }
  }
}

// Closed forms: d1 = 2, and Student's t of one and two degrees.
TEST(FDistributionTest, ClosedForms) {
  for (const double f : {0.01, 0.5, 1.0, 4.0, 30.0, 900.0}) {
    for (const int d2 : {1, 2, 7, 60}) {
      const double expected = std::pow(1 + 2 * f / d2, -0.5 * d2);
      EXPECT_NEAR(FTail(f, 2, d2) / expected, 1, 1e-12);
    }
    const double t = std::sqrt(f);
    EXPECT_NEAR(FTail(f, 1, 1), 1 - 2 / M_PI * std::atan(t), 1e-13);
    EXPECT_NEAR(FTail(f, 1, 2), 1 - t / std::sqrt(2 + f), 1e-13);
    // X and 1 / X.
    EXPECT_NEAR(FTail(f, 5, 8), 1 - FTail(1 / f, 8, 5), 1e-13);
  }
}

TEST(FDistributionTest, Edges) {
  EXPECT_EQ(FTail(0, 3, 4), 1);
  EXPECT_EQ(FTail(INFINITY, 3, 4), 0);
  EXPECT_TRUE(std::isnan(FTail(1, 0, 4)));
  EXPECT_TRUE(std::isnan(FTail(NAN, 1, 4)));
}

}  // namespace
}  // namespace finray
