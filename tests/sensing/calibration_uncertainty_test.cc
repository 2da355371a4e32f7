#include "finray/sensing/calibration_uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "count_allocations.h"
#include "finray/sensing/frame_estimator.h"
#include "sensing/gauge_volts.h"
#include "sensing/uncertain_finger.h"
#include "test_finger.h"

namespace finray {
namespace {

Finger UncertainFinger() {
  Finger finger = PaperFinger();
  finger.gauges[1].gain_V_per_rad = -2.1;
  finger.gauges[3].offset_V = 0.4;
  finger.ribs[2].length_mm += 0.2;
  finger.calibration = TypicalCovariance(finger);
  return finger;
}

// Gauges on both beams, the front ones between ribs and across one.
Finger FrontGauges() {
  Finger finger = PaperFinger();
  finger.gauges[0].beam = finger.gauges[1].beam = Side::kFront;
  finger.gauges[0].start_mm = 22;
  finger.gauges[0].length_mm = 12;
  finger.gauges[1].start_mm = 75;
  finger.gauges[1].length_mm = 21;
  finger.front_pieces = {{50, 1}, {140, 1.4}};
  finger.calibration = TypicalCovariance(finger);
  return finger;
}

// The formula, computed independently from the derivatives of the statics, and
// the covariance of the noise. A circle's centre is measured if the weights say
// so.
struct Exact {
  Eigen::MatrixXd system, noise;
};
constexpr double kCircle_mm = 15;
Exact ExactCovariance(const EquilibriumSolver& solver,
                      const std::vector<PointContact>& contacts,
                      const Eigen::VectorXd& weights) {
  const Finger& finger = solver.model().finger();
  const int m = solver.model().gauges(),
            n = 2 * static_cast<int>(contacts.size());
  const auto rows = static_cast<int>(weights.size());
  Eigen::MatrixXd ds = solver.d_outputs().topRows(rows);
  if (rows > m) {
    const double theta = solver.contact_pose(0)[2];
    const Eigen::RowVectorXd turn = solver.d_outputs().row(m + 2);
    ds.row(m) -= kCircle_mm * std::cos(theta) * turn;
    ds.row(m + 1) -= kCircle_mm * std::sin(theta) * turn;
  }
  const Eigen::MatrixXd j = ds.leftCols(n);
  const Eigen::MatrixXd w = weights.cwiseAbs2().asDiagonal();
  const ParameterCovariance& known = *finger.calibration;
  Eigen::MatrixXd dr(rows, known.std.size());
  for (Eigen::Index k = 0; k < dr.cols(); ++k) {
    const FingerParameter& p = known.parameters[k];
    dr.col(k).setZero();
    switch (p.kind) {
      case FingerParameterKind::kFrontStiffness:
        dr.col(k) = ds.col(n);
        break;
      case FingerParameterKind::kBackStiffness:
        dr.col(k) = ds.col(n + 1);
        break;
      case FingerParameterKind::kGaugeGain:
        dr(p.index, k) =
            solver.gauge_angle(p.index) / finger.gauges[p.index].gain_V_per_rad;
        break;
      case FingerParameterKind::kGaugeOffset:
        dr(p.index, k) = 1 / finger.gauges[p.index].gain_V_per_rad;
        break;
      case FingerParameterKind::kRibLength:
        dr.col(k) = ds.col(n + 2 + p.index);
        break;
      default:
        ADD_FAILURE() << "no plain parameter";
    }
  }
  Exact exact;
  exact.noise = (j.transpose() * w * j).inverse();
  const Eigen::MatrixXd dx = -exact.noise * j.transpose() * w * dr;
  exact.system = dx * known.std.asDiagonal() * known.correlations *
                 known.std.asDiagonal() * dx.transpose();
  if (known.discrepancy) {
    Eigen::MatrixXd s = Eigen::MatrixXd::Zero(m, m);
    for (const PointContact& contact : contacts) {
      known.discrepancy->AddTo(contact.arc_mm, contact.normal_N, &s);
    }
    const Eigen::MatrixXd by_angle =
        (exact.noise * j.transpose() * w).leftCols(m);
    exact.system += by_angle * s * by_angle.transpose();
  }
  return exact;
}

struct Worst {
  double error = 0, arc_mm = 0, normal_N = 0;
  int frames = 0;
};
// Largest relative error of a std from the table where the noise allows l_c to
// be seen.
Worst WorstOfTable(const Finger& finger, double friction,
                   const Eigen::VectorXd& weights, int frames) {
  EquilibriumSolver solver(finger, {});
  const bool circle = weights.size() > solver.model().gauges();
  CalibrationUncertainty uncertainty(
      finger, friction, &solver,
      circle ? std::optional(kCircle_mm) : std::nullopt);
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> uniform;
  const double heaviest_N = 25;
  Worst worst;
  for (int i = 0; i < frames; ++i) {
    const PointContact contact{140 * uniform(generator),
                               heaviest_N * std::pow(500, -uniform(generator)),
                               friction};
    solver.Reset();
    if (!solver.SolveWithSensitivities({contact})) continue;
    const Exact exact = ExactCovariance(solver, {contact}, weights);
    if (!(std::sqrt(exact.noise(0, 0)) < 7)) continue;
    // A circle determines the place of a contact even where nothing determines
    // its force.
    if (!(std::sqrt(exact.noise(1, 1)) < 0.25 * contact.normal_N) && circle) {
      continue;
    }
    const auto found = uncertainty.Of({contact}, Volts(solver), weights);
    ++worst.frames;
    for (int k = 0; k < 2; ++k) {
      const double error =
          std::abs(std::sqrt(found(k, k) / exact.system(k, k)) - 1);
      if (!(error <= worst.error)) {
        worst = {error, contact.arc_mm, contact.normal_N, worst.frames};
      }
    }
  }
  return worst;
}

TEST(CalibrationUncertaintyTest,
     TableIsNearTheStaticsWhereFramesAreObservable) {
  const auto check = [](const char* name, const Finger& finger, double friction,
                        const Eigen::VectorXd& weights) {
    const Worst worst = WorstOfTable(finger, friction, weights, 3000);
    std::printf(
        "%-28s %4d frames: std off by at most %.2f %% (%.1f mm, %.2f "
        "N)\n",
        name, worst.frames, 100 * worst.error, worst.arc_mm, worst.normal_N);
    EXPECT_LT(worst.error, 0.02) << name;
    EXPECT_GT(worst.frames, 1000) << name;
  };
  const Finger finger = UncertainFinger();
  const Eigen::VectorXd weights = Weights(finger);
  check("all parameters", finger, 0, weights);
  check("friction 0.3", finger, 0.3, weights);
  Eigen::VectorXd three = weights;
  three[0] = 0;
  check("three gauges", finger, 0, three);
  // Each kind of error alone.
  const auto only =
      [&finger](std::initializer_list<FingerParameterKind> kinds) {
        Finger one = finger;
        for (Eigen::Index k = 0; k < one.calibration->std.size(); ++k) {
          const auto kind = one.calibration->parameters[k].kind;
          if (std::count(kinds.begin(), kinds.end(), kind) == 0) {
            one.calibration->std[k] = 0;
          }
        }
        return one;
      };
  check("stiffness alone",
        only({FingerParameterKind::kFrontStiffness,
              FingerParameterKind::kBackStiffness}),
        0, weights);
  check("gains alone", only({FingerParameterKind::kGaugeGain}), 0, weights);
  check("offsets alone", only({FingerParameterKind::kGaugeOffset}), 0, weights);
  check("rib lengths alone", only({FingerParameterKind::kRibLength}), 0,
        weights);
  Eigen::VectorXd circle(6);
  circle << weights, 20, 20;  // known to 0.05 mm
  check("with a circle's place", finger, 0, circle);
  Finger discrepant = finger;
  discrepant.calibration->discrepancy = TypicalDiscrepancy(4);
  check("discrepancy", discrepant, 0, weights);
  check("front gauges, pieces", FrontGauges(), 0, Weights(FrontGauges()));
  check("front gauges, friction 0.3", FrontGauges(), 0.3,
        Weights(FrontGauges()));
}

TEST(CalibrationUncertaintyTest, TwoContactsAreExact) {
  Finger finger = UncertainFinger();
  finger.calibration->discrepancy = TypicalDiscrepancy(4);
  EquilibriumSolver solver(finger, {});
  CalibrationUncertainty uncertainty(finger, 0, &solver);
  const std::vector<PointContact> contacts = {{45, 3, 0}, {95, 2, 0}};
  ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
  const Eigen::MatrixXd exact =
      ExactCovariance(solver, contacts, Weights(finger)).system;
  const auto found = uncertainty.Of(contacts, Volts(solver), Weights(finger));
  ASSERT_EQ(found.rows(), 4);
  EXPECT_LT((found - exact).cwiseAbs().maxCoeff(),
            1e-6 * exact.cwiseAbs().maxCoeff());
  // One contact beyond the table is computed in the same way.
  const std::vector<PointContact> heavy = {{70, 30, 0}};
  ASSERT_TRUE(solver.SolveWithSensitivities(heavy));
  const Eigen::MatrixXd beyond =
      ExactCovariance(solver, heavy, Weights(finger)).system;
  EXPECT_LT((uncertainty.Of(heavy, Volts(solver), Weights(finger)) - beyond)
                .cwiseAbs()
                .maxCoeff(),
            1e-8 * beyond.cwiseAbs().maxCoeff());
}

// They widen std, explain what noise does not, and move nothing.
TEST(CalibrationUncertaintyTest, ModelErrorsNeverMoveAnEstimate) {
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
TEST(CalibrationUncertaintyTest, EstimatesOfWrongFingersSpreadAsItSays) {
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
    CalibrationUncertainty uncertainty(nominal, friction, &solver);
    std::mt19937_64 generator(21);
    std::normal_distribution<double> normal;
    for (const auto& [arc_mm, normal_N] :
         {std::pair{30.0, 8.0}, {55.0, 2.0}, {75.0, 5.0}, {100.0, 4.0}}) {
      const std::vector<PointContact> truth = {{arc_mm, normal_N, friction}};
      ASSERT_TRUE(solver.Solve(truth));
      const auto predicted =
          uncertainty.Of(truth, Volts(solver), Weights(nominal));
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

TEST(CalibrationUncertaintyTest, FrictionOfASceneIsOneMoreParameter) {
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

// Noise and one friction a log: the intervals hold as often as they say.
TEST(CalibrationUncertaintyTest, IntervalsHoldWhereFrictionIsUncertain) {
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

TEST(CalibrationUncertaintyTest, NothingKnownWronglyGivesZero) {
  Finger finger = UncertainFinger();
  finger.calibration->std.setZero();
  EquilibriumSolver solver(finger, {});
  CalibrationUncertainty exact(finger, 0, &solver);
  ASSERT_TRUE(solver.Solve({{70, 3, 0}}));
  const auto zero = exact.Of({{70, 3, 0}}, Volts(solver), Weights(finger));
  EXPECT_EQ(zero, Eigen::Matrix2d::Zero());
  finger.calibration.reset();
  EXPECT_TRUE(CalibrationUncertainty(finger, 0, &solver).empty());
}

TEST(CalibrationUncertaintyTest, StiffnessAndForceScaleTogether) {
  // Both stiffnesses are wrong by the same 20 %. Then the force is wrong too,
  // but the place is right.
  Finger finger = UncertainFinger();
  ParameterCovariance& known = *finger.calibration;
  known.parameters.resize(2);
  known.std = 0.2 * Eigen::Vector2d(finger.front_stiffness_N_mm2,
                                    finger.back_stiffness_N_mm2);
  known.correlations = Eigen::Matrix2d::Ones();
  EquilibriumSolver solver(finger, {});
  CalibrationUncertainty uncertainty(finger, 0, &solver);
  for (const double arc_mm : {21.3, 64.7, 101.9}) {
    ASSERT_TRUE(solver.Solve({{arc_mm, 3.3, 0}}));
    const auto found =
        uncertainty.Of({{arc_mm, 3.3, 0}}, Volts(solver), Weights(finger));
    EXPECT_LT(std::sqrt(found(0, 0)), 1e-5);
    EXPECT_NEAR(std::sqrt(found(1, 1)), 0.2 * 3.3, 1e-5);
  }
}

TEST(CalibrationUncertaintyTest, WithoutForceNothingIsDetermined) {
  const Finger finger = UncertainFinger();
  EquilibriumSolver solver(finger, {});
  CalibrationUncertainty uncertainty(finger, 0, &solver);
  Eigen::VectorXd weights = Weights(finger);
  ASSERT_TRUE(solver.Solve({}));
  std::vector<double> volts = Volts(solver);
  EXPECT_TRUE(std::isinf(uncertainty.Of({{70, 0, 0}}, volts, weights)(0, 0)));
  // One gauge does not determine two unknowns. Readings of unused gauges are
  // ignored.
  weights.tail(3).setZero();
  for (int j = 1; j < 4; ++j) volts[j] = std::nan("");
  EXPECT_TRUE(std::isinf(uncertainty.Of({{70, 3, 0}}, volts, weights)(1, 1)));
  weights[1] = 1000;
  volts[1] = 0.1;
  EXPECT_TRUE(uncertainty.Of({{70, 3, 0}}, volts, weights).allFinite());
}

#ifdef FINRAY_COUNTS_ALLOCATIONS

TEST(CalibrationUncertaintyTest, OneContactAllocatesNothing) {
  const Finger finger = UncertainFinger();
  EquilibriumSolver solver(finger, {});
  CalibrationUncertainty uncertainty(finger, 0, &solver);
  const Eigen::VectorXd weights = Weights(finger);
  const std::vector<double> volts(4, 0.1);
  std::vector<PointContact> contacts = {{70, 3, 0}};
  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    contacts[0].arc_mm = 20 + i;
    uncertainty.Of(contacts, volts, weights);
  }
  EXPECT_EQ(allocations - before, 0);
}

#endif

}  // namespace
}  // namespace finray
