// A measurement beside the gauges, the tip seen by a camera, is one residual
// block, and every path fits it: a calibration, the estimate of a frame by both
// solvers, live frames, and the whole log.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <random>

#include "calib/standard_log.h"
#include "finray/calib/solve/frame_linearizer.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/log_estimator.h"
#include "finray/scene/clean_readings.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kTip_mm = 0.003;

class AddedMeasurementTest : public testing::Test {
 protected:
  AddedMeasurementTest() {
    scene_.contacts = 1;
    with_tip_ = scene_;
    with_tip_.tip_std_mm = kTip_mm;
    EquilibriumSolver solver(finger_, {});
    EXPECT_TRUE(solver.SolveWithSensitivities({contact_}));
    row_ = CleanReadings(solver);
    row_.tip_mm = solver.tip_pose().head<2>();
    // The information of gauges and tip, by the sensitivities of the statics.
    const auto& by = solver.d_outputs();
    for (int j = 0; j < 4; ++j) {
      const double weight =
          finger_.gauges[j].gain_V_per_rad / finger_.gauges[j].noise_V;
      const Eigen::Vector2d slope = weight * by.block<1, 2>(j, 0).transpose();
      information_ += slope * slope.transpose();
    }
    const Eigen::Matrix2d tip = by.block<2, 2>(by.rows() - 3, 0) / kTip_mm;
    information_ += tip.transpose() * tip;
    std_ = information_.inverse().diagonal().cwiseSqrt();
    std::mt19937_64 generator(2);
    std::normal_distribution<double> noise;
    for (int j = 0; j < 4; ++j) {
      row_.gauges_V[j] += finger_.gauges[j].noise_V * noise(generator);
    }
    for (double& mm : row_.tip_mm) mm += kTip_mm * noise(generator);
  }

  // The std of the contact are those of both, and its place is the true one
  // within them.
  void ExpectBoth(const FrameEstimate& estimate, double relative) const {
    ASSERT_EQ(estimate.status, FrameStatus::kOk);
    const ContactEstimate& at = estimate.contact[0];
    EXPECT_NEAR(at.arc_std_mm, std_[0], relative * std_[0]);
    EXPECT_NEAR(at.normal_std_N, std_[1], relative * std_[1]);
    EXPECT_LT(std::abs(at.arc_mm - contact_.arc_mm), 4 * std_[0]);
    EXPECT_LT(std::abs(at.normal_N - contact_.normal_N), 4 * std_[1]);
  }

  Finger finger_ = PaperFinger();
  PointContact contact_{72, 3};
  Scene scene_, with_tip_;
  Measurements row_;
  Eigen::Matrix2d information_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d std_;  // of l_c in mm and of f_c in N
};

TEST_F(AddedMeasurementTest, FramesAreEstimatedWithIt) {
  // The tip tells of the force.
  EXPECT_GT(
      FrameEstimator(finger_, scene_).Estimate(row_).contact[0].normal_std_N,
      1.15 * std_[1]);
  for (const FrameMethod method :
       {FrameMethod::kFast, FrameMethod::kCeresReduced}) {
    FrameEstimator estimator(finger_, with_tip_, {}, method);
    const FrameEstimate estimate = estimator.Estimate(row_);
    EXPECT_EQ(estimate.dof, 4 + 2 - 2);
    ExpectBoth(estimate, 0.01);
  }
}

TEST_F(AddedMeasurementTest, LiveFramesAreEstimatedWithIt) {
  FrameEstimator estimator(finger_, with_tip_);
  estimator.Prepare();
  for (int frame = 0; frame < 3; ++frame) {
    ExpectBoth(estimator.Next(row_), 0.01);
  }
  // A row without it is estimated from its gauges.
  Measurements gauges = row_;
  gauges.tip_mm.setConstant(Measurements::kNotMeasured);
  EXPECT_GT(estimator.Next(gauges).contact[0].normal_std_N, 1.15 * std_[1]);
}

TEST_F(AddedMeasurementTest, WholeLogsAreEstimatedWithIt) {
  std::vector<FrameEstimate> estimates;
  LogEstimator estimator(
      finger_, with_tip_, {}, 1,
      [&](const FrameEstimate& estimate) { estimates.push_back(estimate); });
  for (int frame = 0; frame < 3; ++frame) {
    row_.time_s = 0.1 * frame;
    estimator.Add(row_);
  }
  estimator.Finish();
  ASSERT_EQ(estimates.size(), 3u);
  for (const FrameEstimate& estimate : estimates) ExpectBoth(estimate, 0.02);
}

TEST_F(AddedMeasurementTest, CalibrationsFitIt) {
  Plan plan = StandardPlan();
  plan.tip_std_mm = kTip_mm;
  plan.loss = RobustLoss::kNone;
  CalibrationLogs logs;
  logs.paths = logs.names = {"touch"};
  logs.times.resize(1);
  CalibrationFrame frame;
  static_cast<Measurements&>(frame) = row_;
  frame.contact = true;
  logs.frames.push_back(frame);
  CalibrationParameters parameters(finger_, plan, logs);
  const CalibrationBlocks blocks(finger_, plan, &parameters);
  FrameLinearizer linearizer(EquilibriumSolver(finger_, {}), plan, &blocks,
                             &parameters);
  LinearizedFrame at;
  ASSERT_TRUE(linearizer.Linearize(
      logs.frames[0], {contact_.arc_mm, contact_.normal_N},
      [](const double*, LadderState* state) { *state = {}; }, &at));
  EXPECT_LT((at.Information() - information_).norm(),
            1e-6 * information_.norm());
  std::array<double, 2> contact = {contact_.arc_mm - 5,
                                   0.8 * contact_.normal_N};
  LinearizedFrame fitted;
  ASSERT_TRUE(linearizer.FitContact(
      logs.frames[0], &contact,
      [](const double*, LadderState* state) { *state = {}; }, &fitted));
  EXPECT_LT(std::abs(contact[0] - contact_.arc_mm), 4 * std_[0]);
  EXPECT_LT(std::abs(contact[1] - contact_.normal_N), 4 * std_[1]);
  // Its residuals depend on the parameters too.
  int tip_rows = 0;
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    if (at.rows[i].family != ResidualFamily::kTip) continue;
    ++tip_rows;
    EXPECT_GT(at.by_parameter.row(static_cast<Eigen::Index>(i)).norm(), 0);
  }
  EXPECT_EQ(tip_rows, 2);
}

}  // namespace
}  // namespace finray
