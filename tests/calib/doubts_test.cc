#include "finray/calib/report/doubts.h"

#include <gtest/gtest.h>

#include "calib/turned_stage.h"

namespace finray {
namespace {

CalibrationResult ResultOf(const std::string& log) {
  CalibrationProblem problem(
      Nominal(), StandardPlan(),
      ReadCalibrationLogs({log}, Nominal(), StandardPlan()), {}, 2);
  return Calibrate(&problem);
}

TEST(DoubtsTest, ACleanLogIsGood) {
  const TempFolder folder;
  const CalibrationResult result =
      ResultOf(StandardLog(folder, HiddenFinger(), 81));
  EXPECT_EQ(result.Verdict(), "good");
  EXPECT_TRUE(result.doubts.empty());
  EXPECT_EQ(result.cross_validation.folds, 5);
}

TEST(DoubtsTest, TheLikeliestCauseComesFirst) {
  const TempFolder folder;
  const CalibrationResult result = ResultOf(TurnedStageLog(folder, 82, 1));
  EXPECT_EQ(result.Verdict(), "doubtful");
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_EQ(result.warnings[0].code, "doubtful");
  EXPECT_EQ(result.warnings[0].text.find(
                "likeliest cause: residuals look like a turned stage"),
            0u);
}

TEST(DoubtsTest, FrictionIsNotGood) {
  Scene rough = StandardScene();
  rough.friction_coefficient = 0.3;
  const TempFolder folder;
  MakeLog(HiddenFinger(), StandardFrames(HiddenFinger(), 83, rough),
          {0.02, 0.05, 83})
      .Write(folder.Path("log.csv"));
  EXPECT_EQ(ResultOf(folder.Path("log.csv")).Verdict(), "doubtful");
}

// A result that is solved, of which so many of 100 unseen forces lie within
// their 95 % intervals.
CalibrationResult Judged(const char* doubt, std::size_t within_95) {
  CalibrationResult result;
  result.solution.solve.converged = true;
  if (doubt != nullptr) result.doubts.push_back(doubt);
  result.forces.held_out.after.contact.force_N.judged = 100;
  result.forces.held_out.after.contact.force_N.within_95 = within_95;
  return result;
}

TEST(DoubtsTest, FreedEffectsThatDeceiveAreNotAdopted) {
  const CalibrationResult given = Judged("model", 95);
  EXPECT_EQ(WhyNotAdopted(Judged("model", 90), given),
            "with the freed effects the verdict is doubtful, and 95 % "
            "intervals of force hold in 90 % of unseen frames, without them in "
            "95 %");
  EXPECT_EQ(WhyNotAdopted(Judged("model", 93), given), "");
  EXPECT_EQ(WhyNotAdopted(Judged("model", 97), given), "");
  // A green verdict has its own tests of the intervals.
  EXPECT_EQ(WhyNotAdopted(Judged(nullptr, 90), given), "");
}

}  // namespace
}  // namespace finray
