// The path of equilibria as a load grows: where it folds over, and beyond.

#include "finray/statics/load_path.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "finray/statics/equilibrium.h"
#include "statics/equilibrium_check.h"
#include "test_finger.h"

namespace finray {
namespace {

// Limit loads of the paper's finger under one contact without friction, from a
// collocation code: l_c in mm and f_c in N.
const std::vector<std::pair<double, double>>& LimitLoads() {
  static const std::vector<std::pair<double, double>> loads = {
      {40, 186.7},  {45, 188.15}, {105, 198.43}, {110, 182.3}, {115, 161.4},
      {120, 139.6}, {125, 120.9}, {130, 106.69}, {135, 97.5}};
  return loads;
}

TEST(LoadPathTest, FindsTheLimitLoadsOfThePapersFinger) {
  EquilibriumSolver solver(PaperFinger(), {});
  for (const auto& [arc, limit] : LimitLoads()) {
    SCOPED_TRACE(arc);
    // At whatever load is asked for.
    for (const double force : {1.02 * limit, 200.0}) {
      solver.Reset();
      EXPECT_FALSE(solver.Solve({{arc, force, 0}}));
      EXPECT_EQ(solver.status(), SolveStatus::kLimitPoint);
      const double tolerance = arc == 45 || arc == 130 ? 1e-3 : 2e-3;
      EXPECT_NEAR(force * solver.path_fraction(), limit, tolerance * limit);
    }
    std::printf("l_c %g mm: limit %.3f N, reference %.2f N\n", arc,
                200 * solver.path_fraction(), limit);
    EXPECT_TRUE(solver.Solve({{arc, 0.99 * limit, 0}}));
  }
}

TEST(LoadPathTest, ElsewhereThePathReaches200N) {
  EquilibriumSolver solver(PaperFinger(), {});
  double worst = 0;
  for (const double arc : {5., 10., 15., 20., 25., 30., 35., 50., 55., 60., 65.,
                           70., 75., 80., 85., 90., 95., 100.}) {
    SCOPED_TRACE(arc);
    const std::vector<PointContact> contacts = {{arc, 200, 0}};
    solver.Reset();
    ASSERT_TRUE(solver.Solve(contacts)) << solver.Why();
    const EquilibriumCheck check(solver, contacts);
    EXPECT_LT(check.worst(), 1e-8) << check.what();
    worst = std::max(worst, check.worst());
  }
  std::printf("at 200 N: worst violation %.1e\n", worst);
}

// Both sides of a limit point differ by less than its rounding.
TEST(LoadPathTest, TheLimitPointParts) {
  EquilibriumSolver solver(PaperFinger(), {});
  for (const double arc : {45.0, 110.0, 130.0}) {
    SCOPED_TRACE(arc);
    ASSERT_FALSE(solver.Solve({{arc, 200, 0}}));
    const double limit = 200 * solver.path_fraction();
    for (const double hair : {1e-2, 1e-3, 1e-4, 1e-5}) {
      SCOPED_TRACE(hair);
      EXPECT_TRUE(solver.Solve({{arc, limit * (1 - hair), 0}})) << solver.Why();
      solver.Reset();
      EXPECT_FALSE(solver.Solve({{arc, limit * (1 + hair), 0}}));
      EXPECT_EQ(solver.status(), SolveStatus::kLimitPoint);
    }
  }
}

// The sign of det(closure by base loads and tensions): it changes where a
// stability does.
int Sign(EquilibriumSolver* solver, const std::vector<PointContact>& contacts) {
  const LadderState state = solver->state();
  LadderShot shot;
  EXPECT_TRUE(solver->Shoot(state.q, contacts, &shot));
  Eigen::MatrixXd matrix = shot.d_closure.leftCols(state.q.size());
  // Of comparable columns, against overflow; that keeps the sign.
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) matrix.col(j).normalize();
  return Eigen::PartialPivLU<Eigen::MatrixXd>(matrix).determinant() > 0 ? 1
                                                                        : -1;
}

void FollowThroughTheFold(double softer, double arc, double limit_N) {
  Finger finger = PaperFinger();
  finger.front_stiffness_N_mm2 /= softer;
  finger.back_stiffness_N_mm2 /= softer;
  const double force = 200 / softer;
  const std::vector<PointContact> contacts = {{arc, force, 0}};
  LadderNewton newton(finger, {});
  ASSERT_TRUE(newton.Converge(contacts, 0, SweepColumns::kLoad));
  LoadPath path(&newton, contacts, 0);
  EquilibriumSolver solver(finger, {});

  int sign_before = 0, points = 0, folds = 0, beyond = 0;
  double worst = 0, lowest = 1, last = 0;
  while (points < 120 && path.fraction() < 1) {
    ASSERT_TRUE(path.Advance()) << "lost at " << path.fraction();
    ++points;
    if (path.passed_limit_point() && ++folds == 1) {
      EXPECT_NEAR(path.limit_fraction() * force, limit_N / softer,
                  2e-3 * limit_N / softer);
    }
    if (folds == 1) {
      ++beyond;
      lowest = std::min(lowest, path.fraction());
      // At first the load falls.
      if (beyond > 1 && beyond <= 5) {
        EXPECT_LT(path.fraction(), last);
      }
    }
    last = path.fraction();

    // The point is an equilibrium, and the one that Newton's method stays at.
    LadderState state;
    newton.Save(&state);
    solver.set_state(state);
    const std::vector<PointContact> part = {{arc, force * path.fraction(), 0}};
    ASSERT_TRUE(solver.Solve(part)) << "point " << points;
    const LadderState converged = solver.state();
    if (state.nodes[0].cols() == converged.nodes[0].cols()) {
      EXPECT_LT((state.nodes[0] - converged.nodes[0]).cwiseAbs().maxCoeff(),
                1e-2);
    }
    const EquilibriumCheck check(solver, part);
    EXPECT_LT(check.worst(), 1e-8) << check.what();
    worst = std::max(worst, check.worst());

    const int sign = Sign(&solver, part);
    if (folds == 0) {
      if (points > 1) {
        EXPECT_EQ(sign, sign_before) << points;
      }
      sign_before = sign;
    }
    if (folds == 1 && path.passed_limit_point()) {
      EXPECT_EQ(sign, -sign_before);
    }
  }
  EXPECT_GE(folds, 1);
  EXPECT_GT(beyond, 10);
  std::printf(
      "EI / %g, l_c %g mm: %d points, %d folds, lambda falls to %.4f, ends at "
      "%.4f; worst violation %.1e\n",
      softer, arc, points, folds, lowest, last, worst);
}

TEST(LoadPathTest, GoesOnThroughAFold) {
  FollowThroughTheFold(1, 130, 106.69);
  FollowThroughTheFold(1, 45, 188.15);
  FollowThroughTheFold(1, 115, 161.4);
}

TEST(LoadPathTest, GoesOnThroughAFoldOfASoftFinger) {
  FollowThroughTheFold(10, 130, 106.69);
  FollowThroughTheFold(10, 45, 188.15);
}

}  // namespace
}  // namespace finray
