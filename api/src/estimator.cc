#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "finray/batch/batch_estimation.h"
#include "finray/batch/estimation_summary.h"
#include "finray/batch/estimation_warnings.h"
#include "finray/batch/result_rows.h"
#include "finray/estimation/log_estimator.h"
#include "finray/io/usable_cores.h"
#include "finray/scene/history_filter.h"
#include "inside.h"

namespace finray::v1 {
namespace {

// The log of one call, with where its numbers are.
class LogColumns {
 public:
  LogColumns(const Table& log, const finray::Finger& finger,
             const finray::Scene& scene)
      : columns_(
            finger, Names(log), log.name(),
            {/*angles=*/true, /*gauges_may_lack=*/false, scene.UsesCamera()}) {
    RequireTimeForCreep(finger, Names(log), log.name());
    for (const std::string& name : log.columns()) {
      if (!log.IsText(name)) numbers_.push_back(log.At(name));
    }
  }

  void Read(std::size_t row, Measurements* readings) const {
    columns_.Read([&](std::size_t i) { return numbers_[i][row]; }, readings);
  }

 private:
  static std::vector<std::string> Names(const Table& log) {
    std::vector<std::string> names;
    for (const std::string& name : log.columns()) {
      if (!log.IsText(name)) names.push_back(name);
    }
    return names;
  }

  MeasurementColumns columns_;
  std::vector<Numbers> numbers_;
};

// Collects the estimates of a log, block by block.
class Results {
 public:
  Results(const finray::Finger& finger, const finray::Scene& scene,
          std::size_t rows)
      : columns_(finger, scene),
        finger_(finger),
        friction_(scene.friction_coefficient),
        values_(columns_.names().size()),
        statuses_(rows),
        summaries_((rows + kBlockFrames - 1) / kBlockFrames) {
    for (std::vector<double>& column : values_) column.resize(rows);
  }

  // From any thread; a row once.
  void Put(std::size_t row, const Measurements& readings,
           const FrameEstimate& estimate, std::vector<double>* memory) {
    memory->resize(values_.size());
    columns_.Values(readings, estimate, memory->data());
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i][row] = (*memory)[i];
    }
    statuses_[row] = static_cast<FrameStatus>(estimate.status);
    summaries_[row / kBlockFrames].Add(estimate, friction_, readings, finger_);
  }

  // `find_cause` is told whether a warning needs it.
  Estimation Take(const finray::Finger& finger, const finray::Scene& scene,
                  const std::string& log,
                  const std::function<finray::LogCause(bool)>& find_cause,
                  const finray::EstimationSummary& whole = {}) {
    Estimation result;
    result.numbers = Table(statuses_.size(), log);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      result.numbers.Set(columns_.names()[i], std::move(values_[i]));
    }
    result.statuses = std::move(statuses_);
    // In the order of a batch, for the same sums.
    finray::EstimationSummary all;
    for (const finray::EstimationSummary& block : summaries_) all.Add(block);
    all.Add(whole);
    result.warnings = ToPublic(WarningsOf(finger, scene));
    const finray::LogCause cause = find_cause(NeedsCause(all));
    for (Warning& warning :
         ToPublic(WarningsOf({{&all, log, &cause}}, finger))) {
      result.warnings.push_back(std::move(warning));
    }
    const auto count = [&](finray::FrameStatus status) {
      return all.count(status);
    };
    result.summary = {all.frames,
                      count(finray::FrameStatus::kOk),
                      count(finray::FrameStatus::kNoContact),
                      count(finray::FrameStatus::kUnobservable),
                      count(finray::FrameStatus::kNotConverged),
                      count(finray::FrameStatus::kBadInput),
                      all.unexplained,
                      all.force_compared,
                      std::nan(""),
                      std::nan("")};
    if (all.force_compared > 0) {
      result.summary.force_rms_error_N = all.force_rms_N();
      result.summary.force_max_error_N = all.force_max_N;
    }
    return result;
  }

 private:
  ResultColumns columns_;
  const finray::Finger& finger_;
  double friction_;
  std::vector<std::vector<double>> values_;  // by column
  std::vector<FrameStatus> statuses_;
  std::vector<finray::EstimationSummary> summaries_;  // by block
};

}  // namespace

struct Estimator::Inside {
  finray::Finger finger;
  finray::Scene scene;
  finray::Discretization discretization;
  int threads;
  std::unique_ptr<FrameSolverPool> pool;  ///< Null if all frames go together.

  Estimation OneByOne(const Table& log, const std::function<bool()>& stop);
  Estimation Jointly(const Table& log, const std::function<bool()>& stop) const;
  finray::LogCause CauseOf(const LogColumns& columns, std::size_t rows,
                           bool needed) const;
};

finray::LogCause Estimator::Inside::CauseOf(const LogColumns& columns,
                                            std::size_t rows,
                                            bool needed) const {
  Measurements readings;
  if (!needed) {  // No rows are kept for a log that is as it should be.
    finray::GaugeFaultFinder faults(finger);
    for (std::size_t row = 0; row < rows; ++row) {
      columns.Read(row, &readings);
      faults.Add(row + 1, readings);
    }
    if (WordsOf(faults.Faults(), false).empty()) return {};
  }
  finray::LogEvidence evidence(finger, scene);
  for (std::size_t row = 0; row < rows; ++row) {
    columns.Read(row, &readings);
    evidence.Add(readings);
  }
  return FindLogCause(evidence, finger, scene, discretization, threads, needed);
}

Estimation Estimator::Inside::OneByOne(const Table& log,
                                       const std::function<bool()>& stop) {
  const LogColumns columns(log, finger, scene);
  const std::size_t rows = log.rows();
  Results results(finger, scene, rows);
  // Creep and hysteresis depend on all rows before.
  HistoryFilter history(finger, scene);
  std::vector<Measurements> without_history(history.empty() ? 0 : rows);
  for (std::size_t row = 0; row < without_history.size(); ++row) {
    columns.Read(row, &without_history[row]);
    history.Remove(&without_history[row]);
  }
  std::atomic<bool> stopped = false;
  const auto solve = [&](std::size_t block) {
    if (stopped || (stop && stop())) {
      stopped = true;
      return;
    }
    struct Memory {
      std::vector<Measurements> readings{kBlockFrames};
      std::vector<FrameEstimate> estimates{kBlockFrames};
      std::vector<double> values;
    };
    thread_local Memory memory;
    const std::size_t begin = block * kBlockFrames;
    const std::size_t count = std::min(kBlockFrames, rows - begin);
    const Measurements* readings = memory.readings.data();
    if (without_history.empty()) {
      for (std::size_t i = 0; i < count; ++i) {
        columns.Read(begin + i, &memory.readings[i]);
      }
    } else {
      readings = &without_history[begin];
    }
    pool->SolveBlock(readings, count, memory.estimates.data());
    for (std::size_t i = 0; i < count; ++i) {
      results.Put(begin + i, readings[i], memory.estimates[i], &memory.values);
    }
  };
  const std::size_t blocks = (rows + kBlockFrames - 1) / kBlockFrames;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute(
      [&] { tbb::parallel_for(std::size_t{0}, blocks, solve); });
  if (stopped) throw Interrupted();
  return results.Take(finger, scene, log.name(), [&](bool needed) {
    return CauseOf(columns, log.rows(), needed);
  });
}

Estimation Estimator::Inside::Jointly(const Table& log,
                                      const std::function<bool()>& stop) const {
  const LogColumns columns(log, finger, scene);
  Results results(finger, scene, log.rows());
  HistoryFilter history(finger);
  std::vector<Measurements> readings(log.rows());
  std::vector<double> memory;
  std::size_t done = 0;
  LogEstimator estimator(finger, scene, discretization, threads,
                         [&](const FrameEstimate& estimate) {
                           results.Put(done, readings[done], estimate, &memory);
                           ++done;
                         });
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (row % kBlockFrames == 0 && stop && stop()) throw Interrupted();
    columns.Read(row, &readings[row]);
    history.Remove(&readings[row]);
    try {
      estimator.Add(readings[row]);
    } catch (const finray::InputError& error) {
      throw InputError(log.name() + ": row " + std::to_string(row + 1) + ": " +
                       error.what());
    }
  }
  estimator.Finish();
  finray::EstimationSummary whole;
  whole.walk = estimator.walk();
  whole.alone = estimator.alone();
  return results.Take(
      finger, scene, log.name(),
      [&](bool needed) { return CauseOf(columns, log.rows(), needed); }, whole);
}

Estimator::Estimator(const Finger& finger, const Scene& scene,
                     const EstimateOptions& options) {
  Guarded([&] {
    const finray::FrameMethod method = MethodOf(options);
    inside_.reset(new Inside{finger.inside().finger,
                             SceneOf(scene, options.joint),
                             ToInternal(options.discretization),
                             ThreadsFor("threads", options.threads), nullptr});
    if (options.joint) return;
    inside_->pool = std::make_unique<FrameSolverPool>(FrameSolvers(
        inside_->finger, inside_->scene, inside_->discretization, method));
  });
}
Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;
Estimator& Estimator::operator=(Estimator&&) noexcept = default;

Estimation Estimator::Estimate(const Table& log,
                               const std::function<bool()>& stop) const {
  return Guarded([&] {
    return inside_->pool ? inside_->OneByOne(log, stop)
                         : inside_->Jointly(log, stop);
  });
}

Table Estimation::Merged(const Table& log) const {
  Table merged = log;
  for (const std::string& name : numbers.columns()) {
    merged.Borrow(name, numbers.At(name),
                  std::make_shared<const Table>(numbers));
  }
  std::vector<std::string> words;
  words.reserve(statuses.size());
  for (const FrameStatus status : statuses) {
    words.emplace_back(StatusName(status));
  }
  merged.SetText("status", std::move(words));
  return merged;
}

}  // namespace finray::v1
