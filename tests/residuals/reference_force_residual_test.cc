#include "finray/residuals/reference_force_residual.h"

#include <cmath>

#include "residuals_fixture.h"

namespace finray {
namespace {

class ReferenceForceResidualTest : public ResidualsFixture {
 protected:
  std::vector<double*> MagnitudeBlocks() {
    return {unknowns_.data(), &ln_scale_, offset_};
  }
  std::vector<double*> VectorBlocks() {
    std::vector<double*> blocks = Blocks();
    blocks.push_back(&ln_scale_);
    blocks.push_back(offset_);
    return blocks;
  }

  double ln_scale_ = std::log(1.25);
  double offset_[2] = {0.3, -0.2};
};
INSTANTIATE_TEST_SUITE_P(Forms, ReferenceForceResidualTest,
                         testing::Values(EquilibriumForm::kReduced,
                                         EquilibriumForm::kWeighted),
                         FormName);

TEST_P(ReferenceForceResidualTest, MagnitudeAndComponentsAgree) {
  double magnitude, components[2];
  const std::unique_ptr<ceres::CostFunction> norm(
      new ReferenceForceResidual(frame_, 0, 1));
  const std::unique_ptr<ceres::CostFunction> vector(
      new ReferenceForceVectorResidual(frame_, {0, 0}, 1));
  ASSERT_TRUE(norm->Evaluate(MagnitudeBlocks().data(), &magnitude, nullptr));
  ASSERT_TRUE(vector->Evaluate(VectorBlocks().data(), components, nullptr));
  EXPECT_NEAR(magnitude - offset_[0],
              1.25 * 4 * std::sqrt(1 + kFriction * kFriction), 1e-12);
  for (int i = 0; i < 2; ++i) components[i] -= offset_[i];
  magnitude -= offset_[0];
  EXPECT_NEAR(std::hypot(components[0], components[1]), magnitude, 1e-12);
  EXPECT_GT(components[0], 0);  // into the finger
}

TEST_P(ReferenceForceResidualTest, AnalyticalVersusFiniteDifferences) {
  const std::unique_ptr<ceres::CostFunction> norm(
      new ReferenceForceResidual(frame_, 3.9, 0.02));
  CheckDerivatives(*norm, MagnitudeBlocks(), 1e-7);
  const std::unique_ptr<ceres::CostFunction> vector(
      new ReferenceForceVectorResidual(frame_, {3.9, 0.1}, 0.02));
  CheckDerivatives(*vector, VectorBlocks(), 1e-6);
}

// In a free frame the sensor reads only its offset.
TEST_P(ReferenceForceResidualTest, WithoutContact) {
  FrameSet frames(finger_, {}, EquilibriumForm::kReduced, &shared_, 1);
  const FrameEvaluation& free = frames.Add(0, 0, nullptr);
  frames.PrepareForEvaluation(true, true);
  const std::unique_ptr<ceres::CostFunction> norm(
      new ReferenceForceResidual(&free, 0.3, 0.02));
  double residual;
  const std::vector<double*> blocks = {&ln_scale_, offset_};
  ASSERT_TRUE(norm->Evaluate(blocks.data(), &residual, nullptr));
  EXPECT_NEAR(residual, (offset_[0] - 0.3) / 0.02, 1e-12);
  CheckDerivatives(*norm, blocks, 1e-7);
}

}  // namespace
}  // namespace finray
