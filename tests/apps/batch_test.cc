// finray_estimate over many and long logs, interrupted and resumed.

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <map>
#include <random>
#include <thread>

#include "apps/command_line.h"
#include "finray/io/frame_table.h"
#include "sensing/uncertain_finger.h"
#include "sensing/wandering_log.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::_;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class BatchTest : public CommandLineTest {
 protected:
  BatchTest() {
    // Frames cost next to nothing: what is tested is what is around them.
    folder_.Write("scene.yaml", "contacts: 0\n");
    std::filesystem::create_directory(folder_.Path("runs"));
  }

  void WriteLog(const std::string& name, int frames, int seed) {
    std::ofstream log(folder_.Path(name));
    log << "time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,force_N,note\n";
    for (int i = 0; i < frames; ++i) {
      const int v = (i * 37 + seed) % 1000;
      log << i << "," << v * 1e-5 << ",0.00" << v % 97 << ",0.01,"
          << (v % 50 == 0 ? "" : "0.001") << "," << v * 1e-3 << ",n" << v
          << "\n";
    }
  }

  // Arguments for the logs of the folder.
  std::string Arguments(const std::string& logs, const std::string& more) {
    return "--finger " + paper_ + " --scene %scene.yaml --logs " + logs +
           " --threads 2 " + more;
  }

  std::map<std::string, std::string> Files(const std::string& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(folder_.Path(folder))) {
      const std::string name = entry.path().filename().string();
      // Temporaries of small files that a kill has hit.
      if (name.rfind(".finray-", 0) == 0) continue;
      files[name] = folder_.Read(folder + "/" + name);
    }
    return files;
  }

  // A process of the executable, silent.
  pid_t Start(const std::vector<std::string>& arguments) {
    std::vector<char*> argv;
    std::vector<std::string> all = {FINRAY_BINARY_DIR "/finray_estimate"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    for (std::string& argument : all) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      const int log = open(folder_.Path("stderr").c_str(),
                           O_WRONLY | O_CREAT | O_TRUNC, 0666);
      dup2(log, STDOUT_FILENO);
      dup2(log, STDERR_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
    return child;
  }

  std::vector<std::string> ArgumentsOf(const std::string& logs,
                                       const std::string& out) {
    return {"--finger",  paper_,
            "--scene",   folder_.Path("scene.yaml"),
            "--logs",    folder_.Path(logs),
            "--out_dir", folder_.Path(out),
            "--threads", "2"};
  }

  static int ExitCode(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  // Peak memory of a run over a log of so many frames, in MB.
  double PeakMemory(int frames) {
    WriteLog("long.csv", frames, 1);
    const pid_t child = Start(ArgumentsOf("long.csv", "out"));
    int status = 0;
    rusage usage;
    wait4(child, &status, 0, &usage);
    EXPECT_EQ(ExitCode(status), 0) << folder_.Read("stderr");
    EXPECT_THAT(folder_.Read("stderr"),
                HasSubstr("frames         " + std::to_string(frames)));
    std::printf("%s%d frames: peak %.1f MB\n", folder_.Read("stderr").c_str(),
                frames, usage.ru_maxrss / 1024.0);
    return static_cast<double>(usage.ru_maxrss) / 1024;
  }
};

// One log whose offsets have moved is 4 % of all frames and loud all the same.
TEST_F(BatchTest, OneLogWithMovedOffsetsIsLoudAndStrictCountsIt) {
  Finger finger = ReadFinger(paper_);
  for (auto& gauge : finger.gauges) gauge.noise_V = 3e-4;
  finger.calibration = TypicalCovariance(finger);
  finger.calibration->correlations.diagonal().setOnes();
  folder_.Write("finger.yaml", FingerToYaml(finger, ""));
  const auto write = [&](const std::string& name, int frames, double moved_V) {
    std::mt19937 random(5);
    std::normal_distribution<> noise(moved_V, 3e-4);
    std::ofstream log(folder_.Path(name));
    log << "gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n";
    for (int i = 0; i < frames; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        log << finger.gauges[j].offset_V + noise(random)
            << (j < 3 ? "," : "\n");
      }
    }
  };
  write("runs/a.csv", 2000, 0);
  const std::string arguments =
      "--finger %finger.yaml --scene %scene.yaml --logs '%runs/*.csv' "
      "--out_dir %out --threads 2 --strict";
  const Outcome good = Run("finray_estimate", arguments);
  EXPECT_EQ(good.code, 0) << good.output;
  EXPECT_THAT(good.output, Not(HasSubstr("warning")));
  EXPECT_THAT(good.output, HasSubstr("force error    not known: no ok or "
                                     "no_contact frame with a force_N\n"));
  write("runs/b.csv", 80, 0.015);
  const Outcome moved = Run("finray_estimate", arguments);
  EXPECT_EQ(moved.code, 4) << moved.output;
  EXPECT_THAT(
      moved.output,
      HasSubstr("\nwarning: likeliest cause: the gauges' offsets have moved; "
                "80 of 80 solved frames of " +
                folder_.Path("runs/b.csv") + " are not explained"));
}

// Gauges that have all moved by as much agree on contacts that are not there:
// chi2 shows nothing, the force sensor does.
TEST_F(BatchTest, TheShareOfUnexplainedFramesIsAGate) {
  const std::string data = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";
  FrameTable log = FrameTable::Read(data + "holdout.csv");
  log.Write(folder_.Path("good.csv"));
  for (double& volts : log.MutableNumbers("gauge_2_V")) volts += 0.1;
  log.Write(folder_.Path("slipped.csv"));
  const auto run = [&](const std::string& name) {
    return Run("finray_estimate",
               "--finger " + data + "hidden_finger.yaml --logs %" + name +
                   ".csv --out_dir %" + name + " --most_unexplained_percent 2");
  };
  const Outcome good = run("good"), slipped = run("slipped");
  EXPECT_EQ(good.code, 0) << good.output;
  EXPECT_EQ(slipped.code, 4) << slipped.output;
  EXPECT_THAT(slipped.output, HasSubstr("gates          most_unexplained_"
                                        "percent 2 ("));
}

TEST_F(BatchTest, EqualShiftsOfAllGaugesAreLoud) {
  const std::string data = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";
  Finger finger = ReadFinger(data + "hidden_finger.yaml");
  finger.calibration = TypicalCovariance(finger);
  finger.calibration->correlations.diagonal().setOnes();
  finger.calibration->std *= 0.1;  // a good calibration
  folder_.Write("finger.yaml", FingerToYaml(finger, ""));
  const FrameTable log = FrameTable::Read(data + "holdout.csv");
  const auto run = [&](double shift_V, const std::string& out) {
    FrameTable shifted = log;
    for (const char* gauge :
         {"gauge_1_V", "gauge_2_V", "gauge_3_V", "gauge_4_V"}) {
      for (double& volts : shifted.MutableNumbers(gauge)) volts += shift_V;
    }
    shifted.Write(folder_.Path("shifted.csv"));
    return Run(
        "finray_estimate",
        "--strict --finger %finger.yaml --logs %shifted.csv --out_dir " + out);
  };
  const Outcome good = run(0, "%good");
  EXPECT_EQ(good.code, 0) << good.output;
  EXPECT_THAT(good.output, Not(HasSubstr("warning")));
  const Outcome moved = run(0.02, "%moved");
  EXPECT_EQ(moved.code, 4) << moved.output;
  EXPECT_THAT(moved.output, Not(HasSubstr("unexplained 0\n")));
  EXPECT_THAT(moved.output,
              HasSubstr("\nwarning: likeliest cause: the gauges' offsets have "
                        "moved; estimated forces differ from the force_N"));
  EXPECT_THAT(moved.output, HasSubstr("the gauges read +20, +20, +20, +20 mV"));
  const YAML::Node log_entry =
      YAML::LoadFile(folder_.Path("moved/summary.yaml"))["logs"][0];
  EXPECT_EQ(log_entry["warnings"][1]["code"].as<std::string>(),
            "forces_differ");
  EXPECT_EQ(log_entry["free_rows"].as<int>(), 10);
  const FrameTable table = FrameTable::Read(folder_.Path("moved/summary.csv"));
  EXPECT_EQ(FrameTable(table).MutableText("warnings")[0],
            "unexplained_frames forces_differ");
  // A finished log that is kept tells the same.
  EXPECT_EQ(Run("finray_estimate",
                "--strict --finger %finger.yaml --logs %shifted.csv "
                "--out_dir %moved --resume")
                .code,
            4);
}

// Without a force sensor such a shift shows in two things: frames are not
// explained, and nothing is ever free.
TEST_F(BatchTest, EqualShiftsWithoutAForceFailStrict) {
  const std::string data = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";
  FrameTable log = FrameTable::Read(data + "holdout.csv");
  for (double& force_N : log.MutableNumbers("force_N")) force_N = std::nan("");
  const auto run = [&](const std::string& out) {
    return Run("finray_estimate",
               "--strict --finger " + data +
                   "hidden_finger.yaml --logs %log.csv --out_dir " + out);
  };
  log.Write(folder_.Path("log.csv"));
  EXPECT_EQ(run("%good").code, 0);
  for (const char* gauge :
       {"gauge_1_V", "gauge_2_V", "gauge_3_V", "gauge_4_V"}) {
    for (double& volts : log.MutableNumbers(gauge)) volts += 0.02;
  }
  log.Write(folder_.Path("log.csv"));
  const Outcome moved = run("%moved");
  EXPECT_EQ(moved.code, 4) << moved.output;
  EXPECT_THAT(moved.output, HasSubstr("zero them with finray_zero"));
}

TEST_F(BatchTest, TheSummaryCountsEndedSearchesAndNamesHiddenForces) {
  const std::string data = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";
  folder_.Write("limit.yaml", "search_iteration_limit: 5\n");
  const std::string arguments =
      "--finger " + data + "hidden_finger.yaml --logs " + data + "holdout.csv ";
  const Outcome limited =
      Run("finray_estimate", arguments + "--scene %limit.yaml --out_dir %out");
  ASSERT_EQ(limited.code, 0) << limited.output;
  FrameTable frames = FrameTable::Read(folder_.Path("out/holdout.frames.csv"));
  double ended = 0;
  for (const double one : frames.Numbers("search_ended")) ended += one;
  EXPECT_GT(ended, 0);
  const YAML::Node yaml = YAML::LoadFile(folder_.Path("out/summary.yaml"));
  EXPECT_EQ(yaml["all"]["search_ended_frames"].as<double>(), ended);
  EXPECT_EQ(yaml["logs"][0]["search_ended_frames"].as<double>(), ended);
  EXPECT_THAT(
      limited.output,
      HasSubstr("searches       " + std::to_string(static_cast<int>(ended)) +
                " ended by the scene's limit of 5\n"));
  const YAML::Node hidden = yaml["hidden_forces"];
  ASSERT_EQ(hidden["contact_mm"].size(), 57u);
  EXPECT_EQ(hidden["contact_mm"][28].as<double>(), 70);
  EXPECT_EQ(hidden["contact_mm"][41].as<double>(), 102.5);
  EXPECT_LT(hidden["normal_N"][28].as<double>(), 0.1);
  EXPECT_GT(hidden["normal_N"][1].as<double>(), 5);
}

TEST_F(BatchTest, PatternsListsAndTables) {
  WriteLog("runs/a.csv", 300, 1);
  WriteLog("runs/b.csv", 200, 2);
  folder_.Write("list.txt", "# two\nruns/b.csv\nruns/a.csv\n");
  const Outcome outcome =
      Run("finray_estimate", Arguments("'%runs/*.csv'", "--out_dir %out"));
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  // The last two are warnings.
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 8);
  EXPECT_THAT(outcome.output,
              HasSubstr("\nwarning: the finger is not calibrated"));
  EXPECT_THAT(outcome.output,
              HasSubstr("\nwarning: likeliest cause: the finger is not "
                        "calibrated; 300 of 300 solved frames of " +
                        folder_.Path("runs/a.csv") +
                        " (the worst of 2 logs) are not explained"));
  EXPECT_THAT(outcome.output, HasSubstr("frames         500 in 2 logs, "));
  const FrameTable table = FrameTable::Read(folder_.Path("out/summary.csv"));
  EXPECT_EQ(table.rows(), 2u);
  FrameTable copy = table;
  EXPECT_EQ(copy.MutableText("frames")[1], "200");
  EXPECT_EQ(copy.MutableText("no_contact")[0], "300");
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
  EXPECT_EQ(yaml["all"]["force_compared_frames"].as<int>(), 500);
  EXPECT_EQ(yaml["warnings"][0]["code"].as<std::string>(), "not_calibrated");
  EXPECT_EQ(yaml["logs"][1]["warnings"][0]["code"].as<std::string>(),
            "unexplained_frames");
  // Readings of many mrad and no contact allowed.
  const int unexplained = yaml["all"]["unexplained_frames"].as<int>();
  EXPECT_EQ(unexplained, 500);
  EXPECT_THAT(outcome.output, HasSubstr("unobservable   0, unexplained 500\n"));

  // Results in the logs' own folder are no logs.
  const std::string in_place = Arguments("'%runs/*.csv'", "--out_dir %runs");
  ASSERT_EQ(Run("finray_estimate", in_place).code, 0);
  const auto files = Files("runs");
  const Outcome again = Run("finray_estimate", in_place + " --resume");
  ASSERT_EQ(again.code, 0) << again.output;
  EXPECT_THAT(again.output, HasSubstr(", 500 kept"));
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
  WriteLog("runs/a.csv", 300, 1);
  WriteLog("runs/x/a.csv", 200, 2);
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

  // None is left.
  EXPECT_EQ(
      Run("finray_estimate", Arguments(log, "--keep_going --out_dir %none"))
          .code,
      2);
  FrameTable none = FrameTable::Read(folder_.Path("none/summary.csv"));
  EXPECT_EQ(none.headers(), summary.headers());
  EXPECT_THAT(none.MutableText("reason"), ElementsAre(reason));
}

TEST_F(BatchTest, KilledAtAnyMomentAndResumed) {
  for (int i = 0; i < 3; ++i) {
    WriteLog("runs/log" + std::to_string(i) + ".csv", 30000 + 5000 * i, i);
  }
  const auto arguments = ArgumentsOf("runs/*.csv", "killed");
  const pid_t whole = Start(ArgumentsOf("runs/*.csv", "whole"));
  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  waitpid(whole, &status, 0);
  ASSERT_EQ(ExitCode(status), 0) << folder_.Read("stderr");
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
  const auto expected = Files("whole");

  std::mt19937 generator(5);
  std::uniform_real_distribution<double> when(0, 0.9 * seconds);
  int kills = 0;
  for (int round = 0; round < 4; ++round) {
    std::filesystem::remove_all(folder_.Path("killed"));
    bool resume = false;
    for (;;) {
      auto these = arguments;
      if (resume) these.push_back("--resume");
      resume = true;
      const pid_t child = Start(these);
      std::this_thread::sleep_for(
          std::chrono::duration<double>(when(generator)));
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      if (ExitCode(status) == 0) break;
      ASSERT_EQ(ExitCode(status), -SIGKILL) << folder_.Read("stderr");
      ++kills;
      if (!std::filesystem::exists(folder_.Path("killed"))) continue;
      for (const auto& [name, bytes] : Files("killed")) {
        if (name[0] != '.' && name.find(".frames.csv") != std::string::npos) {
          ASSERT_EQ(bytes, expected.at(name)) << name;
        }
      }
    }
    auto files = Files("killed");
    ASSERT_EQ(files.size(), expected.size());
    for (auto& [name, bytes] : files) {
      // The overall summaries name the results' folder.
      for (std::size_t at;
           (at = bytes.find("/killed/")) != std::string::npos;) {
        bytes.replace(at, 8, "/whole/");
      }
      ASSERT_EQ(bytes, expected.at(name)) << name;
    }
  }
  std::printf("%d kills in runs of %.2f s\n", kills, seconds);
  EXPECT_GT(kills, 0);
}

TEST_F(BatchTest, SignalsEndARunThatCanBeResumed) {
  WriteLog("runs/a.csv", 2000, 1);
  WriteLog("runs/b.csv", 200000, 2);
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(folder_.Path("out"));
    const pid_t child = Start(ArgumentsOf("runs/*.csv", "out"));
    while (!std::filesystem::exists(folder_.Path("out/.b.frames.csv.part"))) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(ExitCode(status), 130);
    const std::string said = folder_.Read("stderr");
    EXPECT_THAT(said, HasSubstr("finray_estimate: interrupted after "));
    EXPECT_THAT(said, HasSubstr(" of 202000 frames; the same command with "
                                "--resume goes on from there\n"));
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1);
    EXPECT_TRUE(std::filesystem::exists(folder_.Path("out/a.frames.csv")));
    EXPECT_FALSE(std::filesystem::exists(folder_.Path("out/b.frames.csv")));
    EXPECT_FALSE(std::filesystem::exists(folder_.Path("out/summary.yaml")));
    const Outcome outcome =
        Run("finray_estimate",
            Arguments("'%runs/*.csv'", "--out_dir %out --resume"));
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(" kept\n"));
  }
}

TEST_F(BatchTest, MemoryStaysBehindTheLog) {
  // As a table these frames alone would take 100 MB, as text three times that.
  EXPECT_LT(PeakMemory(400000), 150);
}

TEST_F(BatchTest, SlowTenMillionFrames) {
  EXPECT_LT(PeakMemory(10000000), 300);
}

}  // namespace
}  // namespace finray
