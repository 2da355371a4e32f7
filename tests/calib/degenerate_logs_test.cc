// Logs that do not tell what the plan asks for. The calibration converges on
// each of them, to numbers that look like any others: it has to say which of
// them are none, and why.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "calib/log_rows.h"
#include "calib/standard_log.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::UnorderedElementsAreArray;

using Names = std::vector<std::string>;

Names Join(Names names, const Names& more) {
  names.insert(names.end(), more.begin(), more.end());
  return names;
}
const Names kStiffness = {"front_stiffness_N_mm2", "back_stiffness_N_mm2"};
const Names kGains = {"gauge_1_gain_V_per_rad", "gauge_2_gain_V_per_rad",
                      "gauge_3_gain_V_per_rad", "gauge_4_gain_V_per_rad"};
const Names kOffsets = {"gauge_1_offset_V", "gauge_2_offset_V",
                        "gauge_3_offset_V", "gauge_4_offset_V"};
const Names kRibs = {"rib_1_length_mm", "rib_2_length_mm", "rib_3_length_mm",
                     "rib_4_length_mm", "rib_5_length_mm"};
// What frames without contact say nothing of.
const Names kAllButOffsets = Join(Join(kStiffness, kGains), kRibs);

constexpr double kFree = 0.06;  // N: 3 std of the force sensor

struct Outcome {
  bool all_identified;
  Names unidentifiable, codes, directions;
  std::string texts, remedies;  // of all warnings, one a line
  std::map<std::string, double> std;
};

class DegenerateLogsTest : public testing::Test {
 protected:
  // The standard log; simulated once.
  static const FrameTable& Whole() {
    static const FrameTable log = MakeLog(
        HiddenFinger(), StandardFrames(HiddenFinger(), 31), {0.02, 0.05, 31});
    return log;
  }
  static bool Touches(const FrameTable& log, std::size_t row) {
    return log.Numbers("force_N")[row] > kFree;
  }
  // The whole log without these columns.
  static FrameTable Without(const Names& columns) {
    FrameTable log = Whole();
    for (const std::string& name : columns) {
      log.MutableNumbers(name).assign(log.rows(), std::nan(""));
    }
    return log;
  }
  // So many frames with contact, then so many without.
  static FrameTable First(int contact, int free) {
    return RowsWhere(Whole(), [&](const FrameTable& log, std::size_t i) {
      return (Touches(log, i) ? contact : free)-- > 0;
    });
  }

  Outcome Calibrated(const FrameTable& log, const Plan& plan = StandardPlan(),
                     const Finger& start = Nominal()) const {
    log.Write(folder_.Path("log.csv"));
    CalibrationProblem problem(
        start, plan,
        ReadCalibrationLogs({folder_.Path("log.csv")}, start, plan), {}, 2);
    const CalibrationResult result = Calibrate(&problem);
    EXPECT_TRUE(result.solution.solve.converged);
    Outcome outcome;
    outcome.all_identified = result.AllIdentified();
    const CalibrationParameters& parameters = problem.parameters();
    for (std::size_t i = 0; i < parameters.free().size(); ++i) {
      const CalibrationParameter& p = parameters.FreeParameter(i);
      outcome.std[p.name] = result.identifiability.std[i];
      if (result.identifiability.status[i] ==
          ParameterStatus::kUnidentifiable) {
        outcome.unidentifiable.push_back(p.name);
      }
    }
    for (const WeakDirection& weak : result.identifiability.weak) {
      outcome.directions.push_back(weak.words);
    }
    for (const Warning& warning : result.warnings) {
      outcome.codes.push_back(warning.code);
      outcome.texts += warning.text + "\n";
      outcome.remedies += warning.remedy + "\n";
    }
    EXPECT_EQ(outcome.all_identified, outcome.unidentifiable.empty());
    return outcome;
  }

  TempFolder folder_;
};

// What all the others are missing something of.
TEST_F(DegenerateLogsTest, TheWholeLogTellsAll) {
  const Outcome outcome = Calibrated(Whole());
  EXPECT_TRUE(outcome.all_identified);
  EXPECT_THAT(outcome.directions, IsEmpty());
  EXPECT_THAT(outcome.codes, Not(Contains("unidentifiable")));
}

// A prior far from what the data say would win without a word.
TEST_F(DegenerateLogsTest, APriorThatTheDataContradict) {
  Plan plan = StandardPlan();
  FamilyPlan& gains =
      plan.families[static_cast<int>(ParameterFamily::kGaugeGain)];
  gains.prior_std = 2;  // % of 1 V/rad; the hidden finger's are some 2 V/rad
  const Outcome outcome = Calibrated(Whole(), plan);
  EXPECT_FALSE(outcome.all_identified);
  EXPECT_THAT(outcome.codes, Contains("prior_contradicted"));
  EXPECT_THAT(outcome.texts, HasSubstr("gauge_1_gain_V_per_rad ("));
  // Wrong, but with no weight against the data.
  gains.prior_std = 20;
  const Outcome overruled = Calibrated(Whole(), plan);
  EXPECT_THAT(overruled.codes, Not(Contains("prior_contradicted")));
  // The values stand, but what was known of the gains is false.
  EXPECT_TRUE(overruled.all_identified);
  EXPECT_THAT(overruled.codes, Contains("far_from_prior"));
  EXPECT_THAT(overruled.texts, HasSubstr("gauge_2_gain_V_per_rad (6"));
}

TEST_F(DegenerateLogsTest, NoForceSensor) {
  const Outcome outcome = Calibrated(Without({"force_N"}));
  EXPECT_THAT(outcome.unidentifiable, UnorderedElementsAreArray(kStiffness));
  EXPECT_THAT(outcome.directions,
              testing::ElementsAre(
                  "front and back stiffness and all forces scale together"));
  EXPECT_THAT(outcome.remedies, HasSubstr("reference force (force_N)"));
}

TEST_F(DegenerateLogsTest, ForceOnlyOfSmallLoads) {
  const Outcome outcome =
      Calibrated(RowsWhere(Without({"object_x_mm", "object_y_mm"}),
                           [](const FrameTable& log, std::size_t i) {
                             return log.Numbers("force_N")[i] < 0.8;
                           }));
  EXPECT_FALSE(outcome.all_identified);
  for (const std::string& name : Join(kStiffness, kGains)) {
    EXPECT_THAT(outcome.unidentifiable, Contains(name));
  }
  // The ribs join in, so that the direction is spelt out.
  EXPECT_THAT(outcome.directions,
              Contains(AllOf(HasSubstr("front_stiffness"),
                             HasSubstr("back_stiffness"), HasSubstr("gauge_1"),
                             HasSubstr("gauge_4"), HasSubstr("rib_"))));
  EXPECT_THAT(outcome.remedies, HasSubstr("object's centre (object_x_mm"));
}

TEST_F(DegenerateLogsTest, OneHeight) {
  const Outcome outcome =
      Calibrated(RowsWhere(Whole(), [](const FrameTable& log, std::size_t i) {
        return !Touches(log, i) ||
               std::abs(log.Numbers("object_y_mm")[i] - 70) < 4;
      }));
  EXPECT_FALSE(outcome.all_identified);
  EXPECT_THAT(kRibs, testing::IsSupersetOf(outcome.unidentifiable));
  EXPECT_GE(outcome.unidentifiable.size(), 3u);
  EXPECT_THAT(outcome.directions, Contains(AllOf(HasSubstr("together: rib_"),
                                                 HasSubstr(", rib_"))));
  EXPECT_THAT(outcome.remedies, HasSubstr("spread over the finger"));
}

TEST_F(DegenerateLogsTest, NoFreeFrame) {
  const Outcome outcome = Calibrated(RowsWhere(Whole(), Touches));
  EXPECT_THAT(outcome.unidentifiable, UnorderedElementsAreArray(kOffsets));
  EXPECT_THAT(outcome.codes, Contains("no_free_frame"));
  for (const std::string& name : kOffsets) {
    EXPECT_THAT(outcome.texts, HasSubstr(name));
  }
  EXPECT_THAT(outcome.remedies, HasSubstr("frames without contact"));
}

TEST_F(DegenerateLogsTest, GaugesOnly) {
  const Outcome outcome =
      Calibrated(Without({"force_N", "object_x_mm", "object_y_mm"}));
  EXPECT_THAT(outcome.unidentifiable,
              UnorderedElementsAreArray(Join(kAllButOffsets, kOffsets)));
  EXPECT_THAT(outcome.codes, Contains("gauges_only"));
  EXPECT_THAT(outcome.remedies, HasSubstr("record the reference force"));
}

TEST_F(DegenerateLogsTest, AllFramesEqual) {
  const Outcome touching =
      Calibrated(RowsOf(Whole(), std::vector<std::size_t>(100, 5)));
  EXPECT_THAT(touching.unidentifiable,
              UnorderedElementsAreArray(Join(kAllButOffsets, kOffsets)));
  EXPECT_THAT(touching.codes, Contains("no_free_frame"));
  EXPECT_THAT(touching.remedies, HasSubstr("spread over the finger"));
  ASSERT_FALSE(Touches(Whole(), 0));
  const Outcome free =
      Calibrated(RowsOf(Whole(), std::vector<std::size_t>(50, 0)));
  EXPECT_THAT(free.unidentifiable, UnorderedElementsAreArray(kAllButOffsets));
}

// Hardly more measurements than unknowns, then fewer: residuals are as small as
// can be, and prove nothing.
TEST_F(DegenerateLogsTest, FewFrames) {
  const Outcome four = Calibrated(First(3, 1));
  EXPECT_FALSE(four.all_identified);
  EXPECT_THAT(kRibs, testing::IsSupersetOf(four.unidentifiable));
  EXPECT_GE(four.unidentifiable.size(), 3u);
  EXPECT_THAT(four.directions, Contains(HasSubstr("together: rib_")));
  const Outcome two = Calibrated(First(1, 1));
  EXPECT_THAT(two.unidentifiable,
              testing::IsSupersetOf(Join(kStiffness, kRibs)));
  EXPECT_THAT(two.texts, HasSubstr("the data do not say how far"));
}

TEST_F(DegenerateLogsTest, OnlyFreeFrames) {
  const Outcome outcome =
      Calibrated(RowsWhere(Whole(), [](const FrameTable& log, std::size_t i) {
        return !Touches(log, i);
      }));
  EXPECT_THAT(outcome.unidentifiable,
              UnorderedElementsAreArray(kAllButOffsets));
}

// A constant is fitted perfectly, by a gain of zero; so is noise alone.
TEST_F(DegenerateLogsTest, AGaugeThatDoesNotRespond) {
  std::mt19937_64 generator(1);
  for (const double noise_V : {0.0, 5e-4}) {
    std::normal_distribution<double> normal;
    FrameTable log = Whole();
    for (double& volts : log.MutableNumbers("gauge_3_V")) {
      volts = 0.1 + noise_V * normal(generator);
    }
    const Outcome outcome = Calibrated(log);
    EXPECT_THAT(outcome.unidentifiable,
                testing::ElementsAre("gauge_3_gain_V_per_rad"));
    EXPECT_THAT(outcome.codes, Contains("dead_gauge"));
    EXPECT_THAT(outcome.texts, HasSubstr("gauge 3 does not respond"));
  }
}

TEST_F(DegenerateLogsTest, AGaugeWithoutReadings) {
  const Outcome outcome = Calibrated(Without({"gauge_3_V"}));
  EXPECT_THAT(outcome.unidentifiable,
              UnorderedElementsAreArray(
                  Names{"gauge_3_gain_V_per_rad", "gauge_3_offset_V"}));
  EXPECT_THAT(outcome.directions,
              Contains(HasSubstr("alone: gauge_3_gain_V_per_rad")));
}

TEST_F(DegenerateLogsTest, NoGaugeResponds) {
  FrameTable log = Whole();
  for (int j = 1; j <= 4; ++j) {
    log.MutableNumbers("gauge_" + std::to_string(j) + "_V")
        .assign(log.rows(), 0.05);
  }
  const Outcome outcome = Calibrated(log);
  EXPECT_THAT(outcome.unidentifiable, UnorderedElementsAreArray(kGains));
  EXPECT_EQ(
      std::count(outcome.codes.begin(), outcome.codes.end(), "dead_gauge"), 4);
}

// Every parameter is estimated, and yet gains and stiffness can move together
// by several percent: the most misleading of all. Gains from elsewhere end it.
TEST_F(DegenerateLogsTest, ForceOnlyLeavesGainsAgainstStiffness) {
  const FrameTable log = Without({"object_x_mm", "object_y_mm"});
  const Outcome loose = Calibrated(log);
  EXPECT_TRUE(loose.all_identified);
  EXPECT_THAT(loose.directions, Contains(kGainsAgainstStiffness));
  EXPECT_THAT(loose.codes, Contains("weak_direction"));

  Plan plan = StandardPlan();
  plan.families[static_cast<int>(ParameterFamily::kGaugeGain)] = {};
  Finger start = Nominal();
  for (std::size_t j = 0; j < start.gauges.size(); ++j) {
    start.gauges[j].gain_V_per_rad = HiddenFinger().gauges[j].gain_V_per_rad;
  }
  const Outcome known = Calibrated(log, plan, start);
  EXPECT_TRUE(known.all_identified);
  EXPECT_THAT(known.directions, Not(Contains(kGainsAgainstStiffness)));
  for (const std::string& name : kStiffness) {
    std::printf("%s: std %.2f %%, with known gains %.2f %%\n", name.c_str(),
                100 * loose.std.at(name), 100 * known.std.at(name));
    EXPECT_LT(known.std.at(name), loose.std.at(name) / 3);
  }
}

}  // namespace
}  // namespace finray
