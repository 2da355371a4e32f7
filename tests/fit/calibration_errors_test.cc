#include "finray/fit/calibration_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "count_allocations.h"
#include "estimation/gauge_volts.h"
#include "estimation/uncertain_finger.h"
#include "finray/finger/geometry.h"
#include "finray/objects/circle_centre.h"
#include "finray/scene/clean_readings.h"
#include "test_finger.h"

namespace finray {
namespace {

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

constexpr double kCircle_mm = 15;

// A scene with these weights, 1 / std. The place of a circle is measured if
// there are two more weights than gauges.
Scene SceneWith(double friction, const Finger& finger,
                const Eigen::VectorXd& weights) {
  Scene scene = Scene::OfGauges(friction);
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  if (weights.size() > gauges) {
    scene.object = RigidObject{Outline(CircleOutline{kCircle_mm}), {}};
    scene.object_std_mm = 1 / weights[gauges];
  }
  return scene;
}

// What a solved finger's row measures without noise. A gauge of weight 0 has no
// reading.
Measurements CleanRow(const EquilibriumSolver& solver,
                      const Eigen::VectorXd& weights) {
  Measurements row = CleanReadings(solver);
  for (std::size_t j = 0; j < row.gauges_V.size(); ++j) {
    if (weights[static_cast<Eigen::Index>(j)] == 0) {
      row.gauges_V[j] = Measurements::kNotMeasured;
    }
  }
  if (weights.size() > static_cast<Eigen::Index>(row.gauges_V.size())) {
    row.object_mm = CircleCentre(solver.contact_pose(0), kCircle_mm);
  }
  return row;
}

// The angles of a solved finger's gauges, and a circle's centre if there are
// more rows: their derivatives by the contacts, and by the calibration's
// parameters what they are off by from the readings.
struct AngleSlopes {
  Eigen::MatrixXd by_contact, by_parameter;
};
AngleSlopes AngleSlopesAt(const EquilibriumSolver& solver,
                          const std::vector<PointContact>& contacts, int rows) {
  const Finger& finger = solver.model().finger();
  const int m = solver.model().gauges(),
            n = 2 * static_cast<int>(contacts.size());
  Eigen::MatrixXd ds = solver.d_outputs().topRows(rows);
  if (rows > m) {
    const double theta = solver.contact_pose(0)[2];
    const Eigen::RowVectorXd turn = solver.d_outputs().row(m + 2);
    ds.row(m) -= kCircle_mm * std::cos(theta) * turn;
    ds.row(m + 1) -= kCircle_mm * std::sin(theta) * turn;
  }
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
  return {ds.leftCols(n), dr};
}

Eigen::MatrixXd ParameterErrors(const ParameterCovariance& known) {
  return known.std.asDiagonal() * known.correlations * known.std.asDiagonal();
}

Eigen::MatrixXd MissedAngles(const ParameterCovariance& known, int gauges,
                             const std::vector<PointContact>& contacts) {
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(gauges, gauges);
  for (const PointContact& contact : contacts) {
    known.discrepancy->AddTo(contact.arc_mm, contact.normal_N, &s);
  }
  return s;
}

// The formula, computed independently from the derivatives of the statics, and
// the covariance of the noise. A circle's centre is measured if the weights say
// so.
struct Exact {
  Eigen::MatrixXd system, noise;
};
Exact ExactCovariance(const EquilibriumSolver& solver,
                      const std::vector<PointContact>& contacts,
                      const Eigen::VectorXd& weights) {
  const int m = solver.model().gauges();
  const auto [j, dr] =
      AngleSlopesAt(solver, contacts, static_cast<int>(weights.size()));
  const Eigen::MatrixXd w = weights.cwiseAbs2().asDiagonal();
  const ParameterCovariance& known = *solver.model().finger().calibration;
  Exact exact;
  exact.noise = (j.transpose() * w * j).inverse();
  const Eigen::MatrixXd dx = -exact.noise * j.transpose() * w * dr;
  exact.system = dx * ParameterErrors(known) * dx.transpose();
  if (known.discrepancy) {
    const Eigen::MatrixXd by_angle =
        (exact.noise * j.transpose() * w).leftCols(m);
    exact.system +=
        by_angle * MissedAngles(known, m, contacts) * by_angle.transpose();
  }
  return exact;
}

struct Worst {
  double error = 0, arc_mm = 0, normal_N = 0;
  int frames = 0;
};
// Largest relative error of a std from the surface where the noise allows l_c
// to be seen.
Worst WorstOfSurface(const Finger& finger, double friction,
                     const Eigen::VectorXd& weights, int frames,
                     CalibrationErrors* errors) {
  EquilibriumSolver solver(finger, {});
  const bool circle = weights.size() > solver.model().gauges();
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
    const ContactMatrix found =
        errors->Of({contact}, CleanRow(solver, weights));
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

TEST(CalibrationErrorsTest, SurfaceIsNearTheStaticsWhereFramesAreObservable) {
  const auto check = [](const char* name, const Finger& finger, double friction,
                        const Eigen::VectorXd& weights,
                        CalibrationErrors* errors) {
    const Worst worst = WorstOfSurface(finger, friction, weights, 3000, errors);
    std::printf(
        "%-28s %4d frames: std off by at most %.4f %% (%.1f mm, %.2f "
        "N)\n",
        name, worst.frames, 100 * worst.error, worst.arc_mm, worst.normal_N);
    EXPECT_LT(worst.error, 5e-3) << name;
    EXPECT_GT(worst.frames, 1000) << name;
  };
  const auto check_new = [&check](const char* name, const Finger& finger,
                                  double friction,
                                  const Eigen::VectorXd& weights) {
    CalibrationErrors errors(finger, SceneWith(friction, finger, weights), {});
    check(name, finger, friction, weights, &errors);
  };
  const Finger finger = UncertainFinger();
  const Eigen::VectorXd weights = Weights(finger);
  CalibrationErrors all(finger, SceneWith(0, finger, weights), {});
  check("all parameters", finger, 0, weights, &all);
  check_new("friction 0.3", finger, 0.3, weights);
  Eigen::VectorXd three = weights;
  three[0] = 0;
  check("three gauges", finger, 0, three, &all);
  // Other errors on the same surface.
  const auto check_errors = [&](const char* name, const Finger& other) {
    CalibrationErrors errors(all);
    errors.SetErrors(*other.calibration);
    check(name, other, 0, weights, &errors);
  };
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
  check_errors("stiffness alone", only({FingerParameterKind::kFrontStiffness,
                                        FingerParameterKind::kBackStiffness}));
  check_errors("gains alone", only({FingerParameterKind::kGaugeGain}));
  check_errors("offsets alone", only({FingerParameterKind::kGaugeOffset}));
  check_errors("rib lengths alone", only({FingerParameterKind::kRibLength}));
  Finger discrepant = finger;
  discrepant.calibration->discrepancy = TypicalDiscrepancy(4);
  check_errors("discrepancy", discrepant);
  Eigen::VectorXd circle(6);
  circle << weights, 20, 20;  // known to 0.05 mm
  check_new("with a circle's place", finger, 0, circle);
  check_new("front gauges, pieces", FrontGauges(), 0, Weights(FrontGauges()));
  check_new("front gauges, friction 0.3", FrontGauges(), 0.3,
            Weights(FrontGauges()));
}

void ExpectNear(const Eigen::MatrixXd& found, const Eigen::MatrixXd& exact,
                double tolerance) {
  ASSERT_EQ(found.rows(), exact.rows());
  EXPECT_LT((found - exact).cwiseAbs().maxCoeff(),
            tolerance * exact.cwiseAbs().maxCoeff())
      << found << "\nagainst\n"
      << exact;
}

TEST(CalibrationErrorsTest, TwoContactsAreExact) {
  Finger finger = UncertainFinger();
  finger.calibration->discrepancy = TypicalDiscrepancy(4);
  const Eigen::VectorXd weights = Weights(finger);
  EquilibriumSolver solver(finger, {});
  CalibrationErrors errors(finger, Scene::OfGauges(0), {});
  const std::vector<PointContact> contacts = {{45, 3, 0}, {95, 2, 0}};
  ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
  ExpectNear(errors.Of(contacts, CleanRow(solver, weights)),
             ExactCovariance(solver, contacts, weights).system, 1e-6);
  // One contact beyond the surface is computed in the same way.
  const std::vector<PointContact> heavy = {{70, 30, 0}};
  solver.Reset();
  ASSERT_TRUE(solver.SolveWithSensitivities(heavy));
  ExpectNear(errors.Of(heavy, CleanRow(solver, weights)),
             ExactCovariance(solver, heavy, weights).system, 1e-8);
}

TEST(CalibrationErrorsTest, WithoutASurfaceAllIsExact) {
  const Finger finger = UncertainFinger();
  EquilibriumSolver solver(finger, {});
  Eigen::VectorXd circle(6);
  circle << Weights(finger), 20, 20;
  for (const Eigen::VectorXd& weights : {Weights(finger), circle}) {
    CalibrationErrors errors(finger, SceneWith(0, finger, weights), {},
                             CalibrationErrors::Surface::kNone);
    for (const PointContact& contact :
         {PointContact{30, 8}, PointContact{70, 3}, PointContact{110, 1}}) {
      solver.Reset();
      ASSERT_TRUE(solver.SolveWithSensitivities({contact}));
      ExpectNear(errors.Of({contact}, CleanRow(solver, weights)),
                 ExactCovariance(solver, {contact}, weights).system, 1e-8);
    }
  }
}

// Its place is known far worse than its force, in mm and N.
TEST(CalibrationErrorsTest, AWeakContactIsExactToo) {
  const Finger finger = UncertainFinger();
  const Eigen::VectorXd weights = Weights(finger);
  EquilibriumSolver solver(finger, {});
  CalibrationErrors errors(finger, Scene::OfGauges(0), {},
                           CalibrationErrors::Surface::kNone);
  for (const double normal_N : {1e-2, 1e-4, 1e-5}) {
    const std::vector<PointContact> weak = {{70, normal_N, 0}};
    solver.Reset();
    ASSERT_TRUE(solver.SolveWithSensitivities(weak));
    const Eigen::MatrixXd exact = ExactCovariance(solver, weak, weights).system;
    const ContactMatrix found = errors.Of(weak, CleanRow(solver, weights));
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(found(k, k) / exact(k, k), 1, 1e-5) << normal_N << " N";
    }
  }
}

// A row of means, and one whose past leaves readings unknown.
TEST(CalibrationErrorsTest, TheStdIsThatOfTheRow) {
  const Finger finger = UncertainFinger();
  EquilibriumSolver solver(finger, {});
  CalibrationErrors errors(finger, Scene::OfGauges(0), {},
                           CalibrationErrors::Surface::kNone);
  const std::vector<PointContact> contacts = {{70, 3, 0}};
  ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
  Measurements row = CleanReadings(solver);
  row.gauge_readings = 9;
  row.history_std_V = {0, 1e-3, 3e-4, 0};
  Eigen::VectorXd weights(4);
  for (Eigen::Index j = 0; j < 4; ++j) {
    const Gauge& gauge = finger.gauges[j];
    weights[j] = std::abs(gauge.gain_V_per_rad) /
                 std::hypot(gauge.noise_V / 3, row.history_std_V[j]);
  }
  ExpectNear(errors.Of(contacts, row),
             ExactCovariance(solver, contacts, weights).system, 1e-8);
}

// The formula as it stands, with inverses of whole matrices.
TEST(CalibrationErrorsTest, Chi2IsWhatErrorsAndNoiseDoNotExplain) {
  Finger finger = UncertainFinger();
  finger.gauges[2].noise_V = 1e-3;
  finger.calibration->discrepancy = TypicalDiscrepancy(4);
  const Eigen::VectorXd weights = Weights(finger);
  EquilibriumSolver solver(finger, {});
  for (const auto surface :
       {CalibrationErrors::Surface::kNone, CalibrationErrors::Surface::kMade}) {
    CalibrationErrors errors(finger, Scene::OfGauges(0), {}, surface);
    for (const auto& contacts :
         std::vector<std::vector<PointContact>>{{}, {{70, 3, 0}}}) {
      solver.Reset();
      ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
      const Eigen::Vector4d off_rad(2e-3, -1e-3, 5e-4, 1.5e-3);
      Measurements row = CleanReadings(solver);
      for (Eigen::Index j = 0; j < 4; ++j) {
        row.gauges_V[j] -= finger.gauges[j].gain_V_per_rad * off_rad[j];
      }
      const auto [slope, by_parameter] = AngleSlopesAt(solver, contacts, 4);
      Eigen::MatrixXd covariance =
          by_parameter * ParameterErrors(*finger.calibration) *
              by_parameter.transpose() +
          MissedAngles(*finger.calibration, 4, contacts);
      covariance.diagonal() += weights.cwiseAbs2().cwiseInverse();
      const Eigen::MatrixXd inverse = covariance.inverse();
      double chi2 = off_rad.dot(inverse * off_rad);
      if (!contacts.empty()) {
        const Eigen::VectorXd pull = slope.transpose() * inverse * off_rad;
        chi2 -=
            pull.dot((slope.transpose() * inverse * slope).inverse() * pull);
      }
      EXPECT_GT(chi2, 1);
      EXPECT_NEAR(
          errors.Chi2(contacts, row), chi2,
          (surface == CalibrationErrors::Surface::kNone ? 1e-6 : 1e-3) * chi2);
    }
    // Two contacts explain four gauges.
    const std::vector<PointContact> two = {{45, 3, 0}, {95, 2, 0}};
    ASSERT_TRUE(solver.Solve(two));
    Measurements row = CleanReadings(solver);
    row.gauges_V[0] += 1e-3;
    EXPECT_NEAR(errors.Chi2(two, row), 0, 1e-6);
  }
}

// All that a calibration may know.
Finger FingerOfAllParameters() {
  Finger finger = PaperFinger();
  finger.gauges[0].curvature_per_rad = 0.8;
  finger.gauges[0].offset_V = 0.1;
  finger.gauges[1].gain_V_per_rad = -2.1;
  finger.gauges[1].flat_share = 0.1;
  finger.gauges[2].beam = Side::kFront;
  finger.gauges[3].noise_V = 5e-4;
  SetParameter({FingerParameterKind::kHingeStiffness}, 30, &finger);
  finger.ribs[1].bending_stiffness_N_mm2 = 3000;
  finger.ribs[2].bending_stiffness_N_mm2 = 2000;
  finger.ribs[3].length_mm += 0.2;
  finger.front_pieces = {{30, 1}, {75, 0.8}, {140, 1.1}};
  finger.back_pieces = {{60, 1}, {BeamLength(finger, Side::kBack), 0.8}};
  finger.front_clamp_rad_per_N_mm = 2e-4;
  finger.back_clamp_rad_per_N_mm = 3e-4;
  finger.front_surface_mm = 0.8;
  return finger;
}

// What the gauges read, in units of their noise.
Eigen::VectorXd ReadingsInStd(const Finger& finger,
                              const std::vector<PointContact>& contacts) {
  EquilibriumSolver solver(finger, {});
  EXPECT_TRUE(solver.Solve(contacts));
  const Measurements row = CleanReadings(solver);
  Eigen::VectorXd readings(row.gauges_V.size());
  for (Eigen::Index j = 0; j < readings.size(); ++j) {
    readings[j] = row.gauges_V[j] / finger.gauges[j].noise_V;
  }
  return readings;
}

// The formula by differences between fingers, for every kind of parameter.
TEST(CalibrationErrorsTest, EveryParameterCountsAsDifferencesSay) {
  Finger finger = FingerOfAllParameters();
  ParameterCovariance& known = finger.calibration.emplace();
  known.parameters = AllParametersOf(finger);
  const auto count = static_cast<Eigen::Index>(known.parameters.size());
  known.std.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double value = ParameterValue(finger, known.parameters[k]);
    known.std[k] = value == 0 ? 1e-4 : 1e-4 * std::abs(value);
  }
  known.correlations.setIdentity(count, count);
  Scene scene = Scene::OfGauges(0.3);
  scene.friction_std = 1e-4;
  for (const auto& contacts : std::vector<std::vector<PointContact>>{
           {{70, 3, 0.3}}, {{45, 3, 0.3}, {95, 2, 0.3}}}) {
    // The changes of the readings with a parameter, each its std away.
    Eigen::MatrixXd change(4, count + 1);
    for (Eigen::Index k = 0; k < count; ++k) {
      const FingerParameter& p = known.parameters[k];
      Finger up = finger, down = finger;
      SetParameter(p, ParameterValue(finger, p) + known.std[k], &up);
      SetParameter(p, ParameterValue(finger, p) - known.std[k], &down);
      change.col(k) =
          (ReadingsInStd(up, contacts) - ReadingsInStd(down, contacts)) / 2;
      // A gauge that has come to rest has crept by the share of its reading.
      if (p.kind == FingerParameterKind::kGaugeCreepShare) {
        const Gauge& gauge = finger.gauges[p.index];
        change(p.index, k) =
            known.std[k] * (ReadingsInStd(finger, contacts)[p.index] -
                            gauge.offset_V / gauge.noise_V);
      }
    }
    const auto by_contacts = [&](double step, auto move) {
      std::vector<PointContact> up = contacts, down = contacts;
      move(step, &up);
      move(-step, &down);
      return Eigen::VectorXd(
          (ReadingsInStd(finger, up) - ReadingsInStd(finger, down)) / 2);
    };
    change.col(count) = by_contacts(
        scene.friction_std, [](double step, std::vector<PointContact>* all) {
          for (PointContact& contact : *all) contact.friction += step;
        });
    const auto unknowns = 2 * static_cast<Eigen::Index>(contacts.size());
    Eigen::MatrixXd slope(4, unknowns);
    constexpr double kStep = 1e-4;
    for (Eigen::Index i = 0; i < unknowns; ++i) {
      slope.col(i) =
          by_contacts(kStep,
                      [i](double step, std::vector<PointContact>* all) {
                        PointContact& contact = (*all)[i / 2];
                        (i % 2 == 0 ? contact.arc_mm : contact.normal_N) +=
                            step;
                      }) /
          kStep;
    }

    EquilibriumSolver solver(finger, {});
    ASSERT_TRUE(solver.Solve(contacts));
    const Measurements row = CleanReadings(solver);
    CalibrationErrors errors(finger, scene, {},
                             CalibrationErrors::Surface::kNone);
    ASSERT_NE(errors.Linearize(contacts, row), nullptr);
    const Eigen::MatrixXd by_parameter = errors.ByParameter();
    ASSERT_EQ(by_parameter.rows(), 4);
    ASSERT_EQ(by_parameter.cols(), count + 1);
    for (Eigen::Index k = 0; k <= count; ++k) {
      const double std = k < count ? known.std[k] : scene.friction_std;
      EXPECT_LT((std * by_parameter.col(k) - change.col(k)).norm(),
                1e-4 * change.col(k).norm() + 1e-9)
          << (k < count ? ParameterName(known.parameters[k]) : "friction")
          << "\n"
          << std * by_parameter.col(k).transpose() << "\n"
          << change.col(k).transpose();
    }
    const Eigen::MatrixXd moved =
        -(slope.transpose() * slope).inverse() * slope.transpose() * change;
    const Eigen::MatrixXd exact = moved * moved.transpose();
    ExpectNear(errors.Of(contacts, row), exact, 1e-3);
    if (contacts.size() > 1) continue;
    // F = f_c sqrt(1 + mu^2).
    const double mu = contacts[0].friction;
    Eigen::RowVectorXd whole = std::hypot(1, mu) * moved.row(1);
    whole[count] +=
        contacts[0].normal_N * mu / std::hypot(1, mu) * scene.friction_std;
    EXPECT_NEAR(errors.whole_force_variance_N2() / whole.squaredNorm(), 1,
                1e-3);
    CalibrationErrors on_surface(finger, scene, {});
    ExpectNear(on_surface.Of(contacts, row), exact, 2e-3);
    EXPECT_NEAR(on_surface.whole_force_variance_N2() / whole.squaredNorm(), 1,
                2e-3);
  }
}

TEST(CalibrationErrorsTest, NothingKnownWronglyGivesZero) {
  Finger finger = UncertainFinger();
  finger.calibration->std.setZero();
  EquilibriumSolver solver(finger, {});
  CalibrationErrors exact(finger, Scene::OfGauges(0), {});
  EXPECT_FALSE(exact.empty());
  ASSERT_TRUE(solver.Solve({{70, 3, 0}}));
  const ContactMatrix zero = exact.Of({{70, 3, 0}}, CleanReadings(solver));
  EXPECT_EQ(zero, Eigen::Matrix2d::Zero());
  finger.calibration.reset();
  const CalibrationErrors none(finger, Scene::OfGauges(0), {});
  EXPECT_TRUE(none.empty());
  EXPECT_TRUE(CalibrationErrors(none).empty());
}

TEST(CalibrationErrorsTest, StiffnessAndForceScaleTogether) {
  // Both stiffnesses are wrong by the same 20 %. Then the force is wrong too,
  // but the place is right.
  Finger finger = UncertainFinger();
  ParameterCovariance& known = *finger.calibration;
  known.parameters.resize(2);
  known.std = 0.2 * Eigen::Vector2d(finger.front_stiffness_N_mm2,
                                    finger.back_stiffness_N_mm2);
  known.correlations = Eigen::Matrix2d::Ones();
  EquilibriumSolver solver(finger, {});
  const Scene scene = Scene::OfGauges(0);
  CalibrationErrors on_surface(finger, scene, {});
  CalibrationErrors solved(finger, scene, {},
                           CalibrationErrors::Surface::kNone);
  for (const double arc_mm : {21.3, 64.7, 101.9}) {
    ASSERT_TRUE(solver.Solve({{arc_mm, 3.3, 0}}));
    const Measurements row = CleanReadings(solver);
    for (CalibrationErrors* errors : {&on_surface, &solved}) {
      const double tolerance = errors == &solved ? 1e-7 : 1e-4;
      const ContactMatrix found = errors->Of({{arc_mm, 3.3, 0}}, row);
      EXPECT_LT(std::sqrt(found(0, 0)), tolerance);
      EXPECT_NEAR(std::sqrt(found(1, 1)), 0.2 * 3.3, tolerance);
    }
  }
}

TEST(CalibrationErrorsTest, WithoutForceNothingIsDetermined) {
  Finger finger = UncertainFinger();
  finger.gauges[1].noise_V = 2.1e-3;
  EquilibriumSolver solver(finger, {});
  CalibrationErrors errors(finger, Scene::OfGauges(0), {});
  ASSERT_TRUE(solver.Solve({}));
  Measurements row = CleanReadings(solver);
  EXPECT_TRUE(std::isinf(errors.Of({{70, 0, 0}}, row)(0, 0)));
  // One gauge does not determine two unknowns.
  for (int j = 1; j < 4; ++j) row.gauges_V[j] = std::nan("");
  EXPECT_TRUE(std::isinf(errors.Of({{70, 3, 0}}, row)(1, 1)));
  row.gauges_V[1] = 0.1;
  EXPECT_TRUE(errors.Of({{70, 3, 0}}, row).allFinite());
}

#ifdef FINRAY_COUNTS_ALLOCATIONS

TEST(CalibrationErrorsTest, OneContactAllocatesNothingOnceWarm) {
  const Finger finger = UncertainFinger();
  CalibrationErrors errors(finger, Scene::OfGauges(0), {});
  Measurements row;
  row.gauges_V.assign(4, 0.1);
  std::vector<PointContact> contacts = {{70, 3, 0}};
  long before = 0;
  // The first round makes the cells of the surface.
  for (int round = 0; round < 2; ++round) {
    before = allocations;
    for (int i = 0; i < 100; ++i) {
      contacts[0].arc_mm = 20 + i;
      errors.Of(contacts, row);
    }
  }
  EXPECT_EQ(allocations - before, 0);
}

#endif

}  // namespace
}  // namespace finray
