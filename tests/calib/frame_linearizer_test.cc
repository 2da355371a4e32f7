#include "finray/calib/solve/frame_linearizer.h"

#include <gtest/gtest.h>

#include <functional>

#include "calib/standard_log.h"
#include "finray/scene/frame_columns.h"

namespace finray {
namespace {

constexpr double kSmallDecrease = FrameFit::kSmallDecrease;

const FrameLinearizer::StartState kUndeformed =
    [](const double*, LadderState* state) { *state = {}; };

class FrameLinearizerTest : public testing::Test {
 protected:
  FrameLinearizerTest() {
    FrameTable log = FrameTable::Read(StandardLog(folder_, HiddenFinger(), 11));
    log.MutableNumbers(GaugeVolts(2))[3] += 0.5;  // an outlier
    log.Write(folder_.Path("log.csv"));
    plan_ = StandardPlan();
    plan_.loss = RobustLoss::kCauchy;
    plan_.families[static_cast<int>(ParameterFamily::kObjectOrigin)].free =
        true;
    logs_ = ReadCalibrationLogs({folder_.Path("log.csv")}, Nominal(), plan_);
    parameters_ =
        std::make_unique<CalibrationParameters>(HiddenFinger(), plan_, logs_);
    blocks_ =
        std::make_unique<CalibrationBlocks>(finger_, plan_, parameters_.get());
    linearizer_ =
        std::make_unique<FrameLinearizer>(EquilibriumSolver(finger_, {}), plan_,
                                          blocks_.get(), parameters_.get());
  }

  double Cost(int frame, const std::array<double, 2>& contact) {
    LinearizedFrame at;
    EXPECT_TRUE(
        linearizer_->Linearize(logs_.frames[frame], contact, kUndeformed, &at));
    return at.cost;
  }

  TempFolder folder_;
  Finger finger_ = HiddenFinger();
  Plan plan_;
  CalibrationLogs logs_;
  std::unique_ptr<CalibrationParameters> parameters_;
  std::unique_ptr<CalibrationBlocks> blocks_;
  std::unique_ptr<FrameLinearizer> linearizer_;
};

// [C | E]' w r is the gradient of the cost, robust loss included.
TEST_F(FrameLinearizerTest, GradientOfTheCost) {
  for (const int frame : {0, 3, 7}) {
    const bool touches = logs_.frames[frame].contact;
    std::array<double, 2> contact = {60, 2.5};
    LinearizedFrame at;
    ASSERT_TRUE(
        linearizer_->Linearize(logs_.frames[frame], contact, kUndeformed, &at));
    const Eigen::VectorXd weighted = at.WeightedResiduals();
    const auto difference = [&](double* variable, double step) {
      const double kept = *variable;
      *variable = kept + step;
      const double above = Cost(frame, contact);
      *variable = kept - step;
      const double below = Cost(frame, contact);
      *variable = kept;
      return (above - below) / (2 * step);
    };
    const Eigen::VectorXd by_parameter = at.by_parameter.transpose() * weighted;
    for (std::size_t k = 0; k < parameters_->free().size(); ++k) {
      double* variable = parameters_->FreeParameter(k).variable;
      const double expected = difference(variable, 1e-6);
      EXPECT_NEAR(by_parameter[static_cast<Eigen::Index>(k)], expected,
                  1e-5 * std::abs(expected) + 1e-4)
          << frame << " " << parameters_->FreeParameter(k).name;
    }
    if (!touches) continue;
    const Eigen::Vector2d by_contact = at.by_contact.transpose() * weighted;
    for (int i = 0; i < 2; ++i) {
      const double expected = difference(&contact[i], 1e-5);
      EXPECT_NEAR(by_contact[i], expected, 1e-5 * std::abs(expected) + 1e-4);
    }
  }
}

TEST_F(FrameLinearizerTest, FitsTheContact) {
  for (const int frame : {3, 7, 30}) {  // frame 0 is free
    ASSERT_TRUE(logs_.frames[frame].contact);
    std::array<double, 2> contact = {
        std::clamp(logs_.frames[frame].object_mm.y() + 5, 20.0, 120.0),
        1.5 * logs_.frames[frame].force_N};
    LinearizedFrame at;
    ASSERT_TRUE(linearizer_->FitContact(logs_.frames[frame], &contact,
                                        kUndeformed, &at));
    const LinearizedFrame::ContactMove move = at.move;
    EXPECT_LT(move.decrease, 2 * kSmallDecrease);
    const std::array<double, 2> best = {contact[0] + move.now[0],
                                        contact[1] + move.now[1]};
    const double least = Cost(frame, best);
    EXPECT_NEAR(least, at.cost - move.decrease, kSmallDecrease);
    for (const double dl : {-0.3, 0.0, 0.3}) {
      for (const double df : {-0.05, 0.0, 0.05}) {
        EXPECT_GE(Cost(frame, {best[0] + dl, best[1] + df}), least - 1e-9);
      }
    }
  }
}

// The best contact goes with the parameters as B says.
TEST_F(FrameLinearizerTest, ContactsFollowTheParameters) {
  std::array<double, 2> contact = {60, 2};
  LinearizedFrame at;
  const CalibrationFrame& frame = logs_.frames[7];
  ASSERT_TRUE(linearizer_->FitContact(frame, &contact, kUndeformed, &at));
  const auto move = at.move;
  const Eigen::Vector2d start =
      Eigen::Vector2d(contact[0], contact[1]) + move.now;
  const double step = 1e-3;
  *parameters_->FreeParameter(0).variable += step;
  std::array<double, 2> moved = contact;
  ASSERT_TRUE(linearizer_->FitContact(frame, &moved, kUndeformed, &at));
  const Eigen::Vector2d end = Eigen::Vector2d(moved[0], moved[1]) + at.move.now;
  const Eigen::Vector2d expected = move.by_parameter.col(0) * step;
  // Up to what Gauss-Newton and the changing weights leave out.
  EXPECT_LT((end - start - expected).norm(), 0.2 * expected.norm());
}

// A pass over many frames takes the model from a surface. It fits each contact
// to the same place and says the same of the parameters, also where the plan
// moves the gauges.
TEST_F(FrameLinearizerTest, ASurfaceTellsTheSameAsTheEquilibria) {
  for (const bool moves_gauges : {false, true}) {
    plan_.families[static_cast<int>(ParameterFamily::kGaugeStart)].free =
        moves_gauges;
    CalibrationParameters parameters(HiddenFinger(), plan_, logs_);
    const CalibrationBlocks blocks(finger_, plan_, &parameters);
    const EquilibriumSolver solver(finger_, {});
    ASSERT_EQ(plan_.MovesGauges(), moves_gauges);
    const int outputs = moves_gauges ? 10 : 7;  // with a tip and without
    const ModelSurface surface(solver, parameters.shared, parameters.friction(),
                               moves_gauges,
                               {Eigen::VectorXd::Constant(outputs, 1e-9)});
    FrameLinearizer::Options options;
    options.surface = &surface;
    FrameLinearizer plain(solver, plan_, &blocks, &parameters),
        by_surface(solver, plan_, &blocks, &parameters, options);
    for (const int frame : {0, 3, 7, 30, 41, 63}) {
      const std::array<double, 2> start = {
          std::clamp(logs_.frames[frame].object_mm.y() + 5, 20.0, 120.0),
          1.3 * logs_.frames[frame].force_N};
      std::array<double, 2> one = start, other = start;
      LinearizedFrame at, at_surface;
      ASSERT_TRUE(
          plain.FitContact(logs_.frames[frame], &one, kUndeformed, &at));
      bool solved = false;
      ASSERT_TRUE(by_surface.FitContact(
          logs_.frames[frame], &other,
          [&](const double*, LadderState* state) {
            solved = true;
            *state = {};
          },
          &at_surface));
      EXPECT_FALSE(solved);
      EXPECT_NEAR(one[0], other[0], 1e-6);
      EXPECT_NEAR(one[1], other[1], 1e-7);
      EXPECT_NEAR(at.cost, at_surface.cost, 1e-6 * (1 + at.cost));
      EXPECT_LT((at.reduced - at_surface.reduced).norm(),
                1e-5 * at.reduced.norm())
          << frame;
    }
  }
}

}  // namespace
}  // namespace finray
