#include "finray/benchmark/measurement.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

#include "finray/batch/batch_estimation.h"
#include "finray/benchmark/statistics.h"

namespace finray {
namespace {

void Raise(double* largest, double value) {
  // The comparison is true for the NaN at the start too.
  if (!(*largest >= value)) *largest = value;
}

double WallUs() {
  return std::chrono::duration<double, std::micro>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Measures one setting.
class Bench {
 public:
  Bench(const BenchmarkSetting& setting, const BenchmarkCase& c,
        const std::function<AllocationCount()>& allocations)
      : setting_(setting), case_(c), allocations_(allocations) {
    const double before = allocations_ ? allocations_().bytes : 0;
    runner_ = setting.make(c);
    static_cast<SettingLabel&>(result_) = setting;
    if (allocations_) result_.setup_bytes = allocations_().bytes - before;
  }

  // Finds errors, iterations, memory and slow frames, outside the rounds.
  void Judge() {
    const bool forward = setting_.name.task == "forward";
    const auto& truth = forward ? case_.forward : case_.sensed;
    const bool is_load = forward && !case_.scene.object;
    int frames = 0, solved = 0;
    double iterations = 0;
    ForStretches([&](int first, int count) {
      runner_->Run(first, count);
      for (int k = 0; k < count; ++k) {
        const FrameAnswer answer = runner_->Answer(k);
        ++frames;
        if (!answer.solved ||
            !result_.errors.Add(answer, truth[first + k], is_load)) {
          continue;
        }
        ++solved;
        iterations += answer.iterations;
      }
    });
    result_.frames = frames;
    result_.solved_percent = 100. * solved / frames;
    result_.iterations = iterations / std::max(solved, 1);
    result_.unknowns = runner_->unknowns();
    if (allocations_) {
      double calls = 0, bytes = 0;
      ForStretches([&](int first, int count) {
        const AllocationCount before = allocations_();
        runner_->Run(first, count);
        const AllocationCount after = allocations_();
        calls += after.calls - before.calls;
        bytes += after.bytes - before.bytes;
      });
      result_.allocations = calls / frames;
      result_.bytes = bytes / frames;
    }
    if (frames < 100 || setting_.name.how == "block") return;
    std::vector<double> times;
    ForStretches([&](int first, int count) {
      for (int k = 0; k < count; ++k) {
        const double start = WallUs();
        runner_->Run(first + k, 1);
        times.push_back(WallUs() - start);
      }
    });
    result_.slow_frame_us = Quantile(times, 0.99);
  }

  void Round() {
    double time = 0, yardstick = 0;
    ForStretches([&](int first, int count) {
      yardstick += YardstickUs();
      const double start = ThreadSeconds();
      runner_->Run(first, count);
      time += ThreadSeconds() - start;
      yardstick += YardstickUs();
    });
    result_.time_us.push_back(1e6 * time / result_.frames);
    result_.yardstick_us.push_back(yardstick / (2 * setting_.budget.stretches));
  }

  const Measurement& result() const { return result_; }

 private:
  template <class Work>
  void ForStretches(Work work) {
    for (int k = 0; k < setting_.budget.stretches; ++k) {
      const int lead_in = case_.LeadIn(k, setting_.budget.stretches);
      runner_->Start(lead_in);
      work(lead_in + 1, setting_.budget.frames);
    }
  }

  const BenchmarkSetting& setting_;
  const BenchmarkCase& case_;
  const std::function<AllocationCount()>& allocations_;
  std::unique_ptr<Runner> runner_;
  Measurement result_;
};

}  // namespace

bool BenchmarkErrors::Add(const FrameAnswer& answer, const FrameAnswer& truth,
                          bool is_load) {
  if (answer.contacts.size() != truth.contacts.size()) return false;
  for (std::size_t i = 0; !is_load && i < truth.contacts.size(); ++i) {
    const PointContact &a = answer.contacts[i], &b = truth.contacts[i];
    const double force = std::abs(a.normal_N - b.normal_N);
    const double arc = std::abs(a.arc_mm - b.arc_mm);
    Raise(&contact_mm, arc);
    Raise(&normal_N, force);
    contact_squares_mm2 += arc * arc;
    normal_squares_N2 += force * force;
    ++contacts;
    Raise(&normal_percent, 100 * force / b.normal_N);
  }
  Raise(&tip_mm, (answer.tip_pose - truth.tip_pose).head<2>().norm());
  if (truth.gauges_rad.size() > 0) {
    Raise(&gauges_rad,
          (answer.gauges_rad - truth.gauges_rad).cwiseAbs().maxCoeff());
  }
  return true;
}

double BenchmarkErrors::contact_rms_mm() const {
  return contacts > 0 ? std::sqrt(contact_squares_mm2 / contacts) : kNaN;
}

double BenchmarkErrors::normal_rms_N() const {
  return contacts > 0 ? std::sqrt(normal_squares_N2 / contacts) : kNaN;
}

double Measurement::median_us() const { return Median(time_us); }

std::vector<double> Measurement::ratios() const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < time_us.size(); ++i) {
    ratios.push_back(time_us[i] / yardstick_us[i]);
  }
  return ratios;
}

double Measurement::ratio() const { return Quantile(ratios(), kUndisturbed); }

double Measurement::error() const {
  const double error =
      std::isnan(errors.contact_mm) ? errors.gauges_rad : errors.contact_mm;
  return std::max(error, kLeastError);  // NaN stays
}

std::vector<Measurement> MeasureSettings(
    const std::vector<BenchmarkSetting>& grid,
    const std::vector<BenchmarkCase>& cases, const MeasuringOptions& options) {
  std::vector<std::unique_ptr<Bench>> benches;
  const auto advance = [&] {
    if (options.progress) options.progress();
  };
  for (const BenchmarkSetting& setting : grid) {
    benches.push_back(std::make_unique<Bench>(
        setting, CaseOf(cases, setting.name.scene), options.allocations));
    benches.back()->Judge();
    advance();
  }
  std::vector<std::size_t> order(benches.size());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 generator(1);
  for (int round = 0; round < options.rounds; ++round) {
    std::shuffle(order.begin(), order.end(), generator);
    for (const std::size_t i : order) {
      benches[i]->Round();
      advance();
    }
  }
  std::vector<Measurement> results;
  for (const auto& bench : benches) results.push_back(bench->result());
  return results;
}

Scaling MeasureBatches(const BenchmarkCase& one_contact, int most_frames,
                       int most_threads, int rounds) {
  std::vector<Measurements> log;
  while (static_cast<int>(log.size()) < most_frames) {
    for (const BenchmarkFrame& frame : one_contact.frames) {
      log.push_back(frame.readings);
    }
  }
  Scaling scaling;
  for (int frames = 64; frames < 2 * most_frames; frames *= 4) {
    scaling.frames.push_back({std::min(frames, most_frames), 1, {}});
  }
  for (int threads = 1; threads <= most_threads; ++threads) {
    scaling.threads.push_back({most_frames, threads, {}});
  }
  const auto measure = [&](BatchScaling* batch) {
    const std::vector<Measurements> readings(log.begin(),
                                             log.begin() + batch->frames);
    const double start = WallUs();
    EstimateFrames(one_contact.finger, one_contact.scene, {}, readings,
                   batch->threads);
    batch->seconds.push_back(1e-6 * (WallUs() - start));
  };
  for (int round = 0; round < rounds; ++round) {
    for (BatchScaling& batch : scaling.frames) measure(&batch);
    for (BatchScaling& batch : scaling.threads) measure(&batch);
  }
  return scaling;
}

}  // namespace finray
