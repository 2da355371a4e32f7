#include "finray/estimation/zeroed_finger.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "finray/io/error.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

// A calibrated finger with bent beams at rest, whose offsets are uncertain.
Finger Calibrated() {
  Finger finger = PaperFinger();
  finger.ribs[1].length_mm += 0.3;
  ParameterCovariance covariance;
  covariance.parameters = ParametersOf(finger);
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  covariance.std = Eigen::VectorXd::Constant(n, 0.01);
  covariance.std.head<2>().setConstant(100);
  covariance.correlations = Eigen::MatrixXd::Identity(n, n);
  covariance.correlations(0, 1) = covariance.correlations(1, 0) = 0.5;
  finger.calibration = covariance;
  return finger;
}

// With `contacts` they are of a finger that something touches.
std::vector<Measurements> Resting(
    const Finger& finger, int rows, std::mt19937_64* generator,
    const std::vector<PointContact>& contacts = {}) {
  EquilibriumSolver solver(finger, {});
  EXPECT_TRUE(solver.Solve(contacts));
  std::vector<Measurements> readings(rows);
  for (Measurements& row : readings) {
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      const Gauge& gauge = finger.gauges[j];
      std::normal_distribution<double> noise(0, gauge.noise_V);
      row.gauges_V.push_back(
          gauge.Volts(solver.gauge_angle(static_cast<int>(j))) +
          noise(*generator));
    }
  }
  return readings;
}

Finger Moved(Finger finger) {
  const double by[] = {0.02, -0.015, 0.03, 0.001};
  for (int j = 0; j < 4; ++j) finger.gauges[j].offset_V += by[j];
  return finger;
}

TEST(ZeroedFingerTest, FindsOffsetsThatHaveMoved) {
  std::mt19937_64 generator(1);
  const Finger before = Calibrated(), now = Moved(before);
  const ZeroedFinger zeroed =
      ZeroGauges(before, {}, Resting(now, 100, &generator), "log");
  EXPECT_EQ(zeroed.rows, 100u);
  for (int j = 0; j < 4; ++j) {
    EXPECT_NEAR(zeroed.std_V[j], now.gauges[j].noise_V / 10,
                0.3 * now.gauges[j].noise_V / 10);
    EXPECT_NEAR(zeroed.finger.gauges[j].offset_V, now.gauges[j].offset_V,
                4 * zeroed.std_V[j]);
    EXPECT_NEAR(zeroed.change_V[j],
                now.gauges[j].offset_V - before.gauges[j].offset_V,
                4 * zeroed.std_V[j]);
  }
  EXPECT_EQ(zeroed.finger.back_stiffness_N_mm2, before.back_stiffness_N_mm2);
}

// The covariance of what zeroing gives with fingers drawn from the covariance:
// the truth draws its other parameters, the given finger has the mean.
TEST(ZeroedFingerTest, CovarianceIsThatOfManyZeroings) {
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal;
  const Finger given = Calibrated();
  const ParameterCovariance& old = *given.calibration;
  const Eigen::MatrixXd factor = old.Factor();
  const auto n = static_cast<Eigen::Index>(old.parameters.size());
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(n, n);
  constexpr int kDraws = 400, kRows = 20;
  ZeroedFinger zeroed;
  for (int draw = 0; draw < kDraws; ++draw) {
    Finger truth = given;
    const Eigen::VectorXd off =
        factor * Eigen::VectorXd::NullaryExpr(
                     n, [&](Eigen::Index) { return normal(generator); });
    for (Eigen::Index k = 0; k < n; ++k) {
      SetParameter(old.parameters[k],
                   ParameterValue(given, old.parameters[k]) + off[k], &truth);
    }
    zeroed = ZeroGauges(given, {}, Resting(truth, kRows, &generator), "log",
                        {0, true});  // few of the draws look like a touch
    Eigen::VectorXd error(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      error[k] = ParameterValue(zeroed.finger, old.parameters[k]) -
                 ParameterValue(truth, old.parameters[k]);
    }
    sums += error * error.transpose() / kDraws;
  }
  const ParameterCovariance& found = *zeroed.finger.calibration;
  ASSERT_EQ(found.parameters, old.parameters);
  const Eigen::VectorXd scale = sums.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < n; ++i) {
    EXPECT_NEAR(found.std[i], scale[i], 0.15 * scale[i]) << i;
    for (Eigen::Index j = 0; j < i; ++j) {
      EXPECT_NEAR(found.correlations(i, j), sums(i, j) / (scale[i] * scale[j]),
                  0.2)
          << i << " " << j;
    }
  }
}

TEST(ZeroedFingerTest, GaugesThatDoNotMoveAreRefused) {
  std::mt19937_64 generator(5);
  const Finger finger = Moved(Calibrated());
  std::vector<Measurements> rows = Resting(finger, 50, &generator);
  const std::vector<Measurements> good = rows;
  for (Measurements& row : rows) row.gauges_V[1] = row.gauges_V[3] = 0.5;
  EXPECT_THAT([&] { ZeroGauges(finger, {}, rows, "log.csv"); },
              testing::ThrowsMessage<InputError>(testing::StartsWith(
                  "log.csv: gauges 2, 4 do not move in 50 rows, not even by "
                  "noise: dead")));
  EXPECT_NO_THROW(ZeroGauges(finger, {}, rows, "log.csv", {0, true}));
  // They move elsewhere in the log.
  std::vector<Measurements> all = rows;
  all.insert(all.end(), good.begin(), good.end());
  EXPECT_NO_THROW(
      ZeroGauges(Calibrated(), {}, good, "log.csv", {0, true, &all}));
  for (Measurements& row : rows) {
    row.gauges_V = good[0].gauges_V;
    for (double& volts : row.gauges_V) volts *= 1e-3;
  }
  EXPECT_THROW(ZeroGauges(finger, {}, rows, "log.csv"), InputError);
  // Coarse steps, as the finger says that it rests.
  for (Measurements& row : rows) row.gauges_V = good[0].gauges_V;
  EXPECT_NO_THROW(ZeroGauges(finger, {}, rows, "log.csv"));
}

TEST(ZeroedFingerTest, FrictionStays) {
  std::mt19937_64 generator(3);
  Finger before = Calibrated();
  ParameterCovariance& old = *before.calibration;
  old.parameters.push_back({FingerParameterKind::kFriction, 0});
  const Eigen::Index n = old.std.size();
  old.std.conservativeResize(n + 1);
  old.std[n] = 0.02;
  old.correlations = Eigen::MatrixXd::Identity(n + 1, n + 1);
  old.friction = 0.31;
  const ZeroedFinger zeroed =
      ZeroGauges(before, {}, Resting(before, 100, &generator), "log");
  ASSERT_TRUE(zeroed.finger.calibration.has_value());
  EXPECT_TRUE(zeroed.finger.calibration->HasFriction());
  EXPECT_EQ(zeroed.finger.calibration->friction, 0.31);
}

TEST(ZeroedFingerTest, RefusesAFingerThatMoves) {
  std::mt19937_64 generator(3);
  const Finger finger = Calibrated();
  std::vector<Measurements> rows = Resting(finger, 50, &generator);
  for (int i = 40; i < 50; ++i) rows[i].gauges_V[2] += 0.02;
  EXPECT_THAT([&] { ZeroGauges(finger, {}, rows, "log.csv"); },
              testing::ThrowsMessage<InputError>(
                  testing::HasSubstr("log.csv: gauge_3_V varies by")));
  rows.resize(2);
  EXPECT_THAT([&] { ZeroGauges(finger, {}, rows, "log.csv"); },
              testing::ThrowsMessage<InputError>(
                  testing::HasSubstr("gauge_1_V has 2 readings")));
}

TEST(ZeroedFingerTest, ThreeReadingsGiveTheirStd) {
  std::mt19937_64 generator(5);
  const Finger before = Calibrated(), now = Moved(before);
  for (const int rows : {3, 5}) {
    const ZeroedFinger zeroed =
        ZeroGauges(before, {}, Resting(now, rows, &generator), "log");
    EXPECT_EQ(zeroed.fewest, static_cast<std::size_t>(rows));
    for (int j = 0; j < 4; ++j) {
      EXPECT_GE(zeroed.std_V[j], now.gauges[j].noise_V / std::sqrt(rows));
      EXPECT_NEAR(zeroed.finger.gauges[j].offset_V, now.gauges[j].offset_V,
                  4 * zeroed.std_V[j]);
    }
  }
}

// Light and heavy touches, with the calibration's errors in the finger.
TEST(ZeroedFingerTest, RefusesAFingerThatIsTouched) {
  std::mt19937_64 generator(6);
  const Finger known = Calibrated();
  Finger truth = known;
  truth.front_stiffness_N_mm2 *= 1.006;
  truth.back_stiffness_N_mm2 *= 0.995;
  truth.gauges[1].gain_V_per_rad *= 1.004;
  for (const double force : {0.3, 1.0, 2.0, 6.0}) {
    for (const double arc : {30.0, 59.4, 100.0}) {
      for (const double friction : {0.0, 0.2, -0.2}) {
        const std::vector<Measurements> rows =
            Resting(truth, 50, &generator, {{arc, force, friction}});
        const ZeroCheck check{std::abs(friction), false};
        EXPECT_THAT([&] { ZeroGauges(known, {}, rows, "log.csv", check); },
                    testing::ThrowsMessage<InputError>(testing::AllOf(
                        testing::HasSubstr("log.csv: a contact of"),
                        testing::HasSubstr("--allow_touch"))))
            << force << " N at " << arc << " mm, friction " << friction;
        EXPECT_NO_THROW(
            ZeroGauges(known, {}, rows, "log.csv", {check.friction, true}));
      }
    }
  }
}

// Offsets move by any amount from a fraction of the noise on.
TEST(ZeroedFingerTest, OffsetsThatMoveAreNoTouch) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  const Finger before = Calibrated();
  int refused = 0;
  for (int draw = 0; draw < 40; ++draw) {
    Finger now = before;
    const double by_V = std::vector{1e-4, 1e-3, 5e-3, 3e-2}[draw % 4];
    for (Gauge& gauge : now.gauges) gauge.offset_V += by_V * normal(generator);
    try {
      ZeroGauges(before, {}, Resting(now, 50, &generator), "log");
    } catch (const InputError& error) {
      ++refused;
    }
  }
  EXPECT_LE(refused, 1);
}

TEST(ZeroedFingerTest, AnUncalibratedFingerStaysSo) {
  std::mt19937_64 generator(4);
  EXPECT_FALSE(ZeroGauges(PaperFinger(), {},
                          Resting(PaperFinger(), 20, &generator), "log")
                   .finger.calibration);
}

}  // namespace
}  // namespace finray
