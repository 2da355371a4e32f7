#ifndef FINRAY_BENCHMARK_SETTING_H_
#define FINRAY_BENCHMARK_SETTING_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "finray/benchmark/runner.h"
#include "finray/benchmark/setting_name.h"

namespace finray {

/// How much of the log a setting is measured on, by what it costs: the same in
/// every run, so that runs are comparable.
struct FrameBudget {
  int stretches, frames;  ///< of each stretch
};

struct BenchmarkSetting {
  SettingName name;
  std::string words;   ///< For people: "order 8, one element a bay, lanes".
  std::string family;  ///< paper, ceres, chain, taylor: a colour of the plots.
  int links = 0;       ///< n of a chain.
  Discretization discretization;  ///< Of the ladder.
  FrameBudget budget;
  std::function<std::unique_ptr<Runner>(const BenchmarkCase&)> make;
};

/// Everything that is measured, scene by scene. `quick`: less of the log, and
/// chains of few links only.
std::vector<BenchmarkSetting> BenchmarkGrid(const Finger& finger, bool quick);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_SETTING_H_
