// Ribs that bend: balance, energy, derivatives and limits.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "finray/chain/se2.h"
#include "finray/finger/geometry.h"
#include "finray/ladder/rib_law.h"
#include "finray/statics/equilibrium.h"
#include "finray/statics/shape.h"
#include "statics/equilibrium_values.h"
#include "statics/gauss_legendre.h"
#include "statics/random_finger.h"
#include "statics/rib_ends.h"
#include "statics/strain_energy.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;
constexpr double kWelded = std::numeric_limits<double>::infinity();

void Bend(Rib* rib, double stiffness, double front_hinge, double back_hinge) {
  rib->bending_stiffness_N_mm2 = stiffness;
  rib->front_hinge_N_mm_per_rad = front_hinge;
  rib->back_hinge_N_mm_per_rad = back_hinge;
}

// A rib on hinges, a welded one with rigid ends, one on springs and
// prestressed, one that is welded in front alone, and a rigid one on springs.
Finger Bending() {
  Finger finger = PaperFinger();
  std::vector<Rib>& ribs = finger.ribs;
  Bend(&ribs[1], 3000, kWelded, kWelded);
  ribs[1].front_rigid_mm = 1;
  ribs[1].back_rigid_mm = 1.5;
  Bend(&ribs[2], 2500, 300, 150);
  ribs[2].length_mm += 0.1;
  Bend(&ribs[3], 1500, kWelded, 200);
  ribs[3].axial_stiffness_N = 2000;
  ribs[4].front_hinge_N_mm_per_rad = 60;
  return finger;
}

const std::vector<std::vector<PointContact>>& BendingLoads() {
  static const std::vector<std::vector<PointContact>> loads = {
      {}, {{52.3, 2, 0.2}, {90, 1, -0.1}}, {{120, 2, 0}}, {{45, 5, 0.3}}};
  return loads;
}

// The energy of a rib that does not stretch: Phi - T dPhi/dT.
double RibEnergy(const EquilibriumSolver& solver, const Shape& shape, int i) {
  const Finger& finger = solver.model().finger();
  const Rib& rib = finger.ribs[i];
  const RibLaw law = {
      rib.length_mm,
      rib.Bends() ? rib.bending_stiffness_N_mm2 : 0,
      {rib.front_rigid_mm, rib.back_rigid_mm},
      {rib.front_hinge_N_mm_per_rad, rib.back_hinge_N_mm_per_rad}};
  const auto turn = RibTurns(shape, finger, i);
  const double tension = solver.rib_tension(i);
  const RibReaction at = React(law, tension, turn.data(), false);
  return (at.moment[0] * turn[0] + at.moment[1] * turn[1]) / 2 -
         tension * at.bow;
}

TEST(BendingRibsTest, EveryRibIsInBalance) {
  const Finger finger = Bending();
  for (const auto& contacts : BendingLoads()) {
    EquilibriumSolver solver(finger, {});
    ASSERT_TRUE(solver.Solve(contacts)) << solver.Why();
    const Shape shape(solver, contacts);
    for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
      const RibEndLoad front = ReadRibEnd(shape, finger, i, Side::kFront),
                       back = ReadRibEnd(shape, finger, i, Side::kBack);
      EXPECT_LT((front.force + back.force).norm(), 1e-6);
      EXPECT_NEAR(
          front.moment + back.moment + Cross(back.at - front.at, back.force), 0,
          1e-5);
      EXPECT_NEAR((back.at - front.at).normalized().dot(back.force),
                  solver.rib_tension(i), 1e-6);
    }
    // A welded rib bends and becomes shorter by it.
    if (contacts.empty()) continue;
    const RibEndLoad front = ReadRibEnd(shape, finger, 1, Side::kFront),
                     back = ReadRibEnd(shape, finger, 1, Side::kBack);
    EXPECT_GT(std::abs(front.moment), 0.5);
    EXPECT_LT((back.at - front.at).norm(), finger.ribs[1].length_mm - 1e-6);
  }
}

TEST(BendingRibsTest, ReactionsBalanceTheContacts) {
  for (const Scheme scheme : {Scheme::kTaylor, Scheme::kRigidChain}) {
    for (const auto& contacts : BendingLoads()) {
      EquilibriumSolver solver(Bending(), {scheme, 0});
      ASSERT_TRUE(solver.Solve(contacts)) << solver.Why();
      Vector2d force(0, 0);
      double moment = 0;
      for (const Side side : {Side::kFront, Side::kBack}) {
        const Eigen::Vector3d reaction = BaseReaction(solver, side);
        force += reaction.tail<2>();
        moment += reaction[0] + Cross(BeamBase(solver.model().finger(), side),
                                      reaction.tail<2>());
      }
      for (std::size_t c = 0; c < contacts.size(); ++c) {
        const Eigen::Vector3d pose = solver.contact_pose(static_cast<int>(c));
        const double mu = contacts[c].friction;
        const Vector2d pushed =
            contacts[c].normal_N *
            Vector2d(std::sin(pose.z()) + mu * std::cos(pose.z()),
                     mu * std::sin(pose.z()) - std::cos(pose.z()));
        force += pushed;
        moment += Cross(pose.head<2>(), pushed);
      }
      EXPECT_LT(force.norm(), 1e-8);
      EXPECT_LT(std::abs(moment), 1e-6);
    }
  }
}

TEST(BendingRibsTest, WorkOfTheContactIsStored) {
  Finger finger = Bending();
  finger.ribs[3].axial_stiffness_N = kWelded;
  const auto energy = [&](const EquilibriumSolver& solver,
                          const std::vector<PointContact>& contacts) {
    double sum = StrainEnergy(solver, contacts);
    const Shape shape(solver, contacts);
    for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
      sum += RibEnergy(solver, shape, i);
    }
    return sum;
  };
  const std::vector<PointContact> resting = {{70, 0, 0}},
                                  pressed = {{70, 4, 0}};
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve(resting));
  const double before = energy(solver, resting);
  double work = 0;
  for (const QuadraturePoint& q : GaussLegendre(16, 0, 1)) {
    const double force = 4 * q.at;
    ASSERT_TRUE(solver.SolveWithSensitivities({{70, force, 0}}));
    const double theta = solver.contact_pose(0).z();
    const Vector2d velocity =
        4 * solver.d_outputs().block<2, 1>(solver.model().gauges(), 1);
    work += q.weight * force *
            Vector2d(std::sin(theta), -std::cos(theta)).dot(velocity);
  }
  ASSERT_TRUE(solver.Solve(pressed));
  const double stored = energy(solver, pressed) - before;
  EXPECT_NEAR(work, stored, 1e-6 * stored);
  EXPECT_GT(stored, 1.02 * (StrainEnergy(solver, pressed) - before));
}

// All parameters of the finger that statics knows, and the contacts.
TEST(BendingRibsTest, SensitivitiesMatchCentralDifferences) {
  Finger finger = Bending();
  for (Rib& rib : finger.ribs) {
    rib.front_hinge_N_mm_per_rad = rib.back_hinge_N_mm_per_rad = 250;
  }
  const std::vector<FingerParameter> effects = {
      {FingerParameterKind::kHingeStiffness},
      {FingerParameterKind::kRibBending},
      {FingerParameterKind::kFrontHinge, 1},
      {FingerParameterKind::kBackHinge, 2},
      {FingerParameterKind::kBackAngle}};
  const double steps[] = {1e-2, 0.1, 1e-4, 1e-4, 1e-4};
  const int ribs = static_cast<int>(finger.ribs.size());
  for (const auto& contacts : BendingLoads()) {
    const int n = static_cast<int>(contacts.size());
    EquilibriumSolver solver(finger, {});
    solver.model().set_effects(effects);
    ASSERT_TRUE(solver.SolveWithSensitivities(contacts)) << solver.Why();
    const auto expect_slope = [&](int column, double step, const auto& change) {
      Eigen::VectorXd outputs[2];
      for (int k = 0; k < 2; ++k) {
        Finger moved = finger;
        std::vector<PointContact> loaded = contacts;
        change(k == 0 ? -step : step, &moved, &loaded);
        EquilibriumSolver other(moved, {});
        ASSERT_TRUE(other.Solve(loaded));
        outputs[k] = other.outputs();
      }
      const Eigen::VectorXd slope = (outputs[1] - outputs[0]) / (2 * step);
      EXPECT_LT((solver.d_outputs().col(column) - slope).cwiseAbs().maxCoeff(),
                3e-5 * slope.cwiseAbs().maxCoeff() + 1e-9)
          << "column " << column << " of " << n << " contacts";
    };
    for (int c = 0; c < n; ++c) {
      expect_slope(2 * c, 1e-4, [c](double by, Finger*, auto* loaded) {
        (*loaded)[c].arc_mm += by;
      });
      expect_slope(2 * c + 1, 1e-4, [c](double by, Finger*, auto* loaded) {
        (*loaded)[c].normal_N += by;
      });
    }
    for (int i = 0; i < ribs; ++i) {
      expect_slope(2 * n + 2 + i, 1e-4, [i](double by, Finger* moved, auto*) {
        moved->ribs[i].length_mm += by;
      });
    }
    for (std::size_t k = 0; k < effects.size(); ++k) {
      expect_slope(2 * n + 2 + ribs + static_cast<int>(k), steps[k],
                   [&](double by, Finger* moved, auto*) {
                     SetParameter(effects[k],
                                  ParameterValue(finger, effects[k]) + by,
                                  moved);
                   });
    }
  }
}

// The open march, which the weighted form uses.
TEST(BendingRibsTest, ShotMatchesCentralDifferences) {
  const std::vector<PointContact> contacts = {{67, 3, 0.2}};
  EquilibriumSolver solver(Bending(), {});
  solver.model().set_effects({{FingerParameterKind::kRibBending}});
  ASSERT_TRUE(solver.Solve(contacts));
  const Eigen::VectorXd outputs = solver.outputs(), q = solver.state().q;
  LadderShot at, low, high;
  ASSERT_TRUE(solver.Shoot(q, contacts, &at));
  EXPECT_LT(at.closure.cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((at.outputs - outputs).cwiseAbs().maxCoeff(), 1e-6);
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    Eigen::VectorXd moved = q;
    moved[j] += 1e-5;
    ASSERT_TRUE(solver.Shoot(moved, contacts, &high));
    moved[j] -= 2e-5;
    ASSERT_TRUE(solver.Shoot(moved, contacts, &low));
    const Eigen::VectorXd slope = (high.closure - low.closure) / 2e-5;
    EXPECT_LT((at.d_closure.col(j) - slope).cwiseAbs().maxCoeff(),
              1e-4 * slope.cwiseAbs().maxCoeff())
        << j;
  }
}

TEST(BendingRibsTest, HasTheLimitsOfHingesAndOfSprings) {
  Finger hinged = PaperFinger(), sprung = PaperFinger();
  Finger loose = hinged, stiff = hinged;
  for (std::size_t i = 0; i < hinged.ribs.size(); ++i) {
    const double k = 50 + 20.0 * static_cast<double>(i);
    sprung.ribs[i].front_hinge_N_mm_per_rad = k;
    sprung.ribs[i].back_hinge_N_mm_per_rad = 2 * k;
    Bend(&loose.ribs[i], 1e6, 1e-7, 1e-7);
    Bend(&stiff.ribs[i], 1e12, k, 2 * k);
  }
  for (const auto& contacts : BendingLoads()) {
    const auto outputs = [&](const Finger& finger) {
      EquilibriumSolver solver(finger, {});
      EXPECT_TRUE(solver.Solve(contacts)) << solver.Why();
      return solver.outputs();
    };
    EXPECT_LT((outputs(hinged) - outputs(loose)).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT((outputs(sprung) - outputs(stiff)).cwiseAbs().maxCoeff(), 1e-6);
  }
}

// Where it is pressed a thin rib buckles: there is no number then.
TEST(BendingRibsTest, RefusesARibThatBuckles) {
  Finger finger = PaperFinger();
  for (Rib& rib : finger.ribs) Bend(&rib, 3000, kWelded, kWelded);
  const std::vector<PointContact> contacts = {{52.3, 4, 0}};
  EquilibriumSolver firm(finger, {});
  ASSERT_TRUE(firm.Solve(contacts)) << firm.Why();
  double lowest = 0;
  int pressed = 0;
  for (int i = 0; i < firm.model().ribs(); ++i) {
    if (firm.rib_tension(i) >= lowest) continue;
    lowest = firm.rib_tension(i);
    pressed = i;
  }
  ASSERT_LT(lowest, -0.1);
  const double length = finger.ribs[pressed].length_mm;
  finger.ribs[pressed].bending_stiffness_N_mm2 =
      -lowest * length * length / (4 * M_PI * M_PI) / 3;
  EquilibriumSolver soft(finger, {});
  if (soft.Solve(contacts)) {
    // Other ribs may take over, but below the buckling load.
    EXPECT_GT(soft.rib_tension(pressed), lowest / 3);
  } else {
    EXPECT_FALSE(soft.Why().empty());
  }
  finger.ribs[pressed].bending_stiffness_N_mm2 *= 0.01;
  EquilibriumSolver softer(finger, {});
  if (softer.Solve(contacts)) {
    EXPECT_GT(softer.rib_tension(pressed), lowest / 300);
  }
}

// Any finger is solved in balance or refused.
TEST(BendingRibsTest, RandomFingersAreInBalanceOrRefused) {
  int solved = 0, refused = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    RandomFinger random(seed);
    Finger finger = random.finger();
    if (finger.ribs.empty()) continue;
    for (Rib& rib : finger.ribs) {
      const double stiffness =
          std::exp(random.Uniform(std::log(1e-3), std::log(2.0))) *
          std::min(finger.front_stiffness_N_mm2, finger.back_stiffness_N_mm2);
      const double hinge = random.Uniform(0, 3);
      Bend(&rib, stiffness, hinge < 1 ? kWelded : 100 * hinge,
           hinge < 2 ? kWelded : 50);
      if (hinge > 1) rib.front_rigid_mm = 0.05 * rib.length_mm;
    }
    EquilibriumSolver solver(finger, {});
    if (!solver.Solve(random.contacts())) {
      EXPECT_FALSE(solver.Why().empty());
      ++refused;
      continue;
    }
    ++solved;
    const Shape shape(solver, random.contacts());
    double force = 0;
    for (const PointContact& contact : random.contacts()) {
      force += std::abs(contact.normal_N);
    }
    for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
      force = std::max(force, std::abs(solver.rib_tension(i)));
    }
    const double moment = 1e-5 * (force + 1e-2) * finger.front_length_mm;
    for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
      const Rib& rib = finger.ribs[i];
      const RibEndLoad front = ReadRibEnd(shape, finger, i, Side::kFront),
                       back = ReadRibEnd(shape, finger, i, Side::kBack);
      EXPECT_NEAR(
          front.moment + back.moment + Cross(back.at - front.at, back.force), 0,
          moment)
          << "seed " << seed << " rib " << i;
      const double bent =
          rib.length_mm - rib.front_rigid_mm - rib.back_rigid_mm;
      EXPECT_GT(solver.rib_tension(i),
                -4 * M_PI * M_PI * rib.bending_stiffness_N_mm2 / (bent * bent));
    }
  }
  std::printf("%d fingers with bending ribs solved, %d refused\n", solved,
              refused);
  EXPECT_GT(solved, 2 * refused);
}

}  // namespace
}  // namespace finray
