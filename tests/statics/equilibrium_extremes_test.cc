// Stiffness, forces, sizes and resolutions far from the usual: what is solved
// is in equilibrium by an independent integrator, what is not says why.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"
#include "statics/equilibrium_check.h"
#include "statics/special_cases.h"

namespace finray {
namespace {

// Solves and checks, or sees a reason. True if solved.
bool SolvesOrSaysWhy(EquilibriumSolver* solver,
                     const std::vector<PointContact>& contacts, double* worst) {
  if (!solver->Solve(contacts)) {
    EXPECT_EQ(solver->status(), SolveStatus::kLimitPoint) << solver->Why();
    EXPECT_GT(solver->path_fraction(), 0);
    EXPECT_LT(solver->path_fraction(), 1);
    EXPECT_TRUE(solver->state().q.allFinite());
    return false;
  }
  EXPECT_TRUE(solver->outputs().allFinite());
  const EquilibriumCheck check(*solver, contacts);
  EXPECT_LT(check.worst(), 1e-8) << check.what();
  *worst = std::max(*worst, check.worst());
  return true;
}

Finger Scaled(Finger finger, double stiffness) {
  finger.front_stiffness_N_mm2 *= stiffness;
  finger.back_stiffness_N_mm2 *= stiffness;
  return finger;
}

// Wide enough that a check which always passes would be found out.
TEST(EquilibriumCheckTest, SeesWhatIsWrong) {
  const std::vector<PointContact> contacts = {{70, 2, 0.1}};
  EquilibriumSolver solver(PaperFinger(), {});
  ASSERT_TRUE(solver.Solve(contacts));
  EXPECT_LT(EquilibriumCheck(solver, contacts).worst(), 1e-9);
  EXPECT_GT(EquilibriumCheck(solver, {{70, 2.00001, 0.1}}).worst(), 1e-7);
  EXPECT_GT(EquilibriumCheck(solver, {{70.001, 2, 0.1}}).worst(), 1e-7);
  solver.model().set_stiffness(12500, 12501);
  EXPECT_GT(EquilibriumCheck(solver, contacts).worst(), 1e-8);
  EquilibriumSolver coarse(PaperFinger(), {Scheme::kTaylor4, 20});
  ASSERT_TRUE(coarse.Solve(contacts));
  EXPECT_GT(EquilibriumCheck(coarse, contacts).worst(), 1e-8);
}

TEST(ExtremesTest, StiffnessAndForceOverManyDecades) {
  int solved = 0, folded = 0;
  double worst = 0;
  for (const double stiffness : {1e-3, 1e-2, 0.1, 1.0, 10.0, 1e3}) {
    EquilibriumSolver solver(Scaled(PaperFinger(), stiffness), {});
    for (const double arc : {3.0, 25.0, 50.0, 61.0, 88.8, 110.0, 131.0}) {
      for (const double force :
           {1e-9, 1e-6, 1e-3, 0.1, 1.0, 5.0, 20.0, 60.0, 200.0}) {
        SCOPED_TRACE(testing::Message() << "EI x " << stiffness << ", " << force
                                        << " N at " << arc << " mm");
        solver.Reset();
        (SolvesOrSaysWhy(&solver, {{arc, force, 0}}, &worst) ? solved
                                                             : folded) += 1;
      }
    }
  }
  std::printf("%d solved, %d with a limit point; worst violation %.1e\n",
              solved, folded, worst);
  EXPECT_GT(solved, 300);
}

TEST(ExtremesTest, TinyForcesActLinearly) {
  EquilibriumSolver solver(PaperFinger(), {});
  const int gauges = solver.model().gauges();
  double worst_rad = 0, worst_N = 0;
  for (const double arc : {0.5, 20.0, 61.0, 95.0, 136.0}) {
    SCOPED_TRACE(arc);
    ASSERT_TRUE(solver.SolveWithSensitivities({{arc, 0, 0}}));
    const Eigen::VectorXd gauge_slope = solver.d_outputs().col(1).head(gauges);
    Eigen::VectorXd ribs[2];
    for (int k = 0; k < 2; ++k) {
      ASSERT_TRUE(solver.Solve({{arc, k == 0 ? -1e-4 : 1e-4, 0}}));
      ribs[k] = solver.state().q.tail(5);
    }
    const Eigen::VectorXd rib_slope = (ribs[1] - ribs[0]) / 2e-4;
    // Beside what is not linear there is rounding: of angles, which are kept as
    // such and not as changes, and of rib lengths in stiff bays.
    for (const double force : {1e-9, 1e-8, 1e-6, 1e-5}) {
      SCOPED_TRACE(force);
      ASSERT_TRUE(solver.Solve({{arc, force, 0}}));
      const double gauge =
          (solver.outputs().head(gauges) - force * gauge_slope).norm();
      const double rib = (solver.state().q.tail(5) - force * rib_slope).norm();
      EXPECT_LT(gauge, 4e-15 + force * force * gauge_slope.norm());
      EXPECT_LT(rib, 4e-12 + force * force * rib_slope.norm());
      worst_rad = std::max(worst_rad, force < 1e-7 ? gauge : 0);
      worst_N = std::max(worst_N, force < 1e-7 ? rib : 0);
    }
    // The same from the other end of the linear range, by differences.
    Eigen::VectorXd sides[2];
    for (int k = 0; k < 2; ++k) {
      ASSERT_TRUE(solver.Solve({{arc, k == 0 ? -1e-3 : 1e-3, 0}}));
      sides[k] = solver.outputs().head(gauges);
    }
    EXPECT_LT(((sides[1] - sides[0]) / 2e-3 - gauge_slope).norm(),
              1e-6 * gauge_slope.norm());
  }
  std::printf("up to 1e-8 N: gauges within %.1e rad, ribs within %.1e N\n",
              worst_rad, worst_N);
}

TEST(ExtremesTest, ChainsOfFourToTwentyThousandLinks) {
  const std::vector<PointContact> contacts = {{70, 1, 0.1}};
  Finger bare = PaperFinger();
  bare.ribs.clear();
  for (const Finger& finger : {PaperFinger(), bare}) {
    EquilibriumSolver exact(finger, {Scheme::kTaylor, 200});
    ASSERT_TRUE(exact.Solve(contacts));
    double last = 0;
    for (const int links : {4, 16, 100, 400, 2000, 20000}) {
      SCOPED_TRACE(links);
      EquilibriumSolver chain(finger, {Scheme::kRigidChain, links});
      ASSERT_TRUE(chain.Solve(contacts));
      EXPECT_LE(chain.iterations(), 8);
      EXPECT_TRUE(chain.outputs().allFinite());
      const double error =
          (chain.tip_pose() - exact.tip_pose()).head<2>().norm();
      // Of second order.
      if (links >= 400) {
        EXPECT_LT(error, 0.2 * last);
      }
      if (links == 20000) {
        EXPECT_LT(error, 1e-5);
        std::printf("20 000 links: tip off by %.1e mm\n", error);
      }
      last = error;
    }
  }
}

TEST(ExtremesTest, OneToTwoThousandTaylorElements) {
  const std::vector<PointContact> contacts = {{70, 8, 0.1}};
  EquilibriumSolver exact(PaperFinger(), {});
  ASSERT_TRUE(exact.Solve(contacts));
  double worst = 0;
  for (const int elements : {1, 2, 10, 24, 100, 500, 2000}) {
    SCOPED_TRACE(elements);
    EquilibriumSolver solver(PaperFinger(), {Scheme::kTaylor, elements});
    ASSERT_TRUE(solver.Solve(contacts));
    EXPECT_LE(solver.iterations(), 8);
    const double error =
        (solver.outputs() - exact.outputs()).cwiseAbs().maxCoeff();
    EXPECT_LT(error, elements < 24 ? 1e-4 : 1e-9);
    if (elements >= 24) worst = std::max(worst, error);
  }
  std::printf("24 to 2000 elements: outputs within %.1e\n", worst);
}

TEST(ExtremesTest, SoftFingersKeepQuadraticConvergence) {
  // exp(sqrt(N L^2 / EI)) is 1e14 over a beam here and more with its ribs.
  const Finger soft = Scaled(PaperFinger(), 1e-3);
  int most = 0;
  double worst = 0, worst_slope = 0;
  for (const double arc : {10.0, 50.0, 75.0, 90.0}) {
    for (const double force : {0.02, 0.2, 1.0, 20.0, 40.0}) {
      SCOPED_TRACE(testing::Message() << force << " N at " << arc);
      const std::vector<PointContact> contacts = {{arc, force, 0}};
      EquilibriumSolver solver(soft, {});
      if (!SolvesOrSaysWhy(&solver, contacts, &worst)) continue;
      // Warm from a load a hundredth beside.
      ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
      const Eigen::VectorXd outputs = solver.outputs();
      const Eigen::VectorXd slope = solver.d_outputs().col(1);
      ASSERT_TRUE(solver.Solve({{arc, 1.01 * force, 0}}));
      most = std::max(most, solver.iterations());
      EXPECT_LE(solver.iterations(), 8);
      const double step = 1e-4 * force;
      Eigen::VectorXd sides[2];
      for (int k = 0; k < 2; ++k) {
        ASSERT_TRUE(solver.Solve({{arc, force + (k == 0 ? -step : step), 0}}));
        sides[k] = solver.outputs();
      }
      const Eigen::VectorXd numeric = (sides[1] - sides[0]) / (2 * step);
      const double error = (numeric - slope).norm() / slope.norm();
      EXPECT_LT(error, 1e-5);
      worst_slope = std::max(worst_slope, error);
    }
  }
  std::printf(
      "soft fingers: at most %d iterations warm, violation %.1e, slopes within "
      "%.1e\n",
      most, worst, worst_slope);
}

TEST(ExtremesTest, AbsurdLoadsLeaveNoTrace) {
  const std::vector<PointContact> sane = {{70, 2, 0.1}};
  EquilibriumSolver fresh(PaperFinger(), {});
  ASSERT_TRUE(fresh.Solve(sane));
  const double inf = std::numeric_limits<double>::infinity();
  EquilibriumSolver solver(PaperFinger(), {});
  for (const PointContact& absurd :
       {PointContact{70, std::nan(""), 0}, PointContact{70, inf, 0},
        PointContact{70, 1e6, 0}, PointContact{70, -1e6, 0},
        PointContact{70, 1e300, 0}, PointContact{70, 1, inf},
        PointContact{70, 1e300, 1e300}, PointContact{std::nan(""), 1, 0},
        PointContact{inf, 1, 0}}) {
    EXPECT_FALSE(solver.Solve({absurd})) << absurd.normal_N;
    EXPECT_NE(solver.status(), SolveStatus::kSolved);
    EXPECT_FALSE(solver.Why().empty());
    ASSERT_TRUE(solver.Solve(sane));
    EXPECT_EQ(solver.outputs(), fresh.outputs());
    EXPECT_EQ(solver.iterations(), fresh.iterations());
  }
}

// A path without a limit point, along which ever more elements are needed.
TEST(ExtremesTest, PathsToAbsurdLoadsEndSoon) {
  for (const double arc : {36.0, 136.0}) {
    EquilibriumSolver solver(PaperFinger(), {});
    EXPECT_FALSE(solver.Solve({{arc, -1e17, 0}}));
    EXPECT_EQ(solver.status(), SolveStatus::kNotConverged);
    EXPECT_LT(solver.iterations(), 3000) << arc;
  }
}

}  // namespace
}  // namespace finray
