#ifndef FINRAY_BENCHMARK_SETTING_NAME_H_
#define FINRAY_BENCHMARK_SETTING_NAME_H_

#include <string>

namespace finray {

/// What a line of the report is about, under a name that stays the same from
/// run to run: `sensing/one_contact/taylor8x1/lanes`.
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

}  // namespace finray

#endif  // FINRAY_BENCHMARK_SETTING_NAME_H_
