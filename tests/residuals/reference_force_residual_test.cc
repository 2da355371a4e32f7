#include "finray/residuals/reference_force_residual.h"

#include <Eigen/Geometry>
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
    blocks.push_back(&tilt_deg_);
    blocks.push_back(weight_N_);
    return blocks;
  }

  double ln_scale_ = std::log(1.25);
  double offset_[2] = {0.3, -0.2};
  double tilt_deg_ = 0, weight_N_[2] = {0, 0};
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

// A sensor whose axes are turned, that carries something and reads late.
TEST_P(ReferenceForceResidualTest, TiltWeightAndTime) {
  LinearSignal signals[3];
  for (int i = 0; i < 3; ++i) {
    signals[i].Add(0, 1 + i);
    signals[i].Add(10, 3 + 2 * i);
  }
  double late_s = 2;
  const double turned = 0.7;
  std::vector<double*> blocks = MagnitudeBlocks();
  blocks.push_back(&late_s);
  const std::unique_ptr<ceres::CostFunction> norm(
      new ReferenceForceResidual(frame_, 9, 0.02, {&signals[2], 3}));
  CheckDerivatives(*norm, blocks, 1e-7);
  blocks = VectorBlocks();
  blocks.push_back(&late_s);
  double without[2], with[2];
  const std::unique_ptr<ceres::CostFunction> vector(
      new ReferenceForceVectorResidual(frame_, {1.6, 2.9}, 0.02, turned,
                                       {signals, 3}));
  ASSERT_TRUE(vector->Evaluate(blocks.data(), without, nullptr));
  EXPECT_NEAR(
      without[0] * 0.02,
      [&] {
        double plain[2];
        const std::unique_ptr<ceres::CostFunction> same(
            new ReferenceForceVectorResidual(frame_, {2, 3.5}, 1));
        EXPECT_TRUE(same->Evaluate(VectorBlocks().data(), plain, nullptr));
        return plain[0];
      }(),
      1e-12);
  tilt_deg_ = 20;
  weight_N_[0] = 0.4;
  weight_N_[1] = -0.1;
  CheckDerivatives(*vector, blocks, 1e-6);
  ASSERT_TRUE(vector->Evaluate(blocks.data(), with, nullptr));
  const Eigen::Vector2d force =
      0.02 * Eigen::Vector2d(without[0], without[1]) +
      Eigen::Vector2d(2 - offset_[0], 3.5 - offset_[1]);
  const Eigen::Vector2d expected =
      Eigen::Rotation2Dd(tilt_deg_ * M_PI / 180) * force +
      Eigen::Rotation2Dd(turned) * Eigen::Vector2d(0.4, -0.1) +
      Eigen::Vector2d(offset_[0] - 2, offset_[1] - 3.5);
  EXPECT_NEAR(with[0] * 0.02, expected[0], 1e-12);
  EXPECT_NEAR(with[1] * 0.02, expected[1], 1e-12);
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
