#ifndef FINRAY_TESTS_RESIDUALS_RESIDUALS_FIXTURE_H_
#define FINRAY_TESTS_RESIDUALS_RESIDUALS_FIXTURE_H_

#include <gtest/gtest.h>

#include <memory>

#include "finray/residuals/frame_residual.h"
#include "finray/residuals/frame_set.h"
#include "test_finger.h"

namespace finray {

/// One loaded frame of a prestressed finger, and a comparison of a block's
/// derivatives with central differences of its residuals.
class ResidualsFixture : public testing::TestWithParam<EquilibriumForm> {
 protected:
  ResidualsFixture() : finger_(PaperFinger()) {
    finger_.ribs[1].length_mm += 0.3;
    finger_.back_stiffness_N_mm2 = 15000;
    shared_ = SharedParameters::Of(finger_);
    EquilibriumSolver solver(finger_, {});
    EXPECT_TRUE(solver.Solve({{67, 4, kFriction}}));
    if (GetParam() == EquilibriumForm::kWeighted) {
      for (int i = 0; i < solver.state().q.size(); ++i) {
        // A little off equilibrium, so that no closure is zero by luck.
        unknowns_.push_back(solver.state().q[i] * (1 + 1e-4 * i));
      }
    }
    unknowns_.push_back(67);
    unknowns_.push_back(4);
    frames_ = std::make_unique<FrameSet>(finger_, Discretization(), GetParam(),
                                         &shared_, 1);
    frame_ = &frames_->Add(1, kFriction, unknowns_.data());
    frames_->PrepareForEvaluation(true, true);
  }

  std::vector<double*> Blocks() {
    return FrameParameterBlocks(
        *frame_, unknowns_.data(), &shared_.ln_front_stiffness,
        &shared_.ln_back_stiffness, shared_.rib_lengths_mm.data());
  }

  // Derivatives by every parameter against central differences.
  void CheckDerivatives(const ceres::CostFunction& cost,
                        const std::vector<double*>& blocks, double tolerance) {
    const auto& sizes = cost.parameter_block_sizes();
    const int residuals = cost.num_residuals();
    ASSERT_EQ(sizes.size(), blocks.size());
    std::vector<Eigen::MatrixXd> analytic;
    std::vector<double*> pointers;
    for (const int size : sizes) {
      // Row-major storage of residuals x size is its transpose column-major.
      analytic.emplace_back(size, residuals);
      pointers.push_back(nullptr);
    }
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      pointers[b] = analytic[b].data();
    }
    Eigen::VectorXd at(residuals);
    ASSERT_TRUE(cost.Evaluate(blocks.data(), at.data(), pointers.data()));
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      for (int i = 0; i < sizes[b]; ++i) {
        const double value = blocks[b][i];
        const double h = 1e-6 * std::max(1.0, std::abs(value));
        Eigen::VectorXd up(residuals), down(residuals);
        blocks[b][i] = value + h;
        frames_->PrepareForEvaluation(false, true);
        ASSERT_TRUE(cost.Evaluate(blocks.data(), up.data(), nullptr));
        blocks[b][i] = value - h;
        frames_->PrepareForEvaluation(false, true);
        ASSERT_TRUE(cost.Evaluate(blocks.data(), down.data(), nullptr));
        blocks[b][i] = value;
        const Eigen::VectorXd expected = (up - down) / (2 * h);
        const Eigen::VectorXd got = analytic[b].row(i).transpose();
        EXPECT_LT((got - expected).cwiseAbs().maxCoeff(),
                  tolerance * (1 + expected.cwiseAbs().maxCoeff()))
            << "block " << b << " element " << i << ": " << got.transpose()
            << " against " << expected.transpose();
      }
    }
    frames_->PrepareForEvaluation(false, true);
  }

  static constexpr double kFriction = 0.15;
  Finger finger_;
  SharedParameters shared_;
  std::vector<double> unknowns_;
  std::unique_ptr<FrameSet> frames_;
  FrameEvaluation* frame_;
};

inline std::string FormName(
    const testing::TestParamInfo<EquilibriumForm>& info) {
  return info.param == EquilibriumForm::kReduced ? "Reduced" : "Weighted";
}

}  // namespace finray

#endif  // FINRAY_TESTS_RESIDUALS_RESIDUALS_FIXTURE_H_
