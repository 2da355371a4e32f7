// From CSV to CSV: what a frame costs, stage by stage, and frames/s of whole
// runs on one and two threads. One contact, four gauges, all columns.
//
//   build/test/tests/batch_benchmark [frames] [folder]
//
// CPU times, the least of some repeats; frames/s by the clock, the best of some
// repeats in turn. "all but the estimator": a solver that hands out estimates
// made before.

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <limits>
#include <memory>
#include <random>

#include "finray/batch/live_rows.h"
#include "finray/batch/log_job.h"
#include "finray/batch/result_rows.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/atomic_file.h"
#include "finray/io/frame_reader.h"
#include "finray/io/frame_table.h"
#include "finray/scene/frame_columns.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kNoise_rad = 1e-4;
constexpr int kRepeats = 5;

double CpuSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec);
}

double WallSeconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Least CPU time of `work`, us a frame.
template <class Work>
double Cost(int frames, Work work) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kRepeats; ++i) {
    const double start = CpuSeconds();
    work();
    least = std::min(least, CpuSeconds() - start);
  }
  return 1e6 * least / frames;
}

// A contact that moves to and fro under a force that comes and goes, 1 kHz.
void WriteLog(const std::string& path, const Finger& finger, int frames) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> noise(0, kNoise_rad);
  EquilibriumSolver solver(finger, {});
  FrameTable log(static_cast<std::size_t>(frames));
  const auto rounded = [](double value, double unit) {
    return std::round(value / unit) / (1 / unit);
  };
  auto& time = log.MutableNumbers("time_s");
  for (int j = 0; j < 4; ++j) log.MutableNumbers(GaugeVolts(j));
  auto& force = log.MutableNumbers("force_N");
  for (int i = 0; i < frames; ++i) {
    const PointContact contact = {70 + 40 * std::sin(0.0015 * i),
                                  4 + 3 * std::cos(0.006 * i), 0};
    solver.Solve({contact});
    time[i] = rounded(0.001 * i, 1e-3);
    force[i] = rounded(contact.normal_N, 1e-3);
    for (int j = 0; j < 4; ++j) {
      log.MutableNumbers(GaugeVolts(j))[i] =
          rounded(solver.outputs()[j] + noise(generator), 1e-7);
    }
  }
  log.Write(path);
}

class BatchBenchmark {
 public:
  BatchBenchmark(int frames, const std::string& folder)
      : frames_(frames),
        folder_(folder),
        log_(folder + "/log.csv"),
        finger_path_(folder + "/finger.yaml"),
        scene_path_(folder + "/scene.yaml") {
    Finger finger = PaperFinger();
    for (Gauge& gauge : finger.gauges) gauge.noise_V = kNoise_rad;
    WriteFileAtomically(finger_path_, FingerToYaml(finger));
    WriteFileAtomically(scene_path_, "contacts: 1\n");
    WriteLog(log_, finger, frames);
    settings_ = std::make_unique<BatchSettings>(finger_path_, scene_path_,
                                                Discretization());
    real_ = FrameSolvers(settings_->finger, settings_->scene, {});
  }

  void Stages() {
    const Finger& finger = settings_->finger;
    const Scene& scene = settings_->scene;
    std::printf("CPU time, us a frame\n");
    const auto print = [](const char* stage, double cost) {
      std::printf("  %-28s %6.2f\n", stage, cost);
      return cost;
    };
    double sum = print("check and SHA-256", Cost(frames_, [&] {
                         LogJob(settings_.get(), log_, Result()).Check();
                       }));
    std::vector<LineBlock> lines;
    sum += print("read", Cost(frames_, [&] {
                   lines.clear();
                   FrameReader reader(log_);
                   LineBlock block;
                   while (reader.ReadLines(kBlockFrames, &block)) {
                     lines.push_back(block);
                   }
                 }));
    const FrameReader reader(log_);
    const ResultLayout layout(finger, scene, reader.parser());
    std::vector<FrameRows> rows(lines.size());
    std::vector<Measurements> readings(static_cast<std::size_t>(frames_));
    const auto for_each = [&](auto work) {
      std::size_t frame = 0;
      for (FrameRows& block : rows) {
        for (std::size_t row = 0; row < block.rows(); ++row) {
          work(block, row, frame++);
        }
      }
    };
    sum += print("parse", Cost(frames_, [&] {
                   for (std::size_t i = 0; i < lines.size(); ++i) {
                     rows[i].Clear();
                     for (std::size_t row = 0; row < lines[i].size(); ++row) {
                       reader.parser().Parse(lines[i].at(row), &rows[i]);
                     }
                   }
                   for_each([&](const FrameRows& block, std::size_t row,
                                std::size_t frame) {
                     layout.Read(block, row, &readings[frame]);
                   });
                 }));
    estimates_.resize(readings.size());
    FrameSolverPool pool(real_);
    const double estimate = Cost(frames_, [&] {
      for (std::size_t i = 0; i < readings.size(); i += kBlockFrames) {
        pool.SolveBlock(&readings[i],
                        std::min(kBlockFrames, readings.size() - i),
                        &estimates_[i]);
      }
    });
    std::vector<std::string> csv(rows.size());
    std::vector<double> values;
    EstimationSummary summary;
    sum +=
        print("format and sum up", Cost(frames_, [&] {
                for (std::string& block : csv) block.clear();
                for_each([&](const FrameRows& block, std::size_t row,
                             std::size_t frame) {
                  const FrameEstimate& estimate = estimates_[frame];
                  layout.Append(block, row, readings[frame], estimate, &values,
                                &csv[frame / kBlockFrames]);
                  summary.Add(estimate, 0, readings[frame], settings_->finger);
                });
              }));
    sum += print("write", Cost(frames_, [&] {
                   ResumableFile out(Result(), "key", false);
                   for (const std::string& block : csv) out.Append(block);
                   out.Finish("");
                   out.Forget();
                 }));
    print("all but the estimator", sum);
    print("estimate", estimate);
  }

  // A line at a time, from the line to its row, without the pipes.
  void Live() {
    FrameReader reader(log_);
    LineBlock lines;
    reader.ReadLines(std::numeric_limits<std::size_t>::max(), &lines);
    FrameEstimator estimator(settings_->finger, settings_->scene);
    LiveRows rows(settings_->finger, settings_->scene, reader.parser(),
                  &estimator);
    LatencyHistogram latency;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const double start = WallSeconds();
      rows.Next(lines.at(i));
      latency.Add(static_cast<std::uint64_t>(1e9 * (WallSeconds() - start)));
    }
    std::printf(
        "live, us from line to row     p50 %.1f  p99 %.1f  p99.9 %.1f\n",
        1e-3 * latency.Quantile(0.5), 1e-3 * latency.Quantile(0.99),
        1e-3 * latency.Quantile(0.999));
  }

  void WholeRuns() {
    // Hands out estimates made before, at no cost but that of copying them.
    const FrameSolverFactory free = [this] {
      return [this, next = std::size_t{0}](const Measurements* /*readings*/,
                                           std::size_t count,
                                           FrameEstimate* estimates) mutable {
        for (std::size_t i = 0; i < count; ++i) {
          estimates[i] = estimates_[next++ % estimates_.size()];
        }
      };
    };
    std::printf("frames/s                      1 thread  2 threads  ratio\n");
    for (const bool estimator : {false, true}) {
      double best[2] = {0, 0};
      const double start = WallSeconds();
      for (int i = 0; i < kRepeats || WallSeconds() < start + 10; ++i) {
        for (const int threads : {1, 2}) {
          best[threads - 1] = std::max(
              best[threads - 1], Speed(threads, estimator ? real_ : free));
        }
      }
      std::printf("  %-26s %9.0f  %9.0f  %5.2f\n",
                  estimator ? "with the estimator" : "all but the estimator",
                  best[0], best[1], best[1] / best[0]);
    }
  }

 private:
  std::string Result() const { return folder_ + "/log.frames.csv"; }

  double Speed(int threads, const FrameSolverFactory& solvers) {
    settings_->threads = threads;
    FrameSolverPool pool(solvers);
    const double start = WallSeconds();
    LogJob job(settings_.get(), log_, Result());
    job.Check();
    job.Run(&pool);
    return frames_ / (WallSeconds() - start);
  }

  int frames_;
  std::string folder_, log_, finger_path_, scene_path_;
  std::unique_ptr<BatchSettings> settings_;
  FrameSolverFactory real_;
  std::vector<FrameEstimate> estimates_;
};

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 30000;
  std::string folder =
      (argc > 2 ? std::string(argv[2])
                : std::filesystem::temp_directory_path().string()) +
      "/finray_XXXXXX";
  if (frames < 1 || mkdtemp(folder.data()) == nullptr) return 1;
  finray::BatchBenchmark benchmark(frames, folder);
  benchmark.Stages();
  benchmark.Live();
  benchmark.WholeRuns();
  std::filesystem::remove_all(folder);
  return 0;
}
