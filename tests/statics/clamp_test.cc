// Clamps that turn: a closed form, the limit of a rigid one, and energy.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"
#include "statics/equilibrium_values.h"
#include "statics/gauss_legendre.h"
#include "statics/strain_energy.h"
#include "test_finger.h"

namespace finray {
namespace {

Finger Clamped(double front, double back) {
  Finger finger = PaperFinger();
  finger.front_clamp_rad_per_N_mm = front;
  finger.back_clamp_rad_per_N_mm = back;
  return finger;
}

// Two beams without ribs, so upright that the tip moves sideways only: a portal
// frame, whose rigid cap keeps the tips parallel. Beam theory for small loads
// gives both tips the same motion and turn from three unknowns, the shear V,
// the axial force N and the moment M at the back beam's tip.
TEST(ClampTest, ASmallLoadTurnsRootsAsBeamTheorySays) {
  Finger finger = PaperFinger();
  finger.ribs.clear();
  finger.gauges.clear();
  const double front = 1 / 400.0, back = 1 / 250.0;
  finger.front_clamp_rad_per_N_mm = front;
  finger.back_clamp_rad_per_N_mm = back;
  const double force = 1e-6, at = 60;
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({{at, force, 0}}));
  // A beam of length L along t from a clamp of compliance c: a force F and a
  // moment M at the tip bend it across by F L^2 (L / 3 EI + c L) and so on,
  // inextensibly.
  struct Flexibility {
    double across_by_force, turn_by_force, turn_by_moment;
  };
  const auto of = [](double length, double stiffness, double c) {
    return Flexibility{
        length * length * length / (3 * stiffness) + c * length * length,
        length * length / (2 * stiffness) + c * length, length / stiffness + c};
  };
  const double lengths[2] = {BeamLength(finger, Side::kFront),
                             BeamLength(finger, Side::kBack)};
  const double stiffness[2] = {finger.front_stiffness_N_mm2,
                               finger.back_stiffness_N_mm2};
  const Flexibility f[2] = {of(lengths[0], stiffness[0], front),
                            of(lengths[1], stiffness[1], back)};
  // Beams that do not stretch hold a tip that both share: it does not move,
  // and each tip only turns. Moments M_i and forces F_i across with
  //   across_i = 0,   turn_0 = turn_1,   M_0 + M_1 = 0.
  // The load p at a presses the front beam to the right, across its left.
  const double p = -force;
  const double across_by_load =
      p * (at * at * (3 * lengths[0] - at) / (6 * stiffness[0]) +
           front * at * lengths[0]);
  const double turn_by_load = p * (at * at / (2 * stiffness[0]) + front * at);
  // F_i from across_i = 0, then turn_i = own_i + M_i k_i.
  const auto own = [&](int i, double across, double turn) {
    return turn - across * f[i].turn_by_force / f[i].across_by_force;
  };
  const auto by_moment = [&](int i) {
    return f[i].turn_by_moment -
           f[i].turn_by_force * f[i].turn_by_force / f[i].across_by_force;
  };
  const double moment =
      -own(0, across_by_load, turn_by_load) / (by_moment(0) + by_moment(1));
  const double turn = -by_moment(1) * moment;
  EXPECT_NEAR(solver.tip_pose().z() - BeamAngle(finger, Side::kFront), turn,
              1e-6 * std::abs(turn));
  // The root of the front beam turns by its compliance times its moment.
  const double tip_force =
      -(across_by_load + moment * f[0].turn_by_force) / f[0].across_by_force;
  const double root = moment + tip_force * lengths[0] + p * at;
  EXPECT_NEAR(solver.state().q[0], root, 1e-6 * std::abs(root));
  EXPECT_NEAR(solver.state().nodes[0](3, 0) - BeamAngle(finger, Side::kFront),
              front * root, 1e-6 * std::abs(front * root));
}

TEST(ClampTest, AVeryStiffOneIsRigid) {
  const std::vector<PointContact> contacts = {{60, 5, 0.2}};
  EquilibriumSolver rigid(PaperFinger(), {}), stiff(Clamped(1e-13, 1e-13), {}),
      soft(Clamped(1e-3, 1e-3), {});
  ASSERT_TRUE(rigid.Solve(contacts));
  ASSERT_TRUE(stiff.Solve(contacts));
  ASSERT_TRUE(soft.Solve(contacts));
  const auto difference = [&](const EquilibriumSolver& other) {
    return (rigid.outputs() - other.outputs()).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(difference(stiff), 1e-9);
  EXPECT_GT(difference(soft), 0.1);
}

// Integral of F . dr over a load path, against the energy of beams and clamps.
TEST(ClampTest, WorkOfTheContactIsStored) {
  const Finger finger = Clamped(1 / 1500.0, 1 / 700.0);
  const auto energy = [&](const EquilibriumSolver& solver,
                          const std::vector<PointContact>& contacts) {
    double sum = StrainEnergy(solver, contacts);
    for (const Side side : {Side::kFront, Side::kBack}) {
      const double moment = BaseReaction(solver, side)[0];
      sum += ClampCompliance(finger, side) * moment * moment / 2;
    }
    return sum;
  };
  EquilibriumSolver solver(finger, {});
  const double force = 6;
  double work = 0;
  for (const QuadraturePoint& q : GaussLegendre(16, 0, 1)) {
    ASSERT_TRUE(solver.SolveWithSensitivities({{70, force * q.at, 0}}));
    const double theta = solver.contact_pose(0).z();
    const Eigen::Vector2d velocity =
        force * solver.d_outputs().block<2, 1>(solver.model().gauges(), 1);
    work += q.weight * force * q.at *
            Eigen::Vector2d(std::sin(theta), -std::cos(theta)).dot(velocity);
  }
  const std::vector<PointContact> loaded = {{70, force, 0}};
  ASSERT_TRUE(solver.Solve(loaded));
  const double stored = energy(solver, loaded);
  EXPECT_NEAR(work, stored, 1e-6 * stored);
  EXPECT_GT(stored, 1.02 * StrainEnergy(solver, loaded));
}

}  // namespace
}  // namespace finray
