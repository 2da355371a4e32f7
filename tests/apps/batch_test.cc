// finray_estimate over many logs.

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>

#include "apps/batch_fixture.h"
#include "estimation/uncertain_finger.h"
#include "estimation/wandering_log.h"
#include "finray/io/frame_table.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::_;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST_F(BatchTest, PatternsListsAndTables) {
  WriteLog("runs/a.csv", 300, 1);
  WriteLog("runs/b.csv", 200, 2);
  folder_.Write("list.txt", "# two\nruns/b.csv\nruns/a.csv\n");
  const Outcome outcome =
      Run("finray_estimate", Arguments("'%runs/*.csv'", "--out_dir %out"));
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  // The last four are warnings.
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 10);
  EXPECT_THAT(outcome.output,
              HasSubstr("\nwarning: the finger is not calibrated"));
  EXPECT_THAT(
      outcome.output,
      HasSubstr("/a.csv (the worst of 2 logs) gauge 3 is stuck at 0.01 V "
                "from row 1 to 300 while the others move"));
  EXPECT_THAT(
      outcome.output,
      HasSubstr("\nwarning: likeliest cause: gauge 3 is stuck at 0.01 V "
                "from row 1 to 300 while the others move"));
  EXPECT_THAT(
      outcome.output,
      HasSubstr("300 of 300 solved frames of " + folder_.Path("runs/a.csv") +
                " (the worst of 2 logs) are not explained"));
  EXPECT_THAT(outcome.output, HasSubstr("frames         500 in 2 logs, "));
  const FrameTable table = FrameTable::Read(folder_.Path("out/summary.csv"));
  EXPECT_EQ(table.rows(), 2u);
  FrameTable copy = table;
  EXPECT_EQ(copy.MutableText("frames")[1], "200");
  EXPECT_EQ(copy.MutableText("unobservable")[0], "300");
  EXPECT_EQ(copy.MutableText("log")[0], folder_.Path("runs/a.csv"));
  const auto headers = table.headers();
  EXPECT_THAT(std::vector<std::string>(headers.end() - 6, headers.end()),
              ElementsAre("unexplained_frames", "search_ended_frames",
                          "warnings", "key", "bad_rows", "reason"));
  const YAML::Node yaml = YAML::LoadFile(folder_.Path("out/summary.yaml"));
  EXPECT_EQ(yaml["logs"][1]["frames"].as<int>(), 200);
  EXPECT_EQ(yaml["logs"][1]["key"].as<std::string>(),
            YAML::LoadFile(folder_.Path("out/b.summary.yaml"))["key"]
                .as<std::string>());
  EXPECT_EQ(yaml["warnings"][0]["code"].as<std::string>(), "not_calibrated");
  EXPECT_EQ(yaml["logs"][1]["warnings"][0]["code"].as<std::string>(),
            "gauge_fault");
  // Readings of many mrad and no contact allowed.
  const int unexplained = yaml["all"]["unexplained_frames"].as<int>();
  EXPECT_EQ(unexplained, 500);
  EXPECT_THAT(outcome.output,
              HasSubstr("unobservable   500, unexplained 500\n"));

  // Results in the logs' own folder are no logs.
  const std::string in_place = Arguments("'%runs/*.csv'", "--out_dir %runs");
  ASSERT_EQ(Run("finray_estimate", in_place).code, 0);
  const auto files = Files("runs");
  const Outcome again = Run("finray_estimate", in_place + " --resume");
  ASSERT_EQ(again.code, 0) << again.output;
  EXPECT_THAT(again.output, HasSubstr(", 500 kept"));
  EXPECT_THAT(again.output,
              HasSubstr("/a.csv (the worst of 2 logs) gauge 3 is stuck"));
  EXPECT_EQ(Files("runs"), files);

  EXPECT_EQ(
      Run("finray_estimate", Arguments("@%list.txt", "--out_dir %two")).code,
      0);
  EXPECT_EQ(folder_.Read("two/a.frames.csv"), folder_.Read("out/a.frames.csv"));
  EXPECT_EQ(YAML::LoadFile(folder_.Path("two/summary.yaml"))["logs"][0]["log"]
                .as<std::string>(),
            folder_.Path("runs/b.csv"));
}

TEST_F(BatchTest, ResultsLieAsTheLogsLieInTheirRoot) {
  std::filesystem::create_directory(folder_.Path("runs/x"));
  WriteLog("runs/a.csv", 300, 1, Readings::kFree);
  WriteLog("runs/x/a.csv", 200, 2, Readings::kFree);
  const std::string logs = "%runs/a.csv,%runs/x/a.csv";
  ExpectBadInput("finray_estimate", Arguments(logs, "--out_dir %out"),
                 "would both be written to");
  const std::string mirrored =
      Arguments(logs, "--out_dir %out --logs_root %runs");
  ASSERT_EQ(Run("finray_estimate", mirrored).code, 0);
  EXPECT_NE(folder_.Read("out/x/a.frames.csv"),
            folder_.Read("out/a.frames.csv"));
  EXPECT_THAT(Run("finray_estimate", mirrored + " --resume").output,
              HasSubstr(", 500 kept"));

  // Force errors of logs combine without loss.
  FrameTable table = FrameTable::Read(folder_.Path("out/summary.csv"));
  std::vector<double> squares;
  for (const std::string& text : table.MutableText("force_squares_N2")) {
    squares.push_back(std::stod(text));
  }
  const YAML::Node all =
      YAML::LoadFile(folder_.Path("out/summary.yaml"))["all"];
  EXPECT_GT(squares[0], 0);
  EXPECT_EQ(all["force_squares_N2"].as<double>(), squares[0] + squares[1]);
  EXPECT_EQ(all["force_rms_error_N"].as<double>(),
            std::sqrt((squares[0] + squares[1]) / 500));
}

TEST_F(BatchTest, AWholeLogThatDoesNotConvergeIsEstimatedFrameByFrame) {
  FrameTable log = FrameTable::Read(data_ + "holdout.csv");
  for (const char* gauge : {"gauge_1_V", "gauge_2_V", "gauge_3_V", "gauge_4_V"})
    for (double& volts : log.MutableNumbers(gauge)) volts += 0.005;
  log.Write(folder_.Path("runs/a.csv"));
  folder_.Write("scene.yaml", "contacts: auto\n");
  const Outcome outcome = Run(
      "finray_estimate", Arguments("%runs/a.csv", "--joint --out_dir %out"));
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("could not be solved together"));
  EXPECT_THAT(outcome.output, HasSubstr("estimated one by one"));
  const YAML::Node yaml = YAML::LoadFile(folder_.Path("out/summary.yaml"));
  EXPECT_EQ(yaml["all"]["status"]["not_converged"].as<int>(), 0);
  EXPECT_EQ(YAML::LoadFile(folder_.Path("out/a.summary.yaml"))["alone_frames"]
                .as<int>(),
            110);
}

TEST_F(BatchTest, WholeLogsWithWanderingOffsets) {
  folder_.Write("scene.yaml",
                "contacts: auto\n"
                "gauge_offset_walk: {start_std_V: 0.05, std_V_per_sqrt_s: "
                "0.001}\n");
  WanderingLogSettings settings;
  settings.duration_s = 40;
  const WanderingLog log(PaperFinger(), {Scheme::kTaylor12, 96}, settings);
  std::ofstream rows(folder_.Path("runs/a.csv"));
  rows << "time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,force_N\n";
  rows.precision(9);
  for (const Measurements& row : log.rows) {
    rows << row.time_s;
    for (const double volts : row.gauges_V) rows << ',' << volts;
    rows << ',' << row.force_N << '\n';
  }
  rows.close();
  const auto run = [&](const std::string& more) {
    return Run("finray_estimate", Arguments("%runs/a.csv", "--joint " + more));
  };
  const Outcome outcome = run("--out_dir %one");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  const YAML::Node all =
      YAML::LoadFile(folder_.Path("one/summary.yaml"))["all"];
  EXPECT_EQ(all["frames"].as<int>(), 400);
  EXPECT_LT(all["force_rms_error_N"].as<double>(), 0.4);
  EXPECT_GT(all["status"]["ok"].as<int>(), 150);
  FrameTable table = FrameTable::Read(folder_.Path("one/a.frames.csv"));
  const std::string offset = table.MutableText("gauge_2_offset_V")[300];
  EXPECT_NEAR(std::stod(offset), log.offsets_V[300][1], 0.01);

  // The number of threads changes nothing. A finished log is kept; a frame by
  // frame result is none of it.
  ASSERT_EQ(run("--out_dir %two --threads 1").code, 0);
  EXPECT_EQ(folder_.Read("two/a.frames.csv"), folder_.Read("one/a.frames.csv"));
  EXPECT_THAT(run("--out_dir %two --resume").output, HasSubstr(", 400 kept"));
  const Outcome alone = Run(
      "finray_estimate", Arguments("%runs/a.csv", "--out_dir %two --resume"));
  ASSERT_EQ(alone.code, 0) << alone.output;
  EXPECT_THAT(alone.output, Not(HasSubstr("kept")));
  EXPECT_THAT(alone.output, HasSubstr("gauge_offset_walk is for --joint"));
  EXPECT_THAT(run("--out_dir %two --solver ceres").output,
              HasSubstr("--solver does not go with --joint"));

  // Offsets wander in time.
  std::ofstream(folder_.Path("runs/a.csv"), std::ios::app) << "1,0,0,0,0,0\n";
  const Outcome back = run("--out_dir %out");
  EXPECT_EQ(back.code, 2);
  EXPECT_THAT(back.output, HasSubstr("a.csv: row 401: time_s: expected a time "
                                     "after that of the row before"));
}

TEST_F(BatchTest, BadListsAndLogsAreFoundBeforeAnythingIsWritten) {
  WriteLog("runs/a.csv", 300, 1);
  const auto bad = [&](const std::string& logs, const std::string& message) {
    ExpectBadInput("finray_estimate", Arguments(logs, "--out_dir %out"),
                   message);
  };
  bad("'%runs/*.tsv'", "runs/*.tsv' matches no file");
  bad("@%none.txt", "none.txt: cannot be read");
  std::filesystem::copy(folder_.Path("runs/a.csv"), folder_.Path("a.csv"));
  bad("%runs/a.csv,%a.csv", "a.csv' would both be written to");
  bad("%runs/a.csv,/dev/zero", "/dev/zero: expected a file");
  // One bad cell behind much that is good, in the last log.
  WriteLog("b.csv", 20000, 2);
  std::ofstream(folder_.Path("b.csv"), std::ios::app)
      << "1,0.1,0.1,oops,0.1,1,x\n1,1,1,1,1,1,y\n";
  bad("%runs/a.csv,%b.csv",
      "b.csv:20002:4: gauge_3_V: expected a number, found 'oops'");
}

TEST_F(BatchTest, KeepsGoingWithoutBadLogs) {
  for (int i = 0; i < 3; ++i) {
    WriteLog("runs/" + std::to_string(i) + ".csv", 300, i);
  }
  ASSERT_EQ(Run("finray_estimate",
                Arguments("%runs/0.csv,%runs/2.csv", "--out_dir %good"))
                .code,
            0);
  std::ofstream(folder_.Path("runs/1.csv"), std::ios::app)
      << "1,0.1,0.1,oops,0.1,1,x\n";
  const std::string log = folder_.Path("runs/1.csv");
  const std::string reason =
      log + ":302:4: gauge_3_V: expected a number, found 'oops'";
  const Outcome outcome =
      Run("finray_estimate",
          Arguments("'%runs/*.csv'", "--keep_going --out_dir %all"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("finray_estimate: " + reason + "\n"));
  EXPECT_THAT(outcome.output, HasSubstr("600 in 2 logs"));

  const auto good = Files("good"), all = Files("all");
  EXPECT_EQ(all.size(), good.size());
  EXPECT_EQ(all.at("0.frames.csv"), good.at("0.frames.csv"));
  EXPECT_EQ(all.at("2.frames.csv"), good.at("2.frames.csv"));
  const YAML::Node yaml = YAML::LoadFile(folder_.Path("all/summary.yaml"));
  EXPECT_EQ(yaml["logs"].size(), 2u);
  ASSERT_EQ(yaml["bad_logs"].size(), 1u);
  EXPECT_EQ(yaml["bad_logs"][0]["log"].as<std::string>(), log);
  EXPECT_EQ(yaml["bad_logs"][0]["reason"].as<std::string>(), reason);
  EXPECT_EQ(yaml["all"]["frames"].as<int>(), 600);

  FrameTable summary = FrameTable::Read(folder_.Path("all/summary.csv"));
  EXPECT_THAT(summary.MutableText("log"), ElementsAre(_, _, log));
  EXPECT_THAT(summary.MutableText("reason"), ElementsAre("", "", reason));

  // No result stands under the name of a log that has become bad.
  std::ofstream(folder_.Path("runs/2.csv"), std::ios::app) << "1,x\n";
  const Outcome later =
      Run("finray_estimate",
          Arguments("'%runs/*.csv'", "--keep_going --out_dir %good"));
  EXPECT_EQ(later.code, 2);
  const std::string old = "the result of an earlier run is now " +
                          folder_.Path("good/2.frames.csv") + ".old";
  EXPECT_THAT(later.output, HasSubstr("finray_estimate: " + old + "\n"));
  const auto after = Files("good");
  EXPECT_EQ(after.count("2.frames.csv"), 0u);
  EXPECT_EQ(after.count("2.summary.yaml"), 0u);
  EXPECT_EQ(after.at("2.frames.csv.old"), good.at("2.frames.csv"));
  EXPECT_EQ(after.at("0.frames.csv"), good.at("0.frames.csv"));
  EXPECT_THAT(
      YAML::LoadFile(folder_.Path("good/summary.yaml"))["bad_logs"][1]["reason"]
          .as<std::string>(),
      HasSubstr(old));

  // None is left.
  EXPECT_EQ(
      Run("finray_estimate", Arguments(log, "--keep_going --out_dir %none"))
          .code,
      2);
  FrameTable none = FrameTable::Read(folder_.Path("none/summary.csv"));
  EXPECT_EQ(none.headers(), summary.headers());
  EXPECT_THAT(none.MutableText("reason"), ElementsAre(reason));
}

}  // namespace
}  // namespace finray
