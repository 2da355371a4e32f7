#include "finray/residuals/point_residual.h"

#include <cmath>

#include "finray/statics/shape.h"
#include "residuals_fixture.h"

namespace finray {
namespace {

class PointResidualTest : public ResidualsFixture {
 protected:
  PointResidualTest() {
    // The fixture's frame, with pins.
    frames_ = std::make_unique<FrameSet>(finger_, Discretization(), GetParam(),
                                         &shared_, 1);
    frame_ = &frames_->Add(1, kFriction, unknowns_.data(), true);
    frames_->PrepareForEvaluation(true, true);
    blocks_ = Blocks();
    blocks_.push_back(origin_);
  }

  double origin_[2] = {0.3, -0.2};
  std::vector<double*> blocks_;
};
INSTANTIATE_TEST_SUITE_P(Forms, PointResidualTest,
                         testing::Values(EquilibriumForm::kReduced,
                                         EquilibriumForm::kWeighted),
                         FormName);

TEST_P(PointResidualTest, AnalyticalVersusFiniteDifferences) {
  const Eigen::Vector2d at(3, 40), tip_at(3, 140);
  for (int rib = 0; rib < 5; ++rib) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      const std::unique_ptr<ceres::CostFunction> pin(
          new PointResidual(frame_, frame_->pin_row(rib, side), &at, 0.5));
      CheckDerivatives(*pin, blocks_, 1e-6);
    }
  }
  const std::unique_ptr<ceres::CostFunction> tip(
      new PointResidual(frame_, frame_->tip_row(), &tip_at, 0.5));
  CheckDerivatives(*tip, blocks_, 1e-6);
}

// Only the reduced form is in equilibrium without a solve.
class PointEquilibriumTest : public ResidualsFixture {};
INSTANTIATE_TEST_SUITE_P(Forms, PointEquilibriumTest,
                         testing::Values(EquilibriumForm::kReduced), FormName);

TEST_P(PointEquilibriumTest, PinsAreWhereTheShapeHasThem) {
  const std::vector<PointContact> contacts = {{67, 4, kFriction}};
  EquilibriumSolver solver(finger_, {});
  ASSERT_TRUE(solver.Solve(contacts));
  const Shape shape(solver, contacts);
  FrameSet frames(finger_, {}, GetParam(), &shared_, 1);
  const FrameEvaluation& frame =
      frames.Add(1, kFriction, unknowns_.data(), true);
  frames.PrepareForEvaluation(true, true);
  // Adding pins leaves the other outputs as they are.
  for (int i = 0; i < frame.gauges() + 3; ++i) {
    EXPECT_NEAR(frame.outputs()[i], frame_->outputs()[i], 1e-10);
    EXPECT_LT((frame.d_outputs().row(i) - frame_->d_outputs().row(i)).norm(),
              1e-9 * (1 + frame_->d_outputs().row(i).norm()));
  }
  double origin[2] = {0, 0.05}, residuals[2];
  std::vector<double*> blocks = Blocks();
  blocks.push_back(origin);
  for (int rib = 0; rib < 5; ++rib) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Rib& hinge = finger_.ribs[rib];
      const Section at =
          shape.At(side, side == Side::kFront ? hinge.front_mm : hinge.back_mm);
      const Eigen::Vector2d seen(at.x_mm + 0.1, at.y_mm);
      const std::unique_ptr<ceres::CostFunction> pin(
          new PointResidual(&frame, frame.pin_row(rib, side), &seen, 0.5));
      ASSERT_TRUE(pin->Evaluate(blocks.data(), residuals, nullptr));
      EXPECT_NEAR(residuals[0], -0.2, 1e-8);
      EXPECT_NEAR(residuals[1], -0.1, 1e-8);
    }
  }
}

}  // namespace
}  // namespace finray
