#ifndef FINRAY_BENCHMARK_SETTING_H_
#define FINRAY_BENCHMARK_SETTING_H_

#include <string>
#include <vector>

#include "finray/benchmark/runner.h"

namespace finray {

/// Names one line of the report, the same in every run, for example
/// `sensing/one_contact/taylor8x1/lanes`.
struct SettingName {
  /// forward, sensing or estimation (docs/evidence/benchmark.md).
  std::string task;
  std::string scene;   ///< no_contact, one_contact, ...
  std::string solver;  ///< Scheme and elements a bay, or solver and links.
  std::string how;     ///< warm, cold, alone, lanes, block, live, ...

  std::string id() const {
    return task + "/" + scene + "/" + solver + "/" + how;
  }
};

/// Describes a setting in the result files.
struct SettingLabel {
  SettingName name;
  std::string words;   ///< For people: "order 8, one element a bay, lanes".
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
