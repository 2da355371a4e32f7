// finray_estimate over long logs, interrupted and resumed.

#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "apps/batch_fixture.h"

namespace finray {
namespace {

using testing::HasSubstr;

class BatchResumeTest : public BatchTest {
 protected:
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

TEST_F(BatchResumeTest, KilledAtAnyMomentAndResumed) {
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

TEST_F(BatchResumeTest, SignalsEndARunThatCanBeResumed) {
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

TEST_F(BatchResumeTest, MemoryStaysBehindTheLog) {
  // A table of these frames would take 100 MB, their text three times that.
  EXPECT_LT(PeakMemory(400000), 150);
}

TEST_F(BatchResumeTest, SlowTenMillionFrames) {
  EXPECT_LT(PeakMemory(10000000), 300);
}

}  // namespace
}  // namespace finray
