#include "finray/estimation/row_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "finray/estimation/gauge_table.h"
#include "finray/scene/clean_readings.h"
#include "test_finger.h"

namespace finray {
namespace {

using RowModel = RowFit::Model;
constexpr double kRowNoise_rad = 3e-4, kRowGain_V_per_rad = 20;

// The paper's finger with gauges whose volts are not their angles.
Finger FingerOfRows() {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) {
    gauge.gain_V_per_rad = kRowGain_V_per_rad;
    gauge.offset_V = 0.1;
    gauge.noise_V = kRowGain_V_per_rad * kRowNoise_rad;
    gauge.max_V = 100;
  }
  return finger;
}

class RowFitTest : public testing::Test {
 protected:
  // The readings under contacts, with noise of so many std.
  Measurements RowOf(const std::vector<PointContact>& contacts,
                     double noise_std = 0) {
    EXPECT_TRUE(solver_.Solve(contacts));
    Measurements row = CleanReadings(solver_);
    for (double& volts : row.gauges_V) {
      volts += noise_std * finger_.gauges[0].noise_V * normal_(generator_);
    }
    return row;
  }

  // Fits one contact.
  bool FitOn(RowModel model, const Measurements& row, const PointContact& start,
             RowFit* fit) {
    row_ = row;
    fit->set_row(row_);
    if (model == RowModel::kEquilibria) {
      return fit->FitFrom({start}, &near_, &found_);
    }
    ContactStart from;
    from.count = 1;
    from.contacts[0] = start;
    return fit->Fit(from, model, RowFit::kMostEvaluations, &found_);
  }
  const PointContact& Found() const { return found_.contacts[0]; }

  // The shape is that of the equilibrium under the contact that was found. The
  // surface leaves out small terms of it.
  void ExpectShape(RowModel model) {
    const double exact = model == RowModel::kSurface ? 1e-2 : 1e-4;
    ASSERT_TRUE(solver_.Solve({Found()}));
    EXPECT_LT((found_.poses[0] - solver_.contact_pose(0)).norm(), exact);
    EXPECT_LT((found_.tip_pose - solver_.tip_pose()).norm(), exact);
    ASSERT_EQ(found_.rib_tension_N.size(), finger_.ribs.size());
    for (int i = 0; i < static_cast<int>(finger_.ribs.size()); ++i) {
      EXPECT_NEAR(found_.rib_tension_N[i], solver_.rib_tension(i), exact);
    }
  }

  Finger finger_ = FingerOfRows();
  EquilibriumSolver solver_{finger_, {}}, near_{finger_, {}};
  double heaviest_N_ = GaugeTable::HeaviestForce_N(finger_);
  ModelSurface surface_ = RowFit::SurfaceFor(finger_, Scene(), {}, heaviest_N_);
  RowFit fit_{finger_, Scene(), {}, &surface_, heaviest_N_};
  Measurements row_;
  ContactSolution found_;
  std::mt19937_64 generator_{12};
  std::normal_distribution<double> normal_;
};

class RowFitOnModelTest : public RowFitTest,
                          public testing::WithParamInterface<RowModel> {
 protected:
  bool Fit(const Measurements& row, const PointContact& start) {
    return FitOn(GetParam(), row, start, &fit_);
  }
  bool OnSurface() const { return GetParam() == RowModel::kSurface; }
};

std::string RowModelName(const testing::TestParamInfo<RowModel>& info) {
  return info.param == RowModel::kSurface ? "Surface" : "Equilibria";
}
INSTANTIATE_TEST_SUITE_P(Models, RowFitOnModelTest,
                         testing::Values(RowModel::kSurface,
                                         RowModel::kEquilibria),
                         RowModelName);

// Readings without noise show how exact a fit is.
TEST_P(RowFitOnModelTest, FindsTheContactFromFarAway) {
  const double exact_mm = OnSurface() ? 1e-4 : 1e-5;
  for (const double arc : {20.0, 44.1, 61.0, 72.4, 90.3, 105.0}) {
    for (const double force : {0.5, 4.0, 15.0}) {
      SCOPED_TRACE(testing::Message() << arc << " mm, " << force << " N");
      ASSERT_TRUE(Fit(RowOf({{arc, force, 0}}),
                      {arc + (arc < 70 ? 8 : -8), 0.6 * force, 0}));
      EXPECT_NEAR(Found().arc_mm, arc, exact_mm);
      EXPECT_NEAR(Found().normal_N, force, 0.1 * exact_mm * force);
      EXPECT_LT(found_.chi2, 1e-9);
      ExpectShape(GetParam());
    }
  }
}

TEST_F(RowFitTest, TwoContactsWithGaugesOnBothBeams) {
  for (const double start_mm : {20.0, 45.0, 70.0, 95.0}) {
    Gauge gauge = finger_.gauges[0];
    gauge.beam = Side::kFront;
    gauge.start_mm = start_mm;
    finger_.gauges.push_back(gauge);
  }
  const std::vector<PointContact> truth = {{40, 2, 0}, {95, 3, 0}};
  EquilibriumSolver solver(finger_, {});
  ASSERT_TRUE(solver.Solve(truth));
  const Measurements row = CleanReadings(solver);
  RowFit fit(finger_, Scene(), {}, nullptr, heaviest_N_);
  fit.set_row(row);
  ASSERT_TRUE(fit.FitFrom({{46, 1.5, 0}, {90, 2.5, 0}}, &solver, &found_));
  EXPECT_EQ(found_.information.rows(), 4);
  for (int c = 0; c < 2; ++c) {
    EXPECT_NEAR(found_.contacts[c].arc_mm, truth[c].arc_mm, 1e-5);
    EXPECT_NEAR(found_.contacts[c].normal_N, truth[c].normal_N, 1e-6);
  }
}

// The information is that of the gauges' derivatives, whatever the units.
TEST_P(RowFitOnModelTest, InformationIsThatOfTheSensitivities) {
  const PointContact truth = {75, 3, 0};
  ASSERT_TRUE(Fit(RowOf({truth}), truth));
  ASSERT_TRUE(solver_.SolveWithSensitivities({truth}));
  const Eigen::MatrixXd slope =
      solver_.d_outputs().topLeftCorner(4, 2) / kRowNoise_rad;
  const Eigen::Matrix2d expected = slope.transpose() * slope;
  const double exact = OnSurface() ? 1e-4 : 1e-6;
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(found_.information(i, k), expected(i, k),
                  exact * std::sqrt(expected(i, i) * expected(k, k)));
    }
  }
}

TEST_P(RowFitOnModelTest, StaysWithinItsBounds) {
  RowFit fit(finger_, Scene(), {}, &surface_, 20);
  int converged = 0;
  for (int i = 0; i < 200; ++i) {
    // Readings that no contact explains.
    const Measurements row = RowOf({}, 30);
    if (!FitOn(GetParam(), row, {10.0 + i % 12 * 10, 1, 0}, &fit)) continue;
    ++converged;
    EXPECT_EQ(Found().arc_mm, std::clamp(Found().arc_mm, 0.0, 140.0));
    EXPECT_EQ(Found().normal_N, std::clamp(Found().normal_N, 0.0, 20.0));
  }
  EXPECT_GE(converged, 100);  // the rest says that it did not
}

// Readings that ask for more force than allowed leave the force on its bound,
// and the place at the best contact with that force.
TEST_P(RowFitOnModelTest, AForceOnItsBoundHasTheBestPlace) {
  const Measurements row = RowOf({{70, 9, 0}});
  // These forces are no exact multiple of the unit.
  for (const double most_N : {1.5, 3.0, 4.0, 6.0}) {
    RowFit fit(finger_, Scene(), {}, &surface_, most_N);
    ASSERT_TRUE(FitOn(GetParam(), row, {60, 1, 0}, &fit));
    EXPECT_EQ(Found().normal_N, most_N);
  }
  const auto chi2_beside = [&](double beside_mm) {
    const Measurements beside = RowOf({{Found().arc_mm + beside_mm, 6, 0}});
    double chi2 = 0;
    for (std::size_t j = 0; j < row.gauges_V.size(); ++j) {
      const double off_V = beside.gauges_V[j] - row.gauges_V[j];
      chi2 += std::pow(off_V / finger_.gauges[j].noise_V, 2);
    }
    return chi2;
  };
  EXPECT_NEAR(chi2_beside(0), found_.chi2, 1e-5 * (1 + found_.chi2));
  EXPECT_GT(chi2_beside(-0.1), found_.chi2);
  EXPECT_GT(chi2_beside(0.1), found_.chi2);
}

// There chi2 is one long hyperbola f (l_0 - l) = const, or nearly flat.
TEST_P(RowFitOnModelTest, LightTouchesConvergeFromTheTip) {
  int converged = 0, evaluations = 0;
  for (int i = 0; i < 200; ++i) {
    const Measurements row = RowOf({{35.0 + i % 8 * 10, 0.05, 0}}, 1);
    converged += Fit(row, {i % 2 == 0 ? 138.75 : 80, 0.2, 0});
    evaluations += fit_.evaluations();
  }
  EXPECT_GE(converged, 195);
  EXPECT_LE(evaluations, 200 * RowFit::kMostEvaluations / 2);
}

// Without a reading of a gauge the others tell the contact.
TEST_P(RowFitOnModelTest, MissingAndSaturatedReadingsDoNotCount) {
  for (const double volts : {std::nan(""), finger_.gauges[1].max_V}) {
    Measurements row = RowOf({{70, 3, 0}});
    row.gauges_V[1] = volts;
    ASSERT_TRUE(Fit(row, {65, 2, 0}));
    EXPECT_NEAR(Found().arc_mm, 70, 1e-4);
    EXPECT_NEAR(Found().normal_N, 3, 1e-5);
  }
}

// The rule that ends a fit does not end it too early, and the surface is that
// of the equilibria.
TEST_P(RowFitOnModelTest, EndsWhereAFitToRoundingEnds) {
  for (double arc = 32; arc < 108; arc += 5.3) {
    for (const double force : {0.3, 1.1, 4.0, 11.0}) {
      SCOPED_TRACE(testing::Message() << arc << " mm, " << force << " N");
      const Measurements row = RowOf({{arc, force, 0}}, 1);
      ASSERT_TRUE(FitOn(RowModel::kEquilibria, row, {arc, force, 0}, &fit_));
      const LadderState near = found_.state;
      ContactSolution exact;
      ASSERT_TRUE(fit_.Fit({1, found_.contacts, 0, &near}, RowModel::kRounding,
                           RowFit::kMostEvaluations, &exact));
      ASSERT_TRUE(Fit(row, {arc + 1.5, 0.9 * force, 0}));
      const Eigen::Vector2d off(Found().arc_mm - exact.contacts[0].arc_mm,
                                Found().normal_N - exact.contacts[0].normal_N);
      EXPECT_LT(std::sqrt(off.dot(exact.information * off)), 1e-4);
      EXPECT_NEAR(found_.chi2, exact.chi2, 1e-5 * (1 + exact.chi2));
      EXPECT_LT((found_.information - exact.information).norm(),
                1e-3 * exact.information.norm());
      ExpectShape(GetParam());
    }
  }
}

// Gauges whose noise is rounding ask for more than the surface has.
TEST_F(RowFitTest, TheSurfaceRefusesWhatItIsNotExactEnoughFor) {
  for (Gauge& gauge : finger_.gauges) gauge.noise_V *= 1e-10;
  const ModelSurface surface =
      RowFit::SurfaceFor(finger_, Scene(), {}, heaviest_N_);
  RowFit fit(finger_, Scene(), {}, &surface, heaviest_N_);
  const Measurements row = RowOf({{70, 3, 0}});
  EXPECT_FALSE(FitOn(RowModel::kSurface, row, {69, 3, 0}, &fit));
}

}  // namespace
}  // namespace finray
