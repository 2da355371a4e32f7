// Fingers and loads drawn at random: each is solved, and what is solved is in
// equilibrium by an independent integrator.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "finray/statics/equilibrium.h"
#include "finray/statics/load_path.h"
#include "statics/equilibrium_check.h"
#include "statics/random_finger.h"

namespace finray {
namespace {

constexpr int kFingers = 2000;
constexpr double kWorst = 1e-8;

// The sensitivity to the common factor of all forces.
double Slope(EquilibriumSolver* solver, std::vector<PointContact> contacts,
             double fraction) {
  for (PointContact& contact : contacts) contact.normal_N *= fraction;
  if (!solver->SolveWithSensitivities(contacts)) return 0;
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(solver->outputs().size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    slope += contacts[i].normal_N * solver->d_outputs().col(2 * i + 1);
  }
  return slope.norm();
}

// Before a true limit point sensitivities grow with the inverse root of what is
// left to it: by 3.2 here. Rib lengths are those of the path there.
void ExpectFold(const Finger& finger, const std::vector<PointContact>& contacts,
                double limit) {
  Finger part = finger;
  for (Rib& rib : part.ribs) {
    const double nominal = NominalRibLength(finger, rib);
    rib.length_mm = nominal + limit * (rib.length_mm - nominal);
  }
  EquilibriumSolver solver(part, {});
  const double far = Slope(&solver, contacts, limit * (1 - 1e-4));
  solver.Reset();
  const double near = Slope(&solver, contacts, limit * (1 - 1e-5));
  EXPECT_GT(near, 2 * far);
  EXPECT_GT(far, 0);
}

TEST(RandomFingersTest, EverySolveIsAnEquilibriumOrSaysWhyNot) {
  int solved = 0, limit_points = 0, lost = 0, most_iterations = 0;
  long iterations = 0;
  double worst = 0;
  std::string where;
  for (unsigned seed = 0; seed < kFingers; ++seed) {
    SCOPED_TRACE(seed);
    const RandomFinger random(seed);
    EquilibriumSolver solver(random.finger(), {});
    if (!solver.Solve(random.contacts())) {
      EXPECT_FALSE(solver.Why().empty());
      EXPECT_TRUE(solver.state().q.allFinite());
      std::printf("finger %u: %s\n", seed, solver.Why().c_str());
      if (solver.status() == SolveStatus::kLimitPoint) {
        ++limit_points;
        ExpectFold(random.finger(), random.contacts(), solver.path_fraction());
      } else {
        ++lost;
      }
      continue;
    }
    ++solved;
    iterations += solver.iterations();
    most_iterations = std::max(most_iterations, solver.iterations());
    ASSERT_TRUE(solver.outputs().allFinite());
    const EquilibriumCheck check(solver, random.contacts());
    EXPECT_LT(check.worst(), kWorst) << check.what();
    if (check.worst() > worst) {
      worst = check.worst();
      where = check.what() + " of finger " + std::to_string(seed);
    }
  }
  std::printf(
      "%d solved, %d at a limit point, %d lost; iterations %.2f on average, %d "
      "at most; worst violation %.1e (%s)\n",
      solved, limit_points, lost, static_cast<double>(iterations) / solved,
      most_iterations, worst, where.c_str());
  // What is not solved has no equilibrium on the path, which says so.
  EXPECT_GE(solved, 0.995 * kFingers);
  EXPECT_EQ(lost, 0);
}

// What a solve finds, by whatever means, lies on the path of growing loads.
TEST(RandomFingersTest, SolvesStayOnThePathOfGrowingLoads) {
  int compared = 0;
  double worst = 0;
  for (unsigned seed = 0; seed < kFingers; ++seed) {
    SCOPED_TRACE(seed);
    const RandomFinger random(seed);
    EquilibriumSolver solver(random.finger(), {});
    if (!solver.Solve(random.contacts())) continue;
    LadderNewton newton(random.finger(), {});
    double fraction = 0;
    ASSERT_EQ(WalkLoadPath(random.contacts(), &newton, &fraction),
              SolveStatus::kSolved);
    ASSERT_TRUE(newton.Converge(random.contacts(), 1, SweepColumns::kNone));
    LadderState state;
    newton.Save(&state);
    const Eigen::VectorXd q = solver.state().q;
    const double difference = (q - state.q).cwiseAbs().maxCoeff() /
                              std::max(1e-3, q.cwiseAbs().maxCoeff());
    EXPECT_LT(difference, 1e-6);
    worst = std::max(worst, difference);
    ++compared;
  }
  std::printf("%d walks, worst difference %.1e\n", compared, worst);
}

// From a neighbouring load the solver arrives where it does from the
// undeformed finger.
TEST(RandomFingersTest, WarmSolveEqualsColdSolve) {
  int compared = 0;
  double worst = 0;
  for (unsigned seed = 0; compared < 300 && seed < kFingers; ++seed) {
    SCOPED_TRACE(seed);
    RandomFinger random(seed);
    if (random.contacts().empty()) continue;
    std::vector<PointContact> neighbour = random.contacts();
    for (PointContact& contact : neighbour) {
      const double length = BeamLength(random.finger(), contact.side);
      contact.arc_mm = std::clamp(
          contact.arc_mm + random.Uniform(-0.05, 0.05) * length, 0.0, length);
      contact.normal_N *= random.Uniform(0.7, 1.0);
    }
    EquilibriumSolver cold(random.finger(), {}), warm(random.finger(), {});
    if (!cold.Solve(random.contacts()) || !warm.Solve(neighbour)) continue;
    ASSERT_TRUE(warm.Solve(random.contacts()));
    ++compared;
    const double force = std::max(1e-3, cold.state().q.cwiseAbs().maxCoeff());
    double difference =
        (warm.state().q - cold.state().q).cwiseAbs().maxCoeff() / force;
    for (int j = 0; j < cold.model().gauges(); ++j) {
      difference = std::max(
          difference, std::abs(warm.gauge_angle(j) - cold.gauge_angle(j)));
    }
    EXPECT_LT(difference, 1e-7);
    worst = std::max(worst, difference);
  }
  EXPECT_EQ(compared, 300);
  std::printf("%d warm solves, worst difference %.1e\n", compared, worst);
}

}  // namespace
}  // namespace finray
