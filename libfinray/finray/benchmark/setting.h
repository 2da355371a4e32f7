#ifndef FINRAY_BENCHMARK_SETTING_H_
#define FINRAY_BENCHMARK_SETTING_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "finray/benchmark/benchmark_case.h"

namespace finray {

/// Runs one solver on the frames of a case. The benchmark knows solvers by this
/// interface alone.
class Runner {
 public:
  explicit Runner(const BenchmarkCase& c) : case_(c), answers_(kStretchFrames) {
    for (FrameAnswer& answer : answers_) {
      answer.contacts.resize(2);
      answer.gauges_rad.resize(
          static_cast<Eigen::Index>(c.finger.gauges.size()));
    }
  }
  virtual ~Runner() = default;

  /// Brings the solver to the solution of a lead-in frame. Not timed.
  virtual void Start(int lead_in) {
    StartAt(lead_in);
    Run(lead_in, 1);
  }
  /// Solves frames first .. first + count - 1, at most kStretchFrames, which
  /// follow the lead-in or the frames of the last Run. Timed.
  virtual void Run(int first, int count) {
    for (int k = 0; k < count; ++k) Solve(first + k, &answers_[k]);
  }
  /// Returns the answer to the k-th frame of the last Run. Not timed.
  virtual FrameAnswer Answer(int k) { return answers_[k]; }
  /// Returns the number of unknowns of a frame.
  virtual int unknowns() const = 0;

 protected:
  /// Brings the solver to where it can solve a lead-in frame.
  virtual void StartAt(int /*frame*/) {}
  /// Solves one frame, for solvers that take frames one by one.
  virtual void Solve(int /*frame*/, FrameAnswer* /*answer*/) {}

  const BenchmarkCase& case_;
  std::vector<FrameAnswer> answers_;  ///< kStretchFrames, allocated.
};

/// Returns a new runner for a case.
using RunnerMaker =
    std::function<std::unique_ptr<Runner>(const BenchmarkCase&)>;

/// Names one line of the report, the same in every run, for example
/// `sensing/one_contact/taylor8x1/surface`.
struct SettingName {
  /// forward, sensing or estimation (docs/evidence/benchmark.md).
  std::string task;
  std::string scene;   ///< no_contact, one_contact, ...
  std::string solver;  ///< Scheme and elements a bay, or solver and links.
  std::string how;     ///< warm, cold, alone, surface, block, live, ...

  std::string id() const {
    return task + "/" + scene + "/" + solver + "/" + how;
  }
};

/// Describes a setting in the result files.
struct SettingLabel {
  SettingName name;
  std::string words;   ///< For people: "order 8, one element a bay, live".
  std::string family;  ///< paper, ceres, chain, taylor: a colour of the plots.
  int links = 0;       ///< n of a chain; 0 without one.
  std::string scheme;  ///< Value of --scheme; empty for the dense chain.
  int resolution = 0;  ///< Value of --resolution.
};

/// The part of the log that a setting is measured on. It depends on the cost of
/// the setting alone, so that runs are comparable.
struct FrameBudget {
  int stretches, frames;  ///< Frames of each stretch.
};

struct BenchmarkSetting : SettingLabel {
  FrameBudget budget;
  RunnerMaker make;
};

/// Returns everything that is measured, scene by scene. `quick` takes less of
/// the log and leaves long chains out.
std::vector<BenchmarkSetting> BenchmarkGrid(const Finger& finger, bool quick);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_SETTING_H_
