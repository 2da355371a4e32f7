// Derivatives by the friction coefficient of all contacts.

#include <gtest/gtest.h>

#include <vector>

#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

class FrictionColumnTest : public testing::TestWithParam<Scheme> {};

INSTANTIATE_TEST_SUITE_P(Schemes, FrictionColumnTest,
                         testing::Values(Scheme::kTaylor, Scheme::kRigidChain));

TEST_P(FrictionColumnTest, MatchesCentralDifferences) {
  const double friction = 0.2, step = 1e-4;
  const std::vector<std::vector<PointContact>> loads = {
      {{52.3, 3, friction}, {90, 1, friction}},
      {{128, 4, friction}},
      {{45, 9, friction}, {60, 0, friction, Side::kBack}}};
  for (const std::vector<PointContact>& contacts : loads) {
    EquilibriumSolver solver(PaperFinger(), {GetParam(), 0});
    solver.model().set_effects({{FingerParameterKind::kHingeStiffness}}, true);
    ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
    const auto column = 2 * static_cast<Eigen::Index>(contacts.size()) + 2 + 6;
    ASSERT_EQ(solver.d_outputs().cols(), column + 1);
    Eigen::VectorXd outputs[2];
    for (int k = 0; k < 2; ++k) {
      std::vector<PointContact> moved = contacts;
      for (PointContact& contact : moved) {
        contact.friction += k == 0 ? -step : step;
      }
      EquilibriumSolver other(PaperFinger(), {GetParam(), 0});
      ASSERT_TRUE(other.Solve(moved));
      outputs[k] = other.outputs();
    }
    const Eigen::VectorXd slope = (outputs[1] - outputs[0]) / (2 * step);
    EXPECT_GT(slope.cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LT((solver.d_outputs().col(column) - slope).cwiseAbs().maxCoeff(),
              1e-6 * slope.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace finray
