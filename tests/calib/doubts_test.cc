#include "finray/calib/report/doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "calib/turned_stage.h"
#include "finray/calib/problem/median.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

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

class WarningTest : public testing::Test {
 protected:
  WarningTest()
      : log_(StandardLog(folder_, HiddenFinger(), 84)),
        problem_(Nominal(), StandardPlan(),
                 ReadCalibrationLogs({log_}, Nominal(), StandardPlan()), {}, 2),
        result_(Calibrate(&problem_)) {}

  // The text of the warning for a doubt.
  std::string TextOf(const std::string& doubt) {
    result_.doubts = {doubt};
    result_.warnings.clear();
    WarnOfDoubts(problem_, &result_);
    EXPECT_EQ(result_.warnings.size(), 1u);
    return result_.warnings[0].text;
  }
  void MakeLoud() {
    result_.identifiability.noise[static_cast<int>(ResidualFamily::kGauge)]
        .chi2 *= 4;
  }

  const TempFolder folder_;
  const std::string log_;
  CalibrationProblem problem_;
  CalibrationResult result_;
};

TEST_F(WarningTest, NoCauseIsSaidWhereNothingNeedsOne) {
  EXPECT_EQ(TextOf("not tested: agreement of the logs"),
            "not tested: agreement of the logs");
  MakeLoud();
  const char none[] =
      "likeliest cause: none of the effects that finray knows explains";
  EXPECT_THAT(TextOf("chi2"), StartsWith(none));
  result_.score = {};
  EXPECT_THAT(TextOf("not tested: effects that the plan leaves out"),
              StartsWith("the likeliest cause was not found; residuals"));
}

// Rows count from 1.
TEST_F(WarningTest, TheRowsWithLargeResidualsAreNamed) {
  MakeLoud();
  Linearization& at = result_.solution.at;
  std::vector<double> rows;
  for (const ResidualInfo& row : at.rows) {
    rows.push_back(problem_.frame(row.frame).row + 1);
  }
  const double middle = Median(rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    at.residuals[i] = rows[i] > middle ? 5 : 0;
  }
  EXPECT_THAT(TextOf("chi2"),
              HasSubstr(FormatText("at rows above %.0f (5 std", middle)));
}

TEST(DoubtsTest, ValuesThatNoFingerHasAreDoubts) {
  Plan plan = StandardPlan();
  for (const auto& [family, prior_std] :
       {std::pair(ParameterFamily::kFriction, 0.3),
        {ParameterFamily::kGaugeCreepShare, 0.1},
        {ParameterFamily::kHingeStiffness, 20.0}}) {
    plan.families[static_cast<int>(family)] = {true, prior_std, false};
  }
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 85));
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.MutableNumbers("time_s")[i] = static_cast<double>(i);
  }
  log.Write(folder.Path("timed.csv"));
  const Finger finger = Nominal();
  CalibrationProblem problem(
      finger, plan,
      ReadCalibrationLogs({folder.Path("timed.csv")}, finger, plan), {}, 2);
  CalibrationResult result;
  const CalibrationParameters& parameters = problem.parameters();
  result.identifiability.std.assign(parameters.free().size(), 0.01);
  EXPECT_THAT(FindDoubts(problem, result), testing::IsEmpty());
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    const CalibrationParameter& p = parameters.FreeParameter(k);
    // It pulls towards the base.
    if (p.family == ParameterFamily::kFriction) *p.variable = -0.3;
  }
  EXPECT_THAT(FindDoubts(problem, result), testing::IsEmpty());
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    const CalibrationParameter& p = parameters.FreeParameter(k);
    if (p.family == ParameterFamily::kFriction) *p.variable = 1.9;
    if (p.name == "gauge_2_creep_share") *p.variable = -0.2;
    if (p.family == ParameterFamily::kHingeStiffness) *p.variable = -1;
  }
  const std::vector<std::string> doubts = FindDoubts(problem, result);
  EXPECT_THAT(doubts, Contains(HasSubstr("friction_coefficient is 1.9 +- 0.01, "
                                         "and no finger or bench has more than "
                                         "1.5")));
  EXPECT_THAT(doubts, Contains("gauge_2_creep_share is -0.2 +- 0.01, and no "
                               "finger or bench has less than 0"));
  EXPECT_THAT(doubts, Contains(HasSubstr("hinge")));
}

// The log of a turned stage, read in steps of so many std of gauge 3.
std::string CauseWithSteps(double steps, double turn_deg) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(TurnedStageLog(folder, 82, turn_deg));
  const double step_V = steps * Nominal().gauges[2].noise_V;
  for (double& volts : log.MutableNumbers("gauge_3_V")) {
    volts = step_V * std::round(volts / step_V);
  }
  log.Write(folder.Path("turned.csv"));
  const CalibrationResult result = ResultOf(folder.Path("turned.csv"));
  for (const Warning& warning : result.warnings) {
    if (warning.code == "doubtful") return warning.text;
  }
  return result.Verdict();
}

TEST(DoubtsTest, OnlyStepsThatExplainAreNamed) {
  // Noise covers these.
  EXPECT_THAT(CauseWithSteps(2.2, 0.3),
              StartsWith("likeliest cause: residuals look like a turned "
                         "stage"));
  // These are the lesser part of it.
  EXPECT_THAT(CauseWithSteps(5, 0.3), Not(HasSubstr("has steps")));
  EXPECT_THAT(CauseWithSteps(10, 0),
              StartsWith("likeliest cause: gauge 3 has steps"));
}

// Rows that are means of readings have the scatter that their log tells.
TEST(DoubtsTest, QuietForcesOfMeansNameTheScatter) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 86));
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.MutableNumbers("force_readings")[i] = 4;
    log.MutableNumbers("force_scatter_N")[i] = 0.2;
  }
  log.Write(folder.Path("means.csv"));
  const CalibrationResult result = ResultOf(folder.Path("means.csv"));
  std::string text;
  for (const Warning& warning : result.warnings) {
    if (warning.code == "noise_below_plan") text += warning.text;
  }
  EXPECT_THAT(text, HasSubstr("): force_scatter_N times 0."));
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
