// Streams and jobs with a solver that would show any dependence on threads,
// chunks or interruptions.

#include "finray/batch/log_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "estimation/log_readings.h"
#include "finray/batch/log_stream.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr int kFrames = 1000;  // not a whole number of blocks

// Its results depend on all frames since the last cold start.
void SolveChain(const Measurements* readings, std::size_t count,
                FrameEstimate* estimates) {
  double force = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double reading = readings[i].gauges_V[0];
    force = std::sin(reading) + (i == 0 ? 1 : 0.9 * force);
    FrameEstimate& estimate = estimates[i];
    estimate.status = FrameStatus::kOk;
    estimate.contact[0].normal_N = force;
    estimate.tip_pose.setConstant(0.1 * force);
    estimate.rib_tension_N.assign(5, 1);
    estimate.chi2 = 0;
    // Blocks come to their end out of order.
    if (std::fmod(reading, 7) < 1) std::this_thread::yield();
  }
}

class BatchStreamTest : public testing::Test {
 protected:
  BatchStreamTest()
      : settings_(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml", "",
                  {}) {
    std::string text = "gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,force_N,note\n";
    for (int i = 0; i < kFrames; ++i) {
      text += std::to_string(0.37 * i) + ",0,0,0," +
              std::to_string(1 + 0.01 * i) + ",n" + std::to_string(i) + "\n";
    }
    log_ = folder_.Write("log.csv", text);
  }

  LogJob Job(const std::string& name) {
    LogJob job(&settings_, log_, folder_.Path(name));
    EXPECT_TRUE(job.Check());
    return job;
  }

  // Result and summary of an uninterrupted run on one thread.
  std::pair<std::string, std::string> Expected() {
    FrameSolverPool pool(chain_);
    EXPECT_TRUE(Job("expected.csv").Run(&pool));
    return {folder_.Read("expected.csv"), folder_.Read("log.summary.yaml")};
  }

  const FrameSolverFactory chain_ = [] { return SolveChain; };
  TempFolder folder_;
  BatchSettings settings_;
  std::string log_;
};

TEST_F(BatchStreamTest, SameBytesForAllThreadsAndChunks) {
  const auto [rows, summary] = Expected();
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), kFrames + 1);
  for (const int threads : {1, 2, 5}) {
    for (const std::size_t chunk : {1, 3, 64}) {
      FrameSolverPool pool(chain_);
      settings_.threads = threads;
      settings_.chunk_blocks = chunk;
      LogJob job = Job("out.csv");
      EXPECT_TRUE(job.Run(&pool));
      EXPECT_EQ(folder_.Read("out.csv"), rows) << threads << " " << chunk;
      EXPECT_EQ(folder_.Read("log.summary.yaml"), summary);
    }
  }
}

TEST_F(BatchStreamTest, BlocksLieAtFixedPlaces) {
  int blocks = 0;
  FrameSolverPool pool([&] {
    return [&](const Measurements* readings, std::size_t count,
               FrameEstimate* estimates) {
      ++blocks;
      SolveChain(readings, count, estimates);
    };
  });
  Job("out.csv").Run(&pool);
  EXPECT_EQ(blocks, (kFrames + kBlockFrames - 1) / kBlockFrames);
}

TEST_F(BatchStreamTest, StopAfterAnyBlockAndResume) {
  const auto [rows, summary] = Expected();
  settings_.threads = 2;
  settings_.chunk_blocks = 4;
  for (int stop_at = 0; stop_at <= 17; ++stop_at) {
    std::filesystem::remove(folder_.Path("log.summary.yaml"));
    FrameSolverPool pool(chain_);
    const std::string name = "out" + std::to_string(stop_at) + ".csv";
    settings_.resume = false;
    LogJob first = Job(name);
    int asked = 0;
    settings_.stop = [&] { return asked++ == stop_at; };
    const bool whole = first.Run(&pool);
    settings_.stop = nullptr;
    EXPECT_EQ(whole, stop_at > 16) << stop_at;
    EXPECT_EQ(std::filesystem::exists(folder_.Path(name)), whole);
    EXPECT_EQ(first.summary().frames, std::min(stop_at * 64, kFrames));

    settings_.resume = true;
    std::size_t kept = 0, estimated = 0;
    settings_.progress = [&](std::size_t frames, bool before) {
      (before ? kept : estimated) += frames;
    };
    LogJob second = Job(name);
    EXPECT_TRUE(second.Run(&pool));
    settings_.progress = nullptr;
    EXPECT_EQ(kept, first.summary().frames);
    EXPECT_EQ(estimated + kept, static_cast<std::size_t>(kFrames));
    EXPECT_EQ(folder_.Read(name), rows) << stop_at;
    EXPECT_EQ(folder_.Read("log.summary.yaml"), summary);
  }
}

TEST_F(BatchStreamTest, BadRowsAreLeftOutAlsoWhereARunGoesOn) {
  // Single ones, a whole block of 64, and the last one.
  std::string text = "gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,force_N,note\n";
  std::size_t bad = 0;
  for (int i = 0; i < kFrames; ++i) {
    const bool is_bad =
        i == 3 || (i >= 64 && i < 128) || i % 100 == 77 || i == kFrames - 1;
    bad += is_bad;
    text += std::to_string(0.37 * i) + (is_bad ? ",x" : ",0") + ",0,0,1,n\n";
  }
  log_ = folder_.Write("log.csv", text);
  LogJob strict(&settings_, log_, folder_.Path("strict.csv"));
  EXPECT_THAT([&] { strict.Check(); },
              testing::ThrowsMessage<InputError>(
                  testing::HasSubstr("log.csv:5:2: gauge_2_V: expected")));
  settings_.skip_bad_rows = true;
  settings_.chunk_blocks = 1;
  const auto [rows, summary] = Expected();
  const std::string list = folder_.Read("log.bad_rows.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'),
            kFrames + 1 - static_cast<long>(bad));
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'),
            1 + static_cast<long>(bad));
  EXPECT_THAT(list, testing::StartsWith("line,reason\n5,\"" + log_ + ":5:2: "));
  EXPECT_THAT(summary,
              testing::HasSubstr("\nbad_rows: " + std::to_string(bad)));
  for (const int stop_at : {1, 2, 9}) {
    settings_.threads = 2;
    settings_.resume = false;
    FrameSolverPool pool(chain_);
    LogJob first = Job("out.csv");
    int asked = 0;
    settings_.stop = [&] { return asked++ == stop_at; };
    EXPECT_FALSE(first.Run(&pool));
    settings_.stop = nullptr;
    settings_.resume = true;
    LogJob second = Job("out.csv");
    EXPECT_EQ(second.frames(), kFrames - bad);
    EXPECT_TRUE(second.Run(&pool));
    EXPECT_EQ(folder_.Read("out.csv"), rows) << stop_at;
    EXPECT_EQ(folder_.Read("log.summary.yaml"), summary);
    EXPECT_EQ(folder_.Read("log.bad_rows.csv"), list);
  }
  log_ = folder_.Write("log.csv",
                       "gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n0,0,0\n");
  LogJob none(&settings_, log_, folder_.Path("none.csv"));
  EXPECT_THAT([&] { none.Check(); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr(
                  "log.csv: all rows are bad; the first: ")));
}

// What creeps depends on all rows before, on any number of threads and after
// any interruption.
TEST_F(BatchStreamTest, CreepIsTakenOutInOrder) {
  std::string text = "time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n";
  for (int i = 0; i < kFrames; ++i) {
    text += std::to_string(0.5 * i) + "," + std::to_string(std::sin(0.1 * i)) +
            ",0,0,0\n";
  }
  log_ = folder_.Write("log.csv", text);
  settings_.threads = 1;
  const std::string plain = Expected().first;
  settings_.finger.gauges[0].creep_share = 0.1;
  settings_.resume = false;
  const std::string rows = Expected().first;
  EXPECT_NE(rows, plain);
  for (const int stop_at : {1, 7, 20}) {
    settings_.threads = 3;
    settings_.resume = false;
    FrameSolverPool pool(chain_);
    LogJob first = Job("out.csv");
    int asked = 0;
    settings_.stop = [&] { return asked++ == stop_at; };
    EXPECT_EQ(first.Run(&pool), stop_at == 20);
    settings_.stop = nullptr;
    settings_.resume = true;
    EXPECT_TRUE(Job("out.csv").Run(&pool));
    EXPECT_EQ(folder_.Read("out.csv"), rows) << stop_at;
  }
  const std::string timeless = folder_.Write(
      "timeless.csv", "gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n0,0,0,0\n");
  LogJob job(&settings_, timeless, folder_.Path("timeless.out.csv"));
  EXPECT_THAT([&] { job.Check(); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr(
                  "the creep of the finger's gauges needs it")));
}

TEST_F(BatchStreamTest, AnythingThatMattersChangesTheKey) {
  const std::string key = Job("out.csv").key();
  EXPECT_EQ(key.size(), 64u);
  settings_.threads = 7;
  settings_.chunk_blocks = 1;
  EXPECT_EQ(Job("other.csv").key(), key);
  const auto changed = [&](auto change) {
    const BatchSettings before = settings_;
    change();
    const bool differs = Job("out.csv").key() != key;
    settings_ = before;
    return differs;
  };
  EXPECT_TRUE(changed([&] { settings_.finger_sha256 = "f"; }));
  EXPECT_TRUE(changed([&] { settings_.scene_sha256 = "s"; }));
  EXPECT_TRUE(changed([&] { settings_.format.digits = 6; }));
  EXPECT_TRUE(changed([&] { settings_.format.columns = {"force_N"}; }));
  EXPECT_TRUE(changed([&] { settings_.skip_bad_rows = true; }));
  EXPECT_TRUE(changed([&] { settings_.discretization.resolution = 40; }));
  EXPECT_TRUE(
      changed([&] { settings_.discretization.scheme = Scheme::kTaylor8; }));
  EXPECT_TRUE(changed([&] {
    folder_.Write("log.csv", folder_.Read("log.csv") + "1,1,1,1,1,more\n");
  }));
}

TEST_F(BatchStreamTest, AFinishedLogIsDoneAgainUnlessAllIsAsItWas) {
  FrameSolverPool pool(chain_);
  const auto [rows, summary] = Expected();
  settings_.resume = true;
  const auto estimated = [&] {
    std::size_t count = 0;
    settings_.progress = [&](std::size_t frames, bool kept) {
      if (!kept) count += frames;
    };
    LogJob job = Job("expected.csv");
    EXPECT_TRUE(job.Run(&pool));
    settings_.progress = nullptr;
    EXPECT_EQ(folder_.Read("expected.csv"), rows);
    EXPECT_EQ(folder_.Read("log.summary.yaml"), summary);
    EXPECT_EQ(BatchTable(settings_, {job}, {}).rows(), 1u);
    EXPECT_EQ(job.frames(), static_cast<std::size_t>(kFrames));
    return count;
  };
  EXPECT_EQ(estimated(), 0u);
  {
    ResumableFile interrupted(folder_.Path("expected.csv"), "k", false);
    interrupted.Append("part");
  }
  EXPECT_EQ(estimated(), 0u);
  EXPECT_FALSE(ResumableFile::IsUnderWay(folder_.Path("expected.csv")));
  folder_.Write("expected.csv", rows + "x");
  EXPECT_EQ(estimated(), 1000u);
  std::filesystem::remove(folder_.Path("expected.csv"));
  EXPECT_EQ(estimated(), 1000u);
  folder_.Write("log.summary.yaml", "key: [\n");
  EXPECT_EQ(estimated(), 1000u);
  std::filesystem::remove(folder_.Path("log.summary.yaml"));
  EXPECT_EQ(estimated(), 1000u);
  settings_.resume = false;
  EXPECT_EQ(estimated(), 1000u);
}

TEST_F(BatchStreamTest, ALogThatChangesMeanwhileIsRefused) {
  FrameSolverPool pool(chain_);
  LogJob job = Job("out.csv");
  std::ofstream(log_, std::ios::app) << "1,1,1,1,1,more\n";
  EXPECT_THROW(job.Run(&pool), InputError);
  for (const char* name : {"out.csv", ".out.csv.part", ".out.csv.journal"}) {
    EXPECT_FALSE(std::filesystem::exists(folder_.Path(name))) << name;
  }
}

TEST_F(BatchStreamTest, TheFirstBadPlaceIsTheOneReported) {
  std::string text = folder_.Read("log.csv");
  for (int i = 0; i < 20000; ++i) text += "1,1,1,1,1,more\n";
  const auto at_line = [&](int line) {
    std::size_t at = 0;
    for (int i = 1; i < line; ++i) at = text.find('\n', at) + 1;
    return at;
  };
  text.replace(at_line(15000), 1, "x");
  text.replace(at_line(14990), 2, "1 ");  // a comma less
  text.replace(at_line(18000), 1, "y");
  gzFile zipped = gzopen((log_ + ".gz").c_str(), "wb");
  gzwrite(zipped, text.data(), static_cast<unsigned>(text.size()));
  gzclose(zipped);
  folder_.Write("log.csv", text);
  for (const int threads : {1, 2, 4}) {
    settings_.threads = threads;
    for (const std::string& log : {log_, log_ + ".gz"}) {
      LogJob job(&settings_, log, folder_.Path("out.csv"));
      EXPECT_THAT([&] { job.Check(); },
                  testing::ThrowsMessage<InputError>(
                      log + ":14990: expected 6 cells as in the header, "
                            "found 5"));
    }
  }
}

TEST_F(BatchStreamTest, TheEstimatorRemembersNothing) {
  const FrameTable table =
      FrameTable::Read(FINRAY_SOURCE_DIR "/datasets/simulated_r15/train.csv");
  const auto readings = ReadReadings(settings_.finger, table);
  const FrameSolverFactory make = FrameSolvers(settings_.finger, {}, {});
  const auto forward = make(), backward = make();
  const std::size_t blocks = readings.size() / kBlockFrames;
  std::vector<FrameEstimate> first(readings.size()), second(readings.size());
  const auto solve = [&](const FrameSolver& solver, std::size_t block,
                         std::vector<FrameEstimate>* estimates) {
    solver(&readings[block * kBlockFrames], kBlockFrames,
           &(*estimates)[block * kBlockFrames]);
  };
  ASSERT_GE(blocks, 2u);
  for (std::size_t i = 0; i < blocks; ++i) solve(forward, i, &first);
  for (std::size_t i = blocks; i-- > 0;) solve(backward, i, &second);
  for (std::size_t i = 0; i < blocks * kBlockFrames; ++i) {
    const FrameEstimate &was = first[i], &is = second[i];
    EXPECT_EQ(is.status, was.status);
    EXPECT_EQ(NumberText(is.contact[0].arc_mm),
              NumberText(was.contact[0].arc_mm));
    EXPECT_EQ(NumberText(is.contact[0].normal_N),
              NumberText(was.contact[0].normal_N));
    EXPECT_EQ(NumberText(is.chi2), NumberText(was.chi2));
  }
}

}  // namespace
}  // namespace finray
