// Places of hinges, the back angle, clamps and surfaces as effects of a model:
// against a finger that is built with the same values, and derivatives.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

using Kind = FingerParameterKind;

std::vector<FingerParameter> AllEffects() {
  std::vector<FingerParameter> effects;
  for (const Kind kind : {Kind::kFrontHinge, Kind::kBackHinge}) {
    for (int i = 0; i < 5; ++i) effects.push_back({kind, i});
  }
  for (const Kind kind : {Kind::kFrontClamp, Kind::kBackClamp, Kind::kBackAngle,
                          Kind::kSurfaceOffset}) {
    effects.push_back({kind});
  }
  return effects;
}

double StepOf(Kind kind) { return IsAtLeastZero(kind) ? 5e-7 : 1e-3; }

// Springs, pieces, stretch, prestress and a gauge on either beam.
Finger RichFinger(Scheme scheme) {
  Finger finger = PaperFinger();
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    finger.ribs[i].front_hinge_N_mm_per_rad = 40 + 10.0 * i;
    finger.ribs[i].back_hinge_N_mm_per_rad = 70 - 10.0 * i;
  }
  finger.ribs[1].axial_stiffness_N = 300;
  finger.ribs[2].length_mm += 0.2;
  finger.front_pieces = {{30, 1}, {75, 0.8}, {140, 1.1}};
  finger.back_pieces = {{60, 1}, {BeamLength(finger, Side::kBack), 0.8}};
  finger.gauges[0].beam = Side::kFront;
  finger.front_clamp_rad_per_N_mm = 2e-4;
  finger.back_clamp_rad_per_N_mm = 3e-4;
  finger.front_surface_mm = 0.8;
  finger.back_surface_mm = 0.4;
  if (scheme == Scheme::kTaylor) finger.front_axial_stiffness_N = 2000;
  return finger;
}

const std::vector<std::vector<PointContact>>& MovedLoads() {
  static const std::vector<std::vector<PointContact>> loads = {
      {},
      {{52.3, 3, 0.2}, {90, 1, -0.1}},
      {{17.01, 4, 0}},
      {{70, 4, 0.3}, {100.2, 1, 0.2, Side::kBack}},
      {{138, 1, 0.1}},
  };
  return loads;
}

class MovedFingerTest : public testing::TestWithParam<Scheme> {
 protected:
  Discretization discretization() const { return {GetParam(), 0}; }
};

INSTANTIATE_TEST_SUITE_P(Schemes, MovedFingerTest,
                         testing::Values(Scheme::kTaylor, Scheme::kRigidChain),
                         [](const auto& info) {
                           return info.param == Scheme::kTaylor
                                      ? std::string("Taylor")
                                      : std::string("RigidChain");
                         });

TEST_P(MovedFingerTest, SensitivitiesMatchCentralDifferences) {
  const Finger finger = RichFinger(GetParam());
  const std::vector<FingerParameter> effects = AllEffects();
  for (const auto& contacts : MovedLoads()) {
    EquilibriumSolver solver(finger, discretization());
    solver.model().set_effects(effects, true);
    ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
    const int first = 2 * static_cast<int>(contacts.size()) + 2 + 5;
    ASSERT_EQ(solver.d_outputs().cols(), first + 14 + 1);
    for (int p = 0; p < 14; ++p) {
      const double step = StepOf(effects[p].kind);
      Eigen::VectorXd outputs[2];
      for (int k = 0; k < 2; ++k) {
        Finger moved = finger;
        SetParameter(
            effects[p],
            ParameterValue(finger, effects[p]) + (k == 0 ? -step : step),
            &moved);
        EquilibriumSolver other(moved, discretization());
        ASSERT_TRUE(other.Solve(contacts));
        outputs[k] = other.outputs();
      }
      const Eigen::VectorXd slope = (outputs[1] - outputs[0]) / (2 * step);
      EXPECT_LT(
          (solver.d_outputs().col(first + p) - slope).cwiseAbs().maxCoeff(),
          1e-4 * slope.cwiseAbs().maxCoeff() + 1e-10)
          << ParameterName(effects[p]) << ", " << contacts.size()
          << " contacts\n"
          << solver.d_outputs().col(first + p).transpose() << "\n"
          << slope.transpose();
    }
    // Friction has the lever of the surface.
    if (contacts.empty()) continue;
    Eigen::VectorXd outputs[2];
    for (int k = 0; k < 2; ++k) {
      std::vector<PointContact> rubbed = contacts;
      for (PointContact& c : rubbed) c.friction += k == 0 ? -1e-4 : 1e-4;
      EquilibriumSolver other(finger, discretization());
      ASSERT_TRUE(other.Solve(rubbed));
      outputs[k] = other.outputs();
    }
    const Eigen::VectorXd slope = (outputs[1] - outputs[0]) / 2e-4;
    EXPECT_LT(
        (solver.d_outputs().col(first + 14) - slope).cwiseAbs().maxCoeff(),
        2e-5 * slope.cwiseAbs().maxCoeff());
  }
}

// A model whose effects are set is the model of that finger, from any state.
TEST_P(MovedFingerTest, ASetEffectIsThatFinger) {
  const Finger finger = RichFinger(GetParam());
  const std::vector<FingerParameter> effects = AllEffects();
  const double moves[] = {0.5, -0.5, 0.4,  0.5,  -0.5,  0.5, -0.3,
                          0.5, 0.5,  -0.5, 1e-4, -2e-4, 0.7, -0.5};
  Finger moved = finger;
  for (int p = 0; p < 14; ++p) {
    SetParameter(effects[p], ParameterValue(finger, effects[p]) + moves[p],
                 &moved);
  }
  for (const auto& contacts : MovedLoads()) {
    EquilibriumSolver solver(finger, discretization()),
        of_moved(moved, discretization());
    solver.model().set_effects(effects);
    ASSERT_TRUE(solver.Solve(contacts));
    const LadderState before = solver.state();
    for (int p = 0; p < 14; ++p) {
      ASSERT_TRUE(
          solver.model().set_effect(p, ParameterValue(moved, effects[p])))
          << p;
    }
    ASSERT_TRUE(of_moved.Solve(contacts));
    // From the finger's own state, from one saved before, and from rest.
    for (int start = 0; start < 3; ++start) {
      if (start == 1) solver.set_state(before);
      if (start == 2) solver.Reset();
      ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
      EXPECT_LT((solver.outputs() - of_moved.outputs()).cwiseAbs().maxCoeff(),
                GetParam() == Scheme::kTaylor ? 1e-9 : 1e-3)
          << start;
    }
  }
}

TEST(MovedFingerValuesTest, RefusesWhatIsNoFinger) {
  EquilibriumSolver solver(PaperFinger(), {});
  solver.model().set_effects({{Kind::kFrontHinge, 1}, {Kind::kBackAngle}});
  const double place = PaperFinger().ribs[1].front_mm;
  EXPECT_FALSE(
      solver.model().set_effect(0, PaperFinger().ribs[2].front_mm + 0.1));
  EXPECT_FALSE(solver.model().set_effect(1, 89));
  EXPECT_FALSE(solver.model().set_effect(1, std::nan("")));
  EXPECT_EQ(solver.model().finger().ribs[1].front_mm, place);
  EXPECT_TRUE(solver.model().set_effect(0, place + 0.5));
  EXPECT_EQ(solver.model().finger().ribs[1].front_mm, place + 0.5);
  EXPECT_EQ(solver.model().finger().ribs[1].length_mm,
            PaperFinger().ribs[1].length_mm);
}

// The open march, which the weighted form uses, has the same derivatives.
TEST(MovedFingerValuesTest, ShotMatchesCentralDifferences) {
  const Finger finger = RichFinger(Scheme::kTaylor);
  const std::vector<FingerParameter> effects = AllEffects();
  const std::vector<PointContact> contacts = {{67, 4, 0.2}};
  EquilibriumSolver solver(finger, {});
  solver.model().set_effects(effects);
  ASSERT_TRUE(solver.Solve(contacts));
  const Eigen::VectorXd q = solver.state().q;
  LadderShot at, shots[2];
  ASSERT_TRUE(solver.Shoot(q, contacts, &at));
  EXPECT_LT(at.closure.cwiseAbs().maxCoeff(), 1e-6);
  for (int p = 0; p < 14; ++p) {
    const double step = StepOf(effects[p].kind);
    for (int k = 0; k < 2; ++k) {
      Finger moved = finger;
      SetParameter(effects[p],
                   ParameterValue(finger, effects[p]) + (k == 0 ? -step : step),
                   &moved);
      EquilibriumSolver other(moved, {});
      ASSERT_TRUE(other.Shoot(q, contacts, &shots[k]));
    }
    const Eigen::VectorXd closure =
        (shots[1].closure - shots[0].closure) / (2 * step);
    const Eigen::VectorXd outputs =
        (shots[1].outputs - shots[0].outputs) / (2 * step);
    const Eigen::Index column = q.size() + 2 + 2 + 5 + p;
    EXPECT_LT((at.d_closure.col(column) - closure).cwiseAbs().maxCoeff(),
              1e-5 * closure.cwiseAbs().maxCoeff() + 1e-9)
        << ParameterName(effects[p]);
    EXPECT_LT((at.d_outputs.col(column) - outputs).cwiseAbs().maxCoeff(),
              1e-5 * outputs.cwiseAbs().maxCoeff() + 1e-9)
        << ParameterName(effects[p]);
  }
}

}  // namespace
}  // namespace finray
