// How exact the equilibrium is: against finer meshes, the other scheme, and a
// solution by other means.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>

#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

using Contacts = std::vector<PointContact>;

Eigen::Vector2d Force(const PointContact& contact, double theta) {
  const Eigen::Vector2d t(std::cos(theta), std::sin(theta));
  return contact.normal_N *
         (Eigen::Vector2d(t.y(), -t.x()) + contact.friction * t);
}

TEST(EquilibriumAccuracyTest, MeshDoublingChangesNothing) {
  const Finger finger = PaperFinger();
  EquilibriumSolver coarse(finger, {}), fine(finger, {Scheme::kTaylor, 48});
  double tip = 0, gauges = 0, ribs = 0;
  for (double arc = 5; arc <= 135; arc += 2.5) {
    for (const double force : {0.05, 0.2, 1.0, 5.0, 10.0, 20.0}) {
      coarse.Reset();
      fine.Reset();
      ASSERT_TRUE(coarse.Solve({{arc, force, 0}}));
      ASSERT_TRUE(fine.Solve({{arc, force, 0}}));
      const auto relative = [](const Eigen::VectorXd& a,
                               const Eigen::VectorXd& b) {
        return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
      };
      gauges = std::max(
          gauges, relative(coarse.outputs().head(4), fine.outputs().head(4)));
      ribs = std::max(
          ribs, relative(coarse.state().q.tail(5), fine.state().q.tail(5)));
      tip = std::max(
          tip, (coarse.tip_pose() - fine.tip_pose()).head<2>().norm() / 140);
    }
  }
  std::printf(
      "mesh doubling, relative: tip %.1e, gauges %.1e, ribs "
      "%.1e\n",
      tip, gauges, ribs);
  EXPECT_LT(tip, 1e-8);
  EXPECT_LT(gauges, 1e-8);
  EXPECT_LT(ribs, 1e-8);
}

TEST(EquilibriumAccuracyTest, RigidChainConvergesToTaylorWithOrderTwo) {
  const Finger finger = PaperFinger();
  const Contacts contacts = {{72.4, 4, 0.1}};
  EquilibriumSolver exact(finger, {Scheme::kTaylor, 60});
  ASSERT_TRUE(exact.Solve(contacts));
  std::printf(
      "rigid_chain:     n   rib error (N)   order   gauge error (rad)\n");
  double before = 0;
  for (int n = 100; n <= 3200; n *= 2) {
    EquilibriumSolver chain(finger, {Scheme::kRigidChain, n});
    ASSERT_TRUE(chain.Solve(contacts));
    const double rib =
        (chain.state().q - exact.state().q).tail(5).cwiseAbs().maxCoeff();
    const double gauge =
        (chain.outputs() - exact.outputs()).head(4).cwiseAbs().maxCoeff();
    const double order = before > 0 ? std::log2(before / rib) : 0;
    std::printf("%18d   %.3e       %.2f    %.2e\n", n, rib, order, gauge);
    if (before > 0) {
      EXPECT_NEAR(order, 2, 0.15);
    }
    // Of order 2 too, times how far from a joint the gauge happens to end.
    EXPECT_LT(gauge, 2.5 / n / n);
    before = rib;
  }
}

TEST(EquilibriumAccuracyTest, WithoutRibsAgreesWithRungeKuttaShooting) {
  Finger finger = PaperFinger();
  finger.ribs.clear();
  finger.back_stiffness_N_mm2 = 9000;
  const PointContact contact = {80, 0.7, 0.2};

  using State = Eigen::Matrix<double, 4, 1>;
  const auto integrate = [](State s, const Eigen::Vector2d& n, double stiffness,
                            double length) {
    constexpr int kSteps = 400;
    const auto rate = [&](const State& at) {
      return State(std::cos(at[2]), std::sin(at[2]), at[3] / stiffness,
                   n.x() * std::sin(at[2]) - n.y() * std::cos(at[2]));
    };
    const double h = length / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const State k1 = rate(s), k2 = rate(s + h / 2 * k1),
                  k3 = rate(s + h / 2 * k2), k4 = rate(s + h * k3);
      s += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return s;
  };
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  State contact_state, tip_state;
  const auto closure = [&](const Vector6& q) {
    State front(0, 0, M_PI / 2, q[0]);
    Eigen::Vector2d n = q.segment<2>(1);
    front = integrate(front, n, finger.front_stiffness_N_mm2, contact.arc_mm);
    contact_state = front;
    n -= Force(contact, front[2]);
    front =
        integrate(front, n, finger.front_stiffness_N_mm2, 140 - contact.arc_mm);
    tip_state = front;
    const Eigen::Vector2d base = BeamBase(finger, Side::kBack);
    const State back = integrate(
        State(base.x(), base.y(), finger.back_angle_rad, q[3]), q.tail<2>(),
        finger.back_stiffness_N_mm2, BeamLength(finger, Side::kBack));
    Vector6 c;
    c << front.head<2>() - back.head<2>(),
        front[2] - back[2] - M_PI / 2 + finger.back_angle_rad,
        front[3] + back[3], n + q.tail<2>();
    return c;
  };
  Vector6 q = Vector6::Zero();
  for (int i = 0; i < 12; ++i) {
    const Vector6 c = closure(q);
    Eigen::Matrix<double, 6, 6> jacobian;
    for (int p = 0; p < 6; ++p) {
      const double h = 1e-5;
      Vector6 up = q, down = q;
      up[p] += h;
      down[p] -= h;
      jacobian.col(p) = (closure(up) - closure(down)) / (2 * h);
    }
    q -= jacobian.partialPivLu().solve(c);
  }
  ASSERT_LT(closure(q).cwiseAbs().maxCoeff(), 1e-9);

  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({contact}));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(solver.contact_pose(0)[i], contact_state[i], 1e-8);
    EXPECT_NEAR(solver.tip_pose()[i], tip_state[i], 1e-8);
  }
}

}  // namespace
}  // namespace finray
