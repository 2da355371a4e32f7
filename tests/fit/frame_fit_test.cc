#include "finray/fit/frame_fit.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "finray/scene/clean_readings.h"
#include "finray/scene/scene.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kNoise_V = 3e-4;

const FrameFit::StartState kUndeformed = [](const double*, LadderState* state) {
  *state = {};
};

// The model at a point of Ceres'.
class AtPoint : public ceres::EvaluationCallback {
 public:
  AtPoint(const SharedParameters& at, const double* contact,
          FrameEvaluation* evaluation, EquilibriumSolver* solver)
      : at_(at), contact_(contact), evaluation_(evaluation), solver_(solver) {}

  void PrepareForEvaluation(bool /*jacobians*/, bool /*new_point*/) override {
    evaluation_->set_state(LadderState::Undeformed(solver_->model()));
    evaluation_->Update(contact_, at_, solver_);
  }

 private:
  const SharedParameters& at_;
  const double* contact_;
  FrameEvaluation* evaluation_;
  EquilibriumSolver* solver_;
};

class FrameFitTest : public testing::Test {
 protected:
  Measurements RowOf(double arc_mm, double normal_N) {
    EXPECT_TRUE(solver_.Solve({{arc_mm, normal_N, 0}}));
    Measurements row = CleanReadings(solver_);
    std::normal_distribution<double> noise(0, kNoise_V);
    for (double& volts : row.gauges_V) volts += noise(generator_);
    return row;
  }

  FrameFit::Frame FrameOf(const Measurements& row, double* contact) {
    blocks_ = MeasurementBlocks(row, MeasurementModel::OfScene(finger_, {}),
                                parameters_.frame(), finger_.gauges,
                                &evaluation_, contact);
    return {&blocks_, &evaluation_, contact};
  }

  // Minimises the blocks by ceres::Solve. Returns the cost.
  double ByCeres(const FrameFit::Frame& frame) {
    AtPoint at(shared(), frame.contacts, &evaluation_, &solver_);
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.evaluation_callback = &at;
    ceres::Problem problem(options);
    for (const FrameBlock& block : *frame.blocks) {
      problem.AddResidualBlock(block.cost.get(), nullptr, block.parameters);
    }
    std::vector<double*> all;
    problem.GetParameterBlocks(&all);
    for (double* block : all) {
      if (block != frame.contacts) problem.SetParameterBlockConstant(block);
    }
    problem.SetParameterLowerBound(frame.contacts, 0, 0);
    problem.SetParameterUpperBound(frame.contacts, 0, finger_.front_length_mm);
    problem.SetParameterLowerBound(frame.contacts, 1, 0);
    ceres::Solver::Options solve;
    solve.linear_solver_type = ceres::DENSE_QR;
    solve.function_tolerance = solve.gradient_tolerance = 1e-14;
    solve.parameter_tolerance = 1e-12;
    solve.max_num_iterations = 200;
    ceres::Solver::Summary summary;
    ceres::Solve(solve, &problem, &summary);
    EXPECT_TRUE(summary.IsSolutionUsable()) << summary.BriefReport();
    return summary.final_cost;
  }

  SharedParameters& shared() { return *parameters_.shared(); }

  // The fit from 8 mm and 40 % away ends, with LinearizedFrame::move, where
  // Ceres ends.
  void ExpectAsCeres(const ModelSurface* surface) {
    FrameFit fit(EquilibriumSolver(finger_, {}),
                 {&shared(), {}, 0, surface, nullptr});
    int solved = 0;
    const auto start = [&](const double*, LadderState* state) {
      ++solved;
      *state = {};
    };
    LinearizedFrame at;
    for (int i = 0; i < 12; ++i) {
      const double arc_mm = 25 + 8.5 * i, normal_N = 0.5 + 0.3 * i;
      SCOPED_TRACE(arc_mm);
      const Measurements row = RowOf(arc_mm, normal_N);
      double contact[] = {arc_mm, normal_N};
      const double least = ByCeres(FrameOf(row, contact));
      double own[] = {arc_mm + (i % 2 == 0 ? 8 : -8), 1.4 * normal_N};
      ASSERT_TRUE(fit.Fit(FrameOf(row, own), start, &at));
      EXPECT_NEAR(at.cost - at.move.decrease, least,
                  0.1 * FrameFit::kSmallDecrease);
      const Eigen::Vector2d off(own[0] + at.move.now[0] - contact[0],
                                own[1] + at.move.now[1] - contact[1]);
      // The minimum to 0.01 std.
      EXPECT_LT((at.by_contact * off).norm(), 0.01);
    }
    EXPECT_EQ(solved, surface != nullptr ? 0 : 12);
  }

  std::mt19937_64 generator_{11};
  Finger finger_ = PaperFinger();
  EquilibriumSolver solver_{finger_, {}};
  FingerParameters parameters_{finger_, std::nullopt};
  FrameEvaluation evaluation_{solver_.model(), EquilibriumForm::kReduced, 1, 0};
  std::vector<FrameBlock> blocks_;
};

TEST_F(FrameFitTest, EndsWhereCeresDoes) { ExpectAsCeres(nullptr); }

TEST_F(FrameFitTest, EndsThereOnASurfaceToo) {
  Eigen::VectorXd resolution = Eigen::VectorXd::Constant(7, 1e-7);
  resolution.segment<2>(4).setConstant(1e-5);
  const ModelSurface surface(solver_, shared(), 0, false, {resolution});
  ExpectAsCeres(&surface);
}

// A force against the finger is none.
TEST_F(FrameFitTest, KeepsTheBounds) {
  Measurements row = RowOf(70, 0);
  for (std::size_t j = 0; j < row.gauges_V.size(); ++j) {
    row.gauges_V[j] -= 0.05 * finger_.gauges[j].gain_V_per_rad;
  }
  FrameFit fit(EquilibriumSolver(finger_, {}),
               {&shared(), {}, 0, nullptr, nullptr});
  double contact[] = {70, 0.2};
  LinearizedFrame at;
  ASSERT_TRUE(fit.Fit(FrameOf(row, contact), kUndeformed, &at));
  EXPECT_EQ(contact[1], 0);
  EXPECT_GT(at.cost, 100);
}

// Readings of a load at the tip that would lie beyond it, and a frame without a
// contact: its own is left alone.
TEST_F(FrameFitTest, StaysOnTheFinger) {
  Measurements row = RowOf(finger_.front_length_mm, 1);
  for (double& volts : row.gauges_V) volts *= 1.5;
  row.gauges_V.back() *= 1.5;
  FrameFit fit(EquilibriumSolver(finger_, {}),
               {&shared(), {}, 0, nullptr, nullptr});
  double contact[] = {130, 1};
  LinearizedFrame at;
  ASSERT_TRUE(fit.Fit(FrameOf(row, contact), kUndeformed, &at));
  EXPECT_EQ(contact[0], finger_.front_length_mm);

  const double nan = std::nan("");
  double none[] = {nan, nan};
  FrameEvaluation free(solver_.model(), EquilibriumForm::kReduced, 0, 0);
  const auto blocks =
      MeasurementBlocks(row, MeasurementModel::OfScene(finger_, {}),
                        parameters_.frame(), finger_.gauges, &free, none);
  const FrameFit::Frame frame{&blocks, &free, none};
  ASSERT_TRUE(fit.Fit(frame, kUndeformed, &at));
  EXPECT_TRUE(std::isnan(none[0]));
  EXPECT_TRUE(at.by_contact.isZero(0));
  EXPECT_TRUE(at.move.now.isZero(0));
  EXPECT_TRUE(std::isfinite(at.cost));
}

}  // namespace
}  // namespace finray
