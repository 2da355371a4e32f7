#include "finray/view/batch_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::HasSubstr;
using Kind = FingerVerdict::Kind;

TEST(BatchResults, DaysOfPathsAndTimes) {
  EXPECT_EQ(DayInPath("runs/2026-03-05/a.csv"), "2026-03-05");
  EXPECT_EQ(DayInPath("runs/log_20260305_7.csv"), "2026-03-05");
  EXPECT_EQ(DayInPath("runs/120260305.csv"), "");
  EXPECT_EQ(DayInPath("runs/20261305.csv"), "");
  EXPECT_EQ(DayInPath("2026-0305"), "");
  EXPECT_EQ(DayInPath("a.csv"), "");
  EXPECT_EQ(DayOfTime(1772668800), "2026-03-05");
  EXPECT_EQ(DayOfTime(12.5), "");
  EXPECT_EQ(DayOfTime(1e300), "");
}

Warning Of(const std::string& code, const std::string& text,
           const std::string& remedy = "look") {
  return {code, text, remedy};
}

Kind JudgedAs(const std::vector<Warning>& finger,
              const std::vector<LogResult>& logs) {
  std::vector<const LogResult*> pointers;
  for (const LogResult& log : logs) pointers.push_back(&log);
  return Judge(finger, pointers).kind;
}

LogResult Log(const std::string& day, const std::vector<Warning>& warnings,
              std::size_t compared = 100) {
  LogResult log;
  log.day = day;
  log.warnings = warnings;
  log.force_judged = compared;
  return log;
}

TEST(BatchResults, VerdictsFollowTheLatestWarnings) {
  const Warning moved =
      Of("unexplained_frames",
         "likeliest cause: the gauges' offsets have moved; 9");
  const Warning stiff =
      Of("forces_differ", "likeliest cause: it grows with the load, so");
  const Warning dead =
      Of("unexplained_frames", "likeliest cause: gauge 2 is dead: it");
  const Warning frozen = Of("gauge_fault", "in a.csv all gauges read the same");
  const Warning some = Of("some_unexplained_frames", "the offsets have moved");
  const std::string early = "2026-03-01", late = "2026-03-09";
  EXPECT_EQ(JudgedAs({}, {Log(late, {})}), Kind::kGood);
  EXPECT_EQ(JudgedAs({}, {Log(late, {}, 0)}), Kind::kUnchecked);
  // What a sensor read on another day, or of a free finger, checks nothing.
  EXPECT_EQ(JudgedAs({}, {Log(early, {}), Log(late, {}, 0)}), Kind::kUnchecked);
  LogResult free = Log(late, {}, 0);
  free.free_rows = free.force_compared = 100;
  EXPECT_EQ(JudgedAs({}, {free}), Kind::kUnchecked);
  EXPECT_EQ(JudgedAs({}, {Log(late, {some})}), Kind::kWatch);
  EXPECT_EQ(JudgedAs({}, {Log(late, {moved})}), Kind::kZero);
  EXPECT_EQ(JudgedAs({}, {Log(late, {moved}), Log(late, {stiff})}),
            Kind::kCalibrate);
  EXPECT_EQ(JudgedAs({}, {Log(late, {stiff}), Log(late, {dead})}),
            Kind::kRepair);
  EXPECT_EQ(JudgedAs({}, {Log(late, {stiff, frozen})}), Kind::kRepair);
  // The finger is as it was.
  const std::string sensor = "likeliest cause: the force sensor has an offset";
  EXPECT_EQ(
      JudgedAs({}, {Log(late, {Of("forces_differ", sensor + "; estimated")})}),
      Kind::kWatch);
  EXPECT_EQ(JudgedAs({}, {Log(late, {Of("forces_differ",
                                        sensor + ", or as well: stiffness")})}),
            Kind::kCalibrate);
  const std::string both = ", or as well: friction is not the scene's; of";
  EXPECT_EQ(JudgedAs({}, {Log(late, {Of("forces_differ", sensor + both)})}),
            Kind::kWatch);
  const Warning either = Of("unexplained_frames",
                            "likeliest cause: the gauges' offsets have moved, "
                            "or as well: gauge 1 has the wrong sign; 9");
  EXPECT_EQ(JudgedAs({}, {Log(late, {either})}), Kind::kZero);
  const Warning swapped = Of("unexplained_frames",
                             "likeliest cause: gauges 1 and 2 are swapped; 9");
  EXPECT_EQ(JudgedAs({}, {Log(late, {swapped})}), Kind::kRepair);
  EXPECT_EQ(JudgedAs({}, {Log(early, {stiff}), Log(late, {})}), Kind::kWatch);
  EXPECT_EQ(JudgedAs({}, {Log("", {stiff}), Log("", {})}), Kind::kCalibrate);
  const Warning never = Of("not_calibrated", "the finger is not calibrated");
  EXPECT_EQ(JudgedAs({never}, {Log(late, {})}), Kind::kCalibrate);
}

constexpr char kSummary[] = R"(finger: f
logs:
  - log: runs/2026-03-05.csv
    result: elsewhere/D/sub/a.frames.csv
    frames: 10
    status: {ok: 4, no_contact: 6}
    unexplained_frames: 1
    force_compared_frames: 10
    force_rms_error_N: 0.25
    force_judged_frames: 4
    free_rows: 2
    free_sums_V: [0.5, 1]
    warnings:
      - {code: forces_differ, text: a, remedy: b}
bad_logs:
  - {log: b.csv, reason: "b.csv:2: bad"}
)";

TEST(BatchResults, ReadsASummaryThatWasMoved) {
  TempFolder folder;
  folder.Write("summary.yaml", kSummary);
  std::filesystem::create_directory(folder.Path("sub"));
  folder.Write("sub/a.frames.csv", "x\n");
  const BatchResults batch = ReadBatchResults(folder.Path(""));
  ASSERT_EQ(batch.logs.size(), 1u);
  const LogResult& log = batch.logs[0];
  EXPECT_THAT(log.result, testing::EndsWith("sub/a.frames.csv"));
  EXPECT_EQ(log.day, "2026-03-05");
  EXPECT_EQ(log.status.at("no_contact"), 6u);
  EXPECT_EQ(log.force_rms_N, 0.25);
  EXPECT_EQ(log.force_judged, 4u);
  EXPECT_EQ(log.warnings[0].code, "forces_differ");
  ASSERT_EQ(batch.bad_logs.size(), 1u);
  EXPECT_EQ(batch.bad_logs[0].reason, "b.csv:2: bad");
}

TEST(BatchResults, AMissingResultIsNamed) {
  TempFolder folder;
  folder.Write("summary.yaml", kSummary);
  try {
    ReadBatchResults(folder.Path(""));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("summary.yaml:4:13: "));
    EXPECT_THAT(error.what(), HasSubstr("there is no a.frames.csv in "));
  }
}

}  // namespace
}  // namespace finray
