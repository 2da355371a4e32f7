#include "finray/statics/equilibrium.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <functional>

#include "finray/finger/geometry.h"
#include "finray/statics/shape.h"
#include "test_finger.h"

namespace finray {
namespace {

using Contacts = std::vector<PointContact>;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d Force(const PointContact& contact, double theta) {
  const Eigen::Vector2d t(std::cos(theta), std::sin(theta));
  return contact.normal_N *
         (Eigen::Vector2d(t.y(), -t.x()) + contact.friction * t);
}

// The loads that every check is made for.
std::vector<Contacts> Loads() {
  std::vector<Contacts> loads;
  for (double arc = 5; arc <= 135; arc += 13) {
    for (const double force : {0.05, 0.5, 2.0, 8.0, 20.0}) {
      loads.push_back({{arc, force, 0}});
    }
  }
  loads.push_back({{61, 4, 0}});     // on a rib
  loads.push_back({{0, 4, 0}});      // at the base
  loads.push_back({{140, 4, 0.1}});  // at the tip
  loads.push_back({{70, 5, 0.4}});
  loads.push_back({{70, 5, -0.4}});
  loads.push_back({{95, 3, 0.2}, {30, 6, 0}});
  loads.push_back({{60, 1, 0}, {62, 2, 0.1}, {63, 1, 0}, {120, 2, 0}});
  return loads;
}

Finger Prestressed() {
  Finger finger = PaperFinger();
  finger.ribs[1].length_mm += 0.4;
  finger.ribs[3].length_mm -= 0.3;
  finger.back_stiffness_N_mm2 = 15500;
  return finger;
}

TEST(EquilibriumTest, ForcesAndMomentsBalance) {
  for (const Finger& finger : {PaperFinger(), Prestressed()}) {
    for (const Scheme scheme : {Scheme::kTaylor, Scheme::kRigidChain}) {
      EquilibriumSolver solver(finger, {scheme, 0});
      for (const Contacts& contacts : Loads()) {
        solver.Reset();
        ASSERT_TRUE(solver.Solve(contacts));
        Eigen::Vector2d force(0, 0);
        double moment = 0, largest = 0, largest_moment = 0;
        const auto add = [&](const Eigen::Vector2d& at,
                             const Eigen::Vector2d& f, double m) {
          force += f;
          moment += Cross(at, f) + m;
          largest = std::max(largest, f.norm());
          largest_moment = std::max(largest_moment, std::abs(m));
        };
        for (const Side side : {Side::kFront, Side::kBack}) {
          const Eigen::Vector3d reaction = solver.base_reaction(side);
          add(BeamBase(finger, side), reaction.tail<2>(), reaction[0]);
        }
        for (std::size_t c = 0; c < contacts.size(); ++c) {
          const Eigen::Vector3d pose = solver.contact_pose(static_cast<int>(c));
          add(pose.head<2>(), Force(contacts[c], pose.z()), 0);
        }
        EXPECT_LT(force.norm(), 1e-9 * largest);
        EXPECT_LT(std::abs(moment),
                  1e-9 * std::max(largest_moment, 140 * largest));
      }
    }
  }
}

TEST(EquilibriumTest, CutsThroughTheFingerBalance) {
  // A cut through both beams between ribs: what the beams carry across it is
  // what the contacts beyond it apply.
  const Finger finger = Prestressed();
  EquilibriumSolver solver(finger, {});
  for (const Contacts& contacts : Loads()) {
    solver.Reset();
    ASSERT_TRUE(solver.Solve(contacts));
    const Shape shape(solver, contacts);
    for (int bay = 0; bay <= 5; ++bay) {
      const auto middle = [&](Side side) {
        const bool front = side == Side::kFront;
        const auto hinge = [&](int i) {
          return front ? finger.ribs[i].front_mm : finger.ribs[i].back_mm;
        };
        const double low = bay == 0 ? 0 : hinge(bay - 1);
        const double high = bay == 5 ? BeamLength(finger, side) : hinge(bay);
        return 0.5 * (low + high);
      };
      const double front_arc = middle(Side::kFront);
      Eigen::Vector2d force(0, 0);
      double moment = 0;
      for (const Side side : {Side::kFront, Side::kBack}) {
        // What the near part exerts on the far part.
        const Section at = shape.At(side, middle(side));
        const Eigen::Vector2d n(-at.force_x_N, -at.force_y_N);
        force += n;
        moment += Cross({at.x_mm, at.y_mm}, n) - at.moment_N_mm;
      }
      double load = 0;
      for (std::size_t c = 0; c < contacts.size(); ++c) {
        load += contacts[c].normal_N;
        // At the cut itself Shape gives the far side.
        if (contacts[c].arc_mm <= front_arc) continue;
        const Eigen::Vector3d pose = solver.contact_pose(static_cast<int>(c));
        const Eigen::Vector2d f = Force(contacts[c], pose.z());
        force += f;
        moment += Cross(pose.head<2>(), f);
      }
      EXPECT_LT(force.norm(), 1e-8 * (load + 10));
      EXPECT_LT(std::abs(moment), 1e-8 * 140 * (load + 10));
    }
  }
}

TEST(EquilibriumTest, RibsKeepTheirLengthAndTheTipIsClosed) {
  Finger finger = Prestressed();
  finger.ribs[2].axial_stiffness_N = 5000;
  EquilibriumSolver solver(finger, {});
  for (const Contacts& contacts : Loads()) {
    solver.Reset();
    ASSERT_TRUE(solver.Solve(contacts));
    const Shape shape(solver, contacts);
    for (int i = 0; i < 5; ++i) {
      const Rib& rib = finger.ribs[i];
      const Section a = shape.At(Side::kFront, rib.front_mm);
      const Section b = shape.At(Side::kBack, rib.back_mm);
      const double stretched =
          rib.length_mm * (1 + solver.rib_tension(i) / rib.axial_stiffness_N);
      EXPECT_NEAR(std::hypot(b.x_mm - a.x_mm, b.y_mm - a.y_mm), stretched,
                  1e-9);
    }
    const Section front = shape.At(Side::kFront, 140);
    const Section back = shape.At(Side::kBack, BeamLength(finger, Side::kBack));
    EXPECT_NEAR(front.x_mm, back.x_mm, 1e-9);
    EXPECT_NEAR(front.y_mm, back.y_mm, 1e-9);
    EXPECT_NEAR(front.theta_rad - back.theta_rad,
                M_PI / 2 - finger.back_angle_rad, 1e-11);
  }
}

// Nodes and weights of 8-point Gauss-Legendre on [0, 1].
const double kGauss[8][2] = {{0.019855071751231884, 0.050614268145188130},
                             {0.101666761293186630, 0.111190517226687240},
                             {0.237233795041835507, 0.156853322938943640},
                             {0.408282678752175097, 0.181341891689180990},
                             {0.591717321247824903, 0.181341891689180990},
                             {0.762766204958164493, 0.156853322938943640},
                             {0.898333238706813370, 0.111190517226687240},
                             {0.980144928248768116, 0.050614268145188130}};

double StrainEnergy(const EquilibriumSolver& solver, const Contacts& contacts) {
  const Shape shape(solver, contacts);
  double energy = 0;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const std::vector<double> stations = shape.Stations(side);
    for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
      const double h = stations[i + 1] - stations[i];
      for (const auto& [at, weight] : kGauss) {
        const double moment = shape.At(side, stations[i] + at * h).moment_N_mm;
        energy +=
            weight * h * moment * moment / (2 * solver.model().stiffness(side));
      }
    }
  }
  for (int i = 0; i < solver.model().ribs(); ++i) {
    const Rib& rib = solver.model().finger().ribs[i];
    const double tension = solver.rib_tension(i);
    energy += tension * tension * rib.length_mm / (2 * rib.axial_stiffness_N);
  }
  return energy;
}

TEST(EquilibriumTest, WorkAlongTheLoadPathIsStrainEnergy) {
  Finger elastic = PaperFinger();
  elastic.ribs[2].axial_stiffness_N = 300;
  struct Case {
    Finger finger;
    PointContact contact;
  };
  for (const Case& c :
       {Case{PaperFinger(), {55, 6, 0}}, Case{PaperFinger(), {98, 8, 0}},
        Case{PaperFinger(), {75, 15, 0.3}}, Case{elastic, {61, 8, 0}},
        Case{PaperFinger(), {125, 4, -0.2}}}) {
    EquilibriumSolver solver(c.finger, {});
    const int row = solver.model().gauges();
    double work = 0;
    constexpr int kIntervals = 8;
    for (int i = 0; i < kIntervals; ++i) {
      for (const auto& [at, weight] : kGauss) {
        PointContact contact = c.contact;
        contact.normal_N *= (i + at) / kIntervals;
        ASSERT_TRUE(solver.SolveWithSensitivities({contact}));
        // dW = F . dr, the material point being fixed.
        const Eigen::Vector2d motion = solver.d_outputs().block<2, 1>(row, 1);
        work += weight * c.contact.normal_N / kIntervals *
                Force(contact, solver.contact_pose(0).z()).dot(motion);
      }
    }
    ASSERT_TRUE(solver.Solve({c.contact}));
    const double energy = StrainEnergy(solver, {c.contact});
    EXPECT_NEAR(work / energy, 1, 1e-6);
  }
}

TEST(EquilibriumTest, SensitivitiesMatchFiniteDifferences) {
  const Finger finger = Prestressed();
  for (const Scheme scheme : {Scheme::kTaylor, Scheme::kRigidChain}) {
    for (const Contacts& contacts :
         {Contacts{{52.3, 3, 0.2}, {90, 1, -0.1}}, Contacts{{118, 6, 0}},
          Contacts{{25, 9, 0}}}) {
      EquilibriumSolver solver(finger, {scheme, 0});
      ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
      const auto d_outputs = solver.d_outputs();
      const auto d_q = solver.d_q();
      const int by_contact = 2 * static_cast<int>(contacts.size());
      for (int p = 0; p < d_outputs.cols(); ++p) {
        const bool by_stiffness = p == by_contact || p == by_contact + 1;
        const double h = by_stiffness ? 1.0 : 1e-3;
        Eigen::VectorXd outputs[2], q[2];
        for (const int k : {0, 1}) {
          const double d = k == 0 ? -h : h;
          EquilibriumSolver moved(finger, {scheme, 0});
          Contacts there = contacts;
          if (p < by_contact) {
            (p % 2 == 0 ? there[p / 2].arc_mm : there[p / 2].normal_N) += d;
          } else if (by_stiffness) {
            moved.model().set_stiffness(
                finger.front_stiffness_N_mm2 + (p == by_contact) * d,
                finger.back_stiffness_N_mm2 + (p != by_contact) * d);
          } else {
            const int rib = p - by_contact - 2;
            moved.model().set_rib_length(rib, finger.ribs[rib].length_mm + d);
          }
          ASSERT_TRUE(moved.Solve(there));
          outputs[k] = moved.outputs();
          q[k] = moved.state().q;
        }
        const Eigen::VectorXd expected = (outputs[1] - outputs[0]) / (2 * h);
        EXPECT_LT((d_outputs.col(p) - expected).cwiseAbs().maxCoeff(),
                  1e-6 * expected.cwiseAbs().maxCoeff())
            << "column " << p;
        const Eigen::VectorXd expected_q = (q[1] - q[0]) / (2 * h);
        EXPECT_LT((d_q.col(p) - expected_q).cwiseAbs().maxCoeff(),
                  1e-6 * expected_q.cwiseAbs().maxCoeff())
            << "column " << p;
      }
    }
  }
}

TEST(EquilibriumTest, MeshDoublingChangesNothing) {
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

TEST(EquilibriumTest, RigidChainConvergesToTaylorWithOrderTwo) {
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

TEST(EquilibriumTest, OnlyRatiosOfForceToStiffnessBend) {
  Finger stiff = PaperFinger();
  stiff.front_stiffness_N_mm2 *= 7;
  stiff.back_stiffness_N_mm2 *= 7;
  EquilibriumSolver a(PaperFinger(), {}), b(stiff, {});
  ASSERT_TRUE(a.Solve({{80, 3, 0}}));
  ASSERT_TRUE(b.Solve({{80, 21, 0}}));
  EXPECT_LT((a.outputs() - b.outputs()).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_NEAR(b.rib_tension(0) / a.rib_tension(0), 7, 1e-9);
}

TEST(EquilibriumTest, SmallForcesAreLinear) {
  EquilibriumSolver solver(PaperFinger(), {});
  ASSERT_TRUE(solver.Solve({{80, 1e-3, 0}}));
  const Eigen::VectorXd small = solver.outputs().head(4) / 1e-3;
  ASSERT_TRUE(solver.Solve({{80, 1e-9, 0}}));
  const Eigen::VectorXd tiny = solver.outputs().head(4) / 1e-9;
  EXPECT_LT((small - tiny).cwiseAbs().maxCoeff(),
            1e-3 * tiny.cwiseAbs().maxCoeff());
}

TEST(EquilibriumTest, ContactMovesSmoothlyAcrossARibAndAnElement) {
  const Finger finger = PaperFinger();
  EquilibriumSolver solver(finger, {});
  const auto at = [&](double arc) {
    solver.Reset();
    EXPECT_TRUE(solver.Solve({{arc, 5, 0.2}}));
    return solver.outputs();
  };
  for (const double arc : {finger.ribs[2].front_mm, 50.0}) {
    const double d = 1e-7;
    const Eigen::VectorXd slope_before = (at(arc) - at(arc - d)) / d;
    const Eigen::VectorXd slope_after = (at(arc + d) - at(arc)) / d;
    EXPECT_LT((slope_after - slope_before).cwiseAbs().maxCoeff(), 1e-4);
  }
}

TEST(EquilibriumTest, AnImpossibleLoadIsRefusedAndForgotten) {
  EquilibriumSolver solver(PaperFinger(), {});
  EXPECT_FALSE(solver.Solve({{70, 1e9, 0}}));
  EXPECT_FALSE(solver.Solve({{140.5, 2, 0}}));
  EXPECT_FALSE(solver.Solve({{-1, 2, 0}}));
  EXPECT_FALSE(solver.Solve({{std::nan(""), 2, 0}}));
  ASSERT_TRUE(solver.Solve({{70, 2, 0}}));
  EquilibriumSolver fresh(PaperFinger(), {});
  ASSERT_TRUE(fresh.Solve({{70, 2, 0}}));
  EXPECT_LT((solver.outputs() - fresh.outputs()).cwiseAbs().maxCoeff(), 1e-13);
}

// Another route to the same: two beams joined at the tip, no rib, by
// Runge-Kutta from both bases and Newton with finite differences.
TEST(EquilibriumTest, WithoutRibsAgreesWithRungeKuttaShooting) {
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
