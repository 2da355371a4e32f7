// Derivatives of the blocks by effects inside the equilibrium.

#include <cmath>
#include <utility>

#include "finray/residuals/equilibrium_residual.h"
#include "finray/residuals/gauge_reading_residual.h"
#include "finray/residuals/point_residual.h"
#include "finray/residuals/reference_force_residual.h"
#include "finray/residuals/rib_length_residual.h"
#include "residuals/residuals_fixture.h"

namespace finray {
namespace {

class EffectsTest : public ResidualsFixture {
 protected:
  EffectsTest() {
    SetParameter({FingerParameterKind::kHingeStiffness}, 30, &finger_);
    finger_.ribs[1].bending_stiffness_N_mm2 = 3000;
    finger_.ribs[2].bending_stiffness_N_mm2 = 2000;
    finger_.ribs[2].front_rigid_mm = 1;
    using Kind = FingerParameterKind;
    shared_ = SharedParameters::Of(finger_, {{Kind::kHingeStiffness},
                                             {Kind::kRibBending},
                                             {Kind::kFrontHinge, 2},
                                             {Kind::kBackHinge, 1},
                                             {Kind::kBackAngle}});
    shared_.friction_varies = true;
    shared_.effect_values.push_back(kFriction);
    frames_ = std::make_unique<FrameSet>(finger_, Discretization(), GetParam(),
                                         &shared_, 1);
    // An object that half sticks and slides towards the base.
    frame_ = &frames_->Add(1, 0, unknowns_.data(), true, false, {0.1, -0.7});
    frames_->PrepareForEvaluation(true, true);
  }
  std::vector<double*> BlocksAnd(const std::vector<double*>& more) {
    std::vector<double*> blocks = FrameParameterBlocks(
        *frame_, unknowns_.data(), &shared_.ln_front_stiffness,
        &shared_.ln_back_stiffness, shared_.rib_lengths_mm.data(),
        shared_.effect_values.data());
    blocks.insert(blocks.end(), more.begin(), more.end());
    return blocks;
  }

  double gain_ = 1.7, curvature_ = 0.2, offset_[2] = {0.1, 0.2};
  double ln_scale_ = 0.1, tilt_deg_ = 3, weight_N_[2] = {0.1, 0};
};
INSTANTIATE_TEST_SUITE_P(Forms, EffectsTest,
                         testing::Values(EquilibriumForm::kReduced,
                                         EquilibriumForm::kWeighted),
                         FormName);

TEST_P(EffectsTest, AnalyticalVersusFiniteDifferences) {
  ASSERT_TRUE(frame_->valid());
  ASSERT_EQ(frame_->effects(), 6);
  Measurements row;
  row.gauges_V.assign(4, 0.1);
  const GaugeReadingResidual gauge(frame_, 1, &row, 3e-4);
  CheckDerivatives(gauge, BlocksAnd({&gain_, &curvature_, offset_}), 1e-5);
  const ReferenceForceVectorResidual components(frame_, {3.9, 0.1}, 0.02);
  CheckDerivatives(components,
                   BlocksAnd({&ln_scale_, offset_, &tilt_deg_, weight_N_}),
                   1e-5);
  const ReferenceForceResidual magnitude(frame_, 3.9, 0.02);
  CheckDerivatives(
      magnitude,
      {unknowns_.data(), &ln_scale_, offset_, shared_.effect_values.data()},
      1e-6);
  // Pins move with their hinges.
  double origin[2] = {0, 0};
  const Eigen::Vector2d at(3, 40);
  for (const auto& [rib, side] :
       {std::pair(2, Side::kFront), {1, Side::kBack}, {1, Side::kFront}}) {
    const PointResidual pin(frame_, frame_->pin_row(rib, side), &at, 0.5);
    CheckDerivatives(pin, BlocksAnd({origin}), 1e-5);
  }
  if (GetParam() == EquilibriumForm::kReduced) return;
  const EquilibriumResidual equilibrium(frame_, finger_, 10);
  CheckDerivatives(equilibrium, BlocksAnd({}), 1e-5);
  const RibLengthResidual ribs(frame_, finger_, 10);
  CheckDerivatives(ribs, BlocksAnd({}), 1e-5);
}

}  // namespace
}  // namespace finray
