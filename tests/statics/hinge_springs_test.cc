// Springs between ribs and beams: balance, energy and derivatives.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "finray/chain/se2.h"
#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"
#include "finray/statics/shape.h"
#include "statics/equilibrium_values.h"
#include "statics/gauss_legendre.h"
#include "statics/rib_ends.h"
#include "statics/strain_energy.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;

Finger Springy(double front, double back) {
  Finger finger = PaperFinger();
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    const double share = 1 + 0.1 * static_cast<double>(i);
    finger.ribs[i].front_hinge_N_mm_per_rad = share * front;
    finger.ribs[i].back_hinge_N_mm_per_rad = share * back;
  }
  finger.ribs[1].axial_stiffness_N = 300;
  finger.ribs[2].length_mm += 0.2;
  return finger;
}

const std::vector<std::vector<PointContact>>& Loads() {
  static const std::vector<std::vector<PointContact>> loads = {
      {},
      {{52.3, 3, 0.2}, {90, 1, -0.1}},
      {{128, 4, 0}},
      {{45, 9, 0.3}},
  };
  return loads;
}

class HingeSpringsTest : public testing::TestWithParam<Scheme> {
 protected:
  Discretization discretization() const { return {GetParam(), 0}; }
};

INSTANTIATE_TEST_SUITE_P(Schemes, HingeSpringsTest,
                         testing::Values(Scheme::kTaylor, Scheme::kRigidChain),
                         [](const auto& info) {
                           return info.param == Scheme::kTaylor
                                      ? std::string("Taylor")
                                      : std::string("RigidChain");
                         });

TEST(HingeSpringsBalanceTest,
     EveryRibIsInBalanceAndItsMomentsAreThoseOfSprings) {
  const Finger finger = Springy(60, 25);
  for (const auto& contacts : Loads()) {
    EquilibriumSolver solver(finger, {});
    ASSERT_TRUE(solver.Solve(contacts));
    const Shape shape(solver, contacts);
    for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
      const Rib& rib = finger.ribs[i];
      const RibEndLoad front = ReadRibEnd(shape, finger, i, Side::kFront),
                       back = ReadRibEnd(shape, finger, i, Side::kBack);
      const auto turns = RibTurns(shape, finger, i);
      EXPECT_NEAR(front.moment, rib.front_hinge_N_mm_per_rad * turns[0], 2e-6);
      EXPECT_NEAR(back.moment, rib.back_hinge_N_mm_per_rad * turns[1], 2e-6);
      EXPECT_LT((front.force + back.force).norm(), 1e-6);
      EXPECT_NEAR(
          front.moment + back.moment + Cross(back.at - front.at, back.force), 0,
          1e-5);
      EXPECT_NEAR((back.at - front.at).normalized().dot(back.force),
                  solver.rib_tension(i), 1e-6);
    }
  }
}

TEST_P(HingeSpringsTest, ReactionsBalanceTheContacts) {
  const Finger finger = Springy(60, 25);
  for (const auto& contacts : Loads()) {
    EquilibriumSolver solver(finger, discretization());
    ASSERT_TRUE(solver.Solve(contacts));
    Vector2d force(0, 0);
    double moment = 0;
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Eigen::Vector3d reaction = BaseReaction(solver, side);
      force += reaction.tail<2>();
      moment += reaction[0] + Cross(BeamBase(finger, side), reaction.tail<2>());
    }
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const Eigen::Vector3d pose = solver.contact_pose(static_cast<int>(c));
      const Vector2d pushed =
          contacts[c].normal_N *
          Vector2d(
              std::sin(pose.z()) + contacts[c].friction * std::cos(pose.z()),
              contacts[c].friction * std::sin(pose.z()) - std::cos(pose.z()));
      force += pushed;
      moment += Cross(pose.head<2>(), pushed);
    }
    EXPECT_LT(force.norm(), 1e-8);
    EXPECT_LT(std::abs(moment), 1e-6);
  }
}

// Integral of F . dr over a load path, against the energy of beams and springs.
TEST(HingeSpringsBalanceTest, WorkOfTheContactIsStored) {
  Finger finger = Springy(60, 25);
  finger.ribs[1].axial_stiffness_N = std::numeric_limits<double>::infinity();
  const std::vector<PointContact> resting = {{70, 0, 0}};
  const auto energy = [&](const EquilibriumSolver& solver,
                          const std::vector<PointContact>& contacts) {
    double sum = StrainEnergy(solver, contacts);
    const Shape shape(solver, contacts);
    for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
      const auto turns = RibTurns(shape, finger, i);
      sum += finger.ribs[i].front_hinge_N_mm_per_rad * turns[0] * turns[0] / 2 +
             finger.ribs[i].back_hinge_N_mm_per_rad * turns[1] * turns[1] / 2;
    }
    return sum;
  };
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve(resting));
  const double before = energy(solver, resting);
  const double force = 6;
  double work = 0;
  for (const QuadraturePoint& q : GaussLegendre(16, 0, 1)) {
    const std::vector<PointContact> part = {{70, force * q.at, 0}};
    ASSERT_TRUE(solver.SolveWithSensitivities(part));
    const double theta = solver.contact_pose(0).z();
    const int row = solver.model().gauges();
    const Vector2d velocity = force * solver.d_outputs().block<2, 1>(row, 1);
    work += q.weight * force * q.at *
            Vector2d(std::sin(theta), -std::cos(theta)).dot(velocity);
  }
  ASSERT_TRUE(solver.Solve({{70, force, 0}}));
  const double stored = energy(solver, {{70, force, 0}}) - before;
  EXPECT_NEAR(work, stored, 1e-6 * stored);

  // The springs take a visible share of it.
  EquilibriumSolver free(PaperFinger(), {});
  ASSERT_TRUE(free.Solve({{70, force, 0}}));
  EXPECT_LT(stored, 0.97 * StrainEnergy(free, {{70, force, 0}}));
}

TEST_P(HingeSpringsTest, VanishWithTheirStiffness) {
  for (const auto& contacts : Loads()) {
    EquilibriumSolver none(Springy(0, 0), discretization()),
        weak(Springy(1e-7, 1e-7), discretization());
    ASSERT_TRUE(none.Solve(contacts));
    ASSERT_TRUE(weak.Solve(contacts));
    EXPECT_LT((none.outputs() - weak.outputs()).cwiseAbs().maxCoeff(), 1e-7);
  }
  EquilibriumSolver straight(PaperFinger(), discretization());
  Finger finger = PaperFinger();
  for (Rib& rib : finger.ribs) rib.front_hinge_N_mm_per_rad = 100;
  EquilibriumSolver resting(finger, discretization());
  ASSERT_TRUE(straight.Solve({}));
  ASSERT_TRUE(resting.Solve({}));
  EXPECT_LT((straight.outputs() - resting.outputs()).cwiseAbs().maxCoeff(),
            1e-10);
}

TEST_P(HingeSpringsTest, SensitivitiesMatchCentralDifferences) {
  Finger finger = Springy(60, 25);
  for (const bool equal : {false, true}) {
    // One stiffness for all is the parameter of calibrations.
    if (equal) {
      SetParameter({FingerParameterKind::kHingeStiffness}, 40, &finger);
    }
    for (const auto& contacts : Loads()) {
      const int n = static_cast<int>(contacts.size());
      const int ribs = static_cast<int>(finger.ribs.size());
      EquilibriumSolver solver(finger, discretization());
      if (equal) {
        solver.model().set_effects({{FingerParameterKind::kHingeStiffness}});
      }
      ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
      ASSERT_EQ(solver.d_outputs().cols(), 2 * n + 2 + ribs + equal);
      for (int p = 0; p < solver.d_outputs().cols(); ++p) {
        const bool arc = p < 2 * n && p % 2 == 0;
        const bool stiffness = p >= 2 * n && p < 2 * n + 2;
        const bool hinge = p == 2 * n + 2 + ribs;
        const double step = arc ? 2e-3 : stiffness ? 5.0 : hinge ? 0.05 : 1e-3;
        Eigen::VectorXd outputs[2];
        for (int k = 0; k < 2; ++k) {
          const double move = step * (k == 0 ? -1 : 1);
          Finger moved = finger;
          std::vector<PointContact> loaded = contacts;
          if (p < 2 * n) {
            (arc ? loaded[p / 2].arc_mm : loaded[p / 2].normal_N) += move;
          } else if (p == 2 * n) {
            moved.front_stiffness_N_mm2 += move;
          } else if (p == 2 * n + 1) {
            moved.back_stiffness_N_mm2 += move;
          } else if (hinge) {
            SetParameter({FingerParameterKind::kHingeStiffness}, 40 + move,
                         &moved);
          } else {
            moved.ribs[p - 2 * n - 2].length_mm += move;
          }
          EquilibriumSolver other(moved, discretization());
          ASSERT_TRUE(other.Solve(loaded));
          outputs[k] = other.outputs();
        }
        const Eigen::VectorXd slope = (outputs[1] - outputs[0]) / (2 * step);
        EXPECT_LT((solver.d_outputs().col(p) - slope).cwiseAbs().maxCoeff(),
                  2e-5 * slope.cwiseAbs().maxCoeff() + 1e-11)
            << "column " << p << " of " << n << " contacts";
      }
    }
  }
}

// The open march, which the weighted form uses, has the same derivatives.
TEST(HingeSpringsBalanceTest, ShotMatchesCentralDifferences) {
  Finger finger = Springy(60, 25);
  SetParameter({FingerParameterKind::kHingeStiffness}, 40, &finger);
  const std::vector<PointContact> contacts = {{67, 4, 0.2}};
  const auto shoot = [&](double stiffness, const Eigen::VectorXd& q,
                         LadderShot* shot) {
    Finger moved = finger;
    SetParameter({FingerParameterKind::kHingeStiffness}, stiffness, &moved);
    EquilibriumSolver solver(moved, {});
    solver.model().set_effects({{FingerParameterKind::kHingeStiffness}});
    ASSERT_TRUE(solver.Shoot(q, contacts, shot));
  };
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve(contacts));
  Eigen::VectorXd q = solver.state().q;
  LadderShot at, low, high;
  shoot(40, q, &at);
  EXPECT_LT(at.closure.cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((at.outputs - solver.outputs()).cwiseAbs().maxCoeff(), 1e-6);
  const Eigen::Index columns = at.d_closure.cols();
  ASSERT_EQ(columns, q.size() + 2 + 2 + 5 + 1);
  shoot(40 - 1e-3, q, &low);
  shoot(40 + 1e-3, q, &high);
  const Eigen::VectorXd by_hinge = (high.closure - low.closure) / 2e-3;
  EXPECT_LT((at.d_closure.col(columns - 1) - by_hinge).cwiseAbs().maxCoeff(),
            1e-5 * by_hinge.cwiseAbs().maxCoeff());
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const double step = 1e-5;
    Eigen::VectorXd moved = q;
    moved[j] += step;
    shoot(40, moved, &high);
    moved[j] -= 2 * step;
    shoot(40, moved, &low);
    const Eigen::VectorXd slope = (high.closure - low.closure) / (2 * step);
    EXPECT_LT((at.d_closure.col(j) - slope).cwiseAbs().maxCoeff(),
              1e-4 * slope.cwiseAbs().maxCoeff())
        << j;
  }
}

}  // namespace
}  // namespace finray
