#include "finray/residuals/equilibrium_residual.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>

#include "finray/residuals/gauge_reading_residual.h"
#include "finray/residuals/rib_length_residual.h"
#include "residuals_fixture.h"

namespace finray {
namespace {

class EquilibriumResidualTest : public ResidualsFixture {};
INSTANTIATE_TEST_SUITE_P(Forms, EquilibriumResidualTest,
                         testing::Values(EquilibriumForm::kWeighted), FormName);

TEST_P(EquilibriumResidualTest, AnalyticalVersusFiniteDifferences) {
  const std::unique_ptr<ceres::CostFunction> tip(
      new EquilibriumResidual(frame_, finger_, 1));
  CheckDerivatives(*tip, Blocks(), 1e-6);
  const std::unique_ptr<ceres::CostFunction> ribs(
      new RibLengthResidual(frame_, finger_, 1));
  CheckDerivatives(*ribs, Blocks(), 1e-6);
}

// The two ways to hold equilibrium find the same contact.
TEST_P(EquilibriumResidualTest, WeightedAgreesWithReduced) {
  EquilibriumSolver solver(finger_, {});
  ASSERT_TRUE(solver.Solve({{82, 2.5, kFriction}}));
  Measurements row;
  std::vector<double> gains(4, 1.0), offsets(4, 0.0);
  for (int j = 0; j < 4; ++j) {
    row.gauges_V.push_back(solver.gauge_angle(j) + 1e-4 * (j - 1.5));
  }
  double found[2][2];
  for (const EquilibriumForm form :
       {EquilibriumForm::kReduced, EquilibriumForm::kWeighted}) {
    const bool weighted = form == EquilibriumForm::kWeighted;
    EquilibriumSolver start(finger_, {});
    ASSERT_TRUE(start.Solve({{75, 2, kFriction}}));
    std::vector<double> unknowns;
    if (weighted) {
      const Eigen::VectorXd q = start.state().q;
      unknowns.assign(q.data(), q.data() + q.size());
    }
    unknowns.insert(unknowns.end(), {75, 2});
    FrameSet frames(finger_, {}, form, &shared_, 1);
    FrameEvaluation& frame = frames.Add(1, kFriction, unknowns.data());
    ceres::Problem::Options options;
    options.evaluation_callback = &frames;
    ceres::Problem problem(options);
    const std::vector<double*> blocks = FrameParameterBlocks(
        frame, unknowns.data(), &shared_.ln_front_stiffness,
        &shared_.ln_back_stiffness, shared_.rib_lengths_mm.data());
    double linear = 0;
    for (int j = 0; j < 4; ++j) {
      std::vector<double*> all = blocks;
      all.insert(all.end(), {&gains[j], &linear, &offsets[j]});
      problem.AddResidualBlock(new GaugeReadingResidual(&frame, j, &row, 3e-4),
                               nullptr, all);
    }
    if (weighted) {
      problem.AddResidualBlock(new EquilibriumResidual(&frame, finger_, 1e6),
                               nullptr, blocks);
      problem.AddResidualBlock(new RibLengthResidual(&frame, finger_, 1e6),
                               nullptr, blocks);
    }
    std::vector<double*> all;
    problem.GetParameterBlocks(&all);
    for (double* block : all) {
      if (block != unknowns.data()) problem.SetParameterBlockConstant(block);
    }
    ceres::Solver::Options solve;
    solve.linear_solver_type = ceres::DENSE_QR;
    solve.initial_trust_region_radius = 1e12;
    solve.max_trust_region_radius = 1e16;
    solve.max_num_iterations = 200;
    solve.function_tolerance = solve.gradient_tolerance = 1e-16;
    solve.parameter_tolerance = 1e-14;
    solve.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solve, &problem, &summary);
    EXPECT_TRUE(summary.IsSolutionUsable());
    found[weighted][0] = unknowns[unknowns.size() - 2];
    found[weighted][1] = unknowns.back();
  }
  EXPECT_NEAR(found[0][0], found[1][0], 1e-4);
  EXPECT_NEAR(found[0][1], found[1][1], 1e-5);
  EXPECT_NEAR(found[0][0], 82, 3);
}

}  // namespace
}  // namespace finray
