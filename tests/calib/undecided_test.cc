#include "finray/calib/solve/undecided.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "calib/standard_log.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The standard log, whose last rows touch lightly at the stiff base, where
// 0.13 mm are some 0.5 N, or stay clear of the finger.
constexpr int kRows = 210, kTouching = 8, kClear = 8;
FrameTable LightlyTouching() {
  const FrameTable standard = StandardFrames(HiddenFinger(), 9);
  FrameTable frames(kRows);
  for (const char* column : {"object_x_mm", "object_y_mm"}) {
    frames.MutableNumbers(column) = standard.Numbers(column);
  }
  for (int k = 0; k < kTouching + kClear; ++k) {
    const int row = kRows - 1 - k;
    frames.MutableNumbers("object_x_mm")[row] =
        -15 + (k < kTouching ? 0.13 : -0.13);
    frames.MutableNumbers("object_y_mm")[row] = 18 + k % 8;
  }
  EXPECT_EQ(
      Simulate(HiddenFinger(), StandardScene(), {}, &frames).not_converged, 0);
  return MakeLog(HiddenFinger(), frames, {0.02, 0.01, 9});
}

struct Decisions {
  int touching = 0, clear = 0;  // of the last rows, how many count as such
  std::vector<std::string> rejected;
};

Decisions Decided(const FrameTable& log) {
  const TempFolder folder;
  log.Write(folder.Path("log.csv"));
  const Plan plan = StandardPlan();
  CalibrationProblem problem(
      Nominal(), plan,
      ReadCalibrationLogs({folder.Path("log.csv")}, Nominal(), plan), {}, 2);
  Calibrate(&problem);
  Decisions outcome;
  for (int k = 0; k < kTouching; ++k) {
    outcome.touching += problem.frame(kRows - 1 - k).contact;
    outcome.clear += !problem.frame(kRows - 1 - kTouching - k).contact;
  }
  for (const auto& [frame, reason] : problem.rejected()) {
    outcome.rejected.push_back(reason);
  }
  return outcome;
}

// A slow force sensor leaves cells empty. The object's place does not tell.
TEST(UndecidedTest, GaugesDecideWhereTheForceIsMissing) {
  FrameTable log = LightlyTouching();
  for (int k = 0; k < kTouching + kClear; ++k) {
    log.MutableNumbers("force_N")[kRows - 1 - k] = kNaN;
  }
  const Decisions outcome = Decided(log);
  EXPECT_EQ(outcome.touching, kTouching);
  EXPECT_EQ(outcome.clear, kClear);
  EXPECT_THAT(outcome.rejected, testing::IsEmpty());
}

// A force cell that reads nothing while the object presses is wrong itself; no
// gauge is to blame.
TEST(UndecidedTest, AForceOfZeroIsBlamedItself) {
  FrameTable log = LightlyTouching();
  for (const int row : {25, 60, 95}) log.MutableNumbers("force_N")[row] = 0.01;
  const Decisions outcome = Decided(log);
  ASSERT_EQ(outcome.rejected.size(), 3u);
  EXPECT_THAT(outcome.rejected,
              testing::Each(testing::HasSubstr("force is off by")));
}

}  // namespace
}  // namespace finray
