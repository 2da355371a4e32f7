#include "finray/residuals/reference_force_residual.h"

#include <cmath>

#include "residuals_fixture.h"

namespace finray {
namespace {

class ReferenceForceResidualTest : public ResidualsFixture {};
INSTANTIATE_TEST_SUITE_P(Forms, ReferenceForceResidualTest,
                         testing::Values(EquilibriumForm::kReduced,
                                         EquilibriumForm::kWeighted),
                         FormName);

TEST_P(ReferenceForceResidualTest, MagnitudeAndComponentsAgree) {
  double magnitude, components[2];
  const std::unique_ptr<ceres::CostFunction> norm(
      ReferenceForceResidual::Create(frame_, 0, 1));
  const std::unique_ptr<ceres::CostFunction> vector(
      ReferenceForceVectorResidual::Create(frame_, {0, 0}, 1));
  ASSERT_TRUE(norm->Evaluate(Blocks().data(), &magnitude, nullptr));
  ASSERT_TRUE(vector->Evaluate(Blocks().data(), components, nullptr));
  EXPECT_NEAR(magnitude, 4 * std::sqrt(1 + kFriction * kFriction), 1e-12);
  EXPECT_NEAR(std::hypot(components[0], components[1]), magnitude, 1e-12);
  EXPECT_GT(components[0], 0);  // into the finger
}

TEST_P(ReferenceForceResidualTest, AnalyticalVersusFiniteDifferences) {
  const std::unique_ptr<ceres::CostFunction> norm(
      ReferenceForceResidual::Create(frame_, 3.9, 0.02));
  CheckDerivatives(*norm, {unknowns_.data()}, 1e-7);
  const std::unique_ptr<ceres::CostFunction> vector(
      ReferenceForceVectorResidual::Create(frame_, {3.9, 0.1}, 0.02));
  CheckDerivatives(*vector, Blocks(), 1e-6);
}

}  // namespace
}  // namespace finray
