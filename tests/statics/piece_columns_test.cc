// Derivatives by the stiffness of pieces.

#include <gtest/gtest.h>

#include <vector>

#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr auto kFront = FingerParameterKind::kFrontPiece;
constexpr auto kBack = FingerParameterKind::kBackPiece;

Finger Pieced() {
  Finger finger = PaperFinger();
  const double back = BeamLength(finger, Side::kBack);
  finger.front_pieces = {{30, 1}, {75, 0.8}, {140, 1.1}};
  finger.back_pieces = {{50, 1}, {100, 1.2}, {120, 0.9}, {back, 0.7}};
  finger.gauges[0].beam = Side::kFront;
  return finger;
}

class PieceColumnsTest : public testing::TestWithParam<Scheme> {};

INSTANTIATE_TEST_SUITE_P(Schemes, PieceColumnsTest,
                         testing::Values(Scheme::kTaylor, Scheme::kRigidChain));

TEST_P(PieceColumnsTest, MatchCentralDifferences) {
  const Finger finger = Pieced();
  const std::vector<FingerParameter> effects = {
      {kFront, 1}, {kFront, 2}, {kBack, 1}, {kBack, 2}, {kBack, 3}};
  const std::vector<PointContact> contacts = {{35.3, 2, 0.2}, {90, 1, 0}};
  EquilibriumSolver solver(finger, {GetParam(), 0});
  solver.model().set_effects(effects);
  ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
  ASSERT_EQ(solver.d_outputs().cols(), 4 + 2 + 5 + 5);
  const double step = 1e-4;
  for (int p = 0; p < 5; ++p) {
    Eigen::VectorXd outputs[2];
    for (int k = 0; k < 2; ++k) {
      Finger moved = finger;
      const double value = ParameterValue(finger, effects[p]);
      SetParameter(effects[p], value + (k == 0 ? -step : step), &moved);
      EquilibriumSolver other(moved, {GetParam(), 0});
      ASSERT_TRUE(other.Solve(contacts));
      outputs[k] = other.outputs();
    }
    const Eigen::VectorXd slope = (outputs[1] - outputs[0]) / (2 * step);
    EXPECT_GT(slope.cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_LT((solver.d_outputs().col(11 + p) - slope).cwiseAbs().maxCoeff(),
              1e-5 * slope.cwiseAbs().maxCoeff())
        << p;
  }
  // A model whose effect is set is the model of that finger.
  Finger moved = finger;
  SetParameter({kBack, 2}, 0.5, &moved);
  EquilibriumSolver of_moved(moved, {GetParam(), 0});
  ASSERT_TRUE(of_moved.Solve(contacts));
  ASSERT_TRUE(solver.model().set_effect(3, 0.5));
  ASSERT_TRUE(solver.Solve(contacts));
  EXPECT_LT((solver.outputs() - of_moved.outputs()).cwiseAbs().maxCoeff(),
            1e-9);
  EXPECT_FALSE(solver.model().set_effect(3, 0));
}

TEST(PieceStepTest, AStepCarriesAllPiecesBehindIt) {
  Finger finger = Pieced();
  EXPECT_DOUBLE_EQ(ParameterValue(finger, {kFront, 2}), 1.1 / 0.8);
  SetParameter({kFront, 1}, 0.4, &finger);
  EXPECT_DOUBLE_EQ(finger.front_pieces[0].stiffness_ratio, 1);
  EXPECT_DOUBLE_EQ(finger.front_pieces[1].stiffness_ratio, 0.4);
  EXPECT_DOUBLE_EQ(finger.front_pieces[2].stiffness_ratio, 0.55);
  EXPECT_EQ(ParameterName({kBack, 1}), "back_piece_2_stiffness_step");
}

}  // namespace
}  // namespace finray
