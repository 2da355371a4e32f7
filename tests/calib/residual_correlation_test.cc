#include "finray/calib/analysis/residual_correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "calib/calibrated.h"

namespace finray {
namespace {

// A stationary series of unit variance, r_t = phi r_{t-1} + noise.
std::vector<double> Series(int n, double phi, std::mt19937_64* generator) {
  std::normal_distribution<double> normal;
  std::vector<double> series(n);
  series[0] = normal(*generator);
  for (int t = 1; t < n; ++t) {
    series[t] =
        phi * series[t - 1] + std::sqrt(1 - phi * phi) * normal(*generator);
  }
  return series;
}

// Where the analysis has failed there is none.
TEST(ResidualCorrelationTest, WithoutAnEnlargementTheStdStay) {
  Identifiability found;
  found.std = found.bounded_std = {1, 2};
  EnlargeStd({}, &found);
  EXPECT_EQ(found.std, (std::vector<double>{1, 2}));
}

TEST(ResidualCorrelationTest, IntegratedTimeOfAnAutoregression) {
  std::mt19937_64 generator(1);
  for (const double phi : {0.5, 0.8, 0.9}) {
    const IntegratedTime time = IntegrateTime({Series(40000, phi, &generator)});
    EXPECT_NEAR(time.lag_1, phi, 0.02);
    EXPECT_NEAR(time.tau, (1 + phi) / (1 - phi), 0.1 * (1 + phi) / (1 - phi));
    EXPECT_NEAR(time.effective(), 40000 / time.tau, 1e-9);
    EXPECT_LT(time.p_value, 1e-9);
  }
  // Two logs whose ends are not neighbours: +1 ... and -1 ....
  const IntegratedTime steps =
      IntegrateTime({std::vector<double>(30, 1), std::vector<double>(30, -1)});
  EXPECT_NEAR(steps.lag_1, 58. / 60, 1e-12);
}

TEST(ResidualCorrelationTest, WhiteSeriesAreWhite) {
  std::mt19937_64 generator(2);
  int significant = 0;
  double tau = 0;
  for (int i = 0; i < 1000; ++i) {
    const IntegratedTime time = IntegrateTime({Series(200, 0, &generator)});
    significant += time.p_value < 0.05;
    tau += time.tau / 1000;
  }
  EXPECT_NEAR(significant, 50, 25);
  EXPECT_LT(tau, 1.3);
  EXPECT_EQ(IntegrateTime({{1, 1, 1}}).tau, 1);
}

// Gauge 2 wanders by its noise, white or slowly, in calibration after
// calibration.
struct Wander {
  double spread_over_std = 0;  // of its offset, rms over calibrations
  double enlargement = 0;      // of its std, rms
  int correlated = 0;
};
Wander CalibrateWandering(const Plan& plan, const Finger& start, double phi,
                          int repeats) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  Finger quiet = truth;
  quiet.gauges[1].noise_V = 1e-12;
  const std::string clean = StandardLog(folder, quiet, 50);
  std::mt19937_64 generator(3);
  Wander all;
  for (int i = 0; i < repeats; ++i) {
    FrameTable log = FrameTable::Read(clean);
    auto& volts = log.MutableNumbers("gauge_2_V");
    const auto wander = Series(static_cast<int>(log.rows()), phi, &generator);
    for (std::size_t t = 0; t < log.rows(); ++t) {
      volts[t] += truth.gauges[1].noise_V * wander[t];
    }
    log.Write(folder.Path("wander.csv"));
    Calibrated calibrated(plan, {folder.Path("wander.csv")}, start);
    const ResidualCorrelation found = AnalyzeResidualCorrelation(
        calibrated.problem->logs(), calibrated.solution.at, calibrated.found);
    const int offset = calibrated.Free("gauge_2_offset_V");
    all.correlated += found.correlated();
    all.enlargement += std::pow(found.enlargement[offset], 2) / repeats;
    const double error =
        (calibrated.Variable("gauge_2_offset_V") - truth.gauges[1].offset_V) /
        calibrated.found.std[offset];
    all.spread_over_std += error * error / repeats;
  }
  all.spread_over_std = std::sqrt(all.spread_over_std);
  all.enlargement = std::sqrt(all.enlargement);
  return all;
}

// Only offsets are free: an offset is a mean, and sqrt((1 + phi) / (1 - phi))
// is what a mean suffers.
void CheckEnlargement(int repeats, double tolerance) {
  Plan plan;
  plan.scene = StandardPlan().scene;
  plan.families[static_cast<int>(ParameterFamily::kGaugeOffset)].free = true;
  const Wander slow = CalibrateWandering(plan, HiddenFinger(), 0.8, repeats);
  std::printf("offset spreads %.2f times its std; enlarged %.2f times\n",
              slow.spread_over_std, slow.enlargement);
  EXPECT_EQ(slow.correlated, repeats);
  EXPECT_NEAR(slow.spread_over_std, 2.7, 0.9);
  EXPECT_NEAR(slow.enlargement / slow.spread_over_std, 1, tolerance);
}
TEST(ResidualCorrelationTest, StdAreEnlargedByWhatCorrelationDoes) {
  CheckEnlargement(60, 0.4);
}
TEST(ResidualCorrelationTest, SlowStdAreEnlargedByWhatCorrelationDoes) {
  CheckEnlargement(240, 0.2);
}

TEST(ResidualCorrelationTest, WhiteResidualsEnlargeNothing) {
  Plan plan;
  plan.scene = StandardPlan().scene;
  plan.families[static_cast<int>(ParameterFamily::kGaugeOffset)].free = true;
  const Wander white = CalibrateWandering(plan, HiddenFinger(), 0, 10);
  EXPECT_EQ(white.correlated, 0);
  EXPECT_DOUBLE_EQ(white.enlargement, 1);
}

// Twice the noise that the plan says makes std twice as large.
TEST(ResidualCorrelationTest, LoudResidualsEnlarge) {
  const TempFolder folder;
  Finger start = Nominal();
  for (Gauge& gauge : start.gauges) gauge.noise_V /= 2;
  Plan plan = StandardPlan();
  plan.object_std_mm /= 2;
  Calibrated calibrated(plan, {StandardLog(folder, HiddenFinger(), 31)}, start);
  const ResidualCorrelation found = AnalyzeResidualCorrelation(
      calibrated.problem->logs(), calibrated.solution.at, calibrated.found);
  EXPECT_FALSE(found.correlated());
  EXPECT_TRUE(found.loud);
  double mean = 0;
  for (const double enlargement : found.enlargement) {
    EXPECT_GT(enlargement, 1.3);
    EXPECT_LT(enlargement, 2.7);
    mean += enlargement / static_cast<double>(found.enlargement.size());
  }
  EXPECT_NEAR(mean, 1.9, 0.2);  // the force is as good as the plan says
}

// With all free an offset is told apart from ribs by loads at random, whose
// influence on it is white: dividing all information by the time of the
// residuals would make its std three times too large.
TEST(ResidualCorrelationTest, LoadsAtRandomAverageItOut) {
  const Wander slow = CalibrateWandering(StandardPlan(), Nominal(), 0.8, 6);
  std::printf("offset spreads %.2f times its std; enlarged %.2f times\n",
              slow.spread_over_std, slow.enlargement);
  EXPECT_EQ(slow.correlated, 6);
  EXPECT_LT(slow.spread_over_std, 1.6);
  EXPECT_LT(slow.enlargement, 1.4);
}

// Of a pin hidden in every other row the series is every other row long, and
// none is of two pins.
TEST(ResidualCorrelationTest, SeriesAreOfPinsWhereverTheyStand) {
  Plan plan;
  plan.scene = StandardPlan().scene;
  plan.pin_std_mm = 0.1;
  plan.families[static_cast<int>(ParameterFamily::kGaugeOffset)].free = true;
  CalibrationLogs logs;
  logs.paths = logs.names = {"pins.csv"};
  for (int i = 0; i < 60; ++i) {
    CalibrationFrame frame;
    frame.row = i;
    frame.gauges_V = {0, 0, 0, 0};
    if (i % 2 == 0) frame.pins.push_back({0, Side::kBack, {10, 20}});
    frame.pins.push_back({2, Side::kFront, {0, 60}});
    logs.frames.push_back(frame);
  }
  CalibrationProblem problem(PaperFinger(), plan, logs, {}, 1);
  const Linearization at = SolveOnce(&problem).at;
  const ResidualCorrelation found = AnalyzeResidualCorrelation(
      problem.logs(), at, AnalyzeIdentifiability(&problem, at));
  std::map<int, int> rows;  // by component
  for (const auto& series : found.series) {
    if (series.family == ResidualFamily::kPin) {
      rows[series.component] = series.time.n;
    }
  }
  EXPECT_EQ(rows, (std::map<int, int>{{2, 30}, {3, 30}, {8, 60}, {9, 60}}));
}

}  // namespace
}  // namespace finray
