#ifndef FINRAY_CALIB_ANALYSIS_GATE_H_
#define FINRAY_CALIB_ANALYSIS_GATE_H_

#include <algorithm>
#include <string>
#include <vector>

#include "finray/io/message_text.h"
#include "finray/io/number_text.h"

namespace finray {

/// A bound that a user sets on a figure, and whether the figure keeps it.
struct Gate {
  std::string name;  ///< The name of the flag, e.g. "most_force_rms_N".
  double bound;
  double value;  ///< NaN if it is not known; then it fails.
  bool passed;
};

inline bool AllPassed(const std::vector<Gate>& gates) {
  return std::all_of(gates.begin(), gates.end(),
                     [](const Gate& gate) { return gate.passed; });
}

/// Returns the gates for people, e.g. "most_force_rms_N 0.1 (0.08) passed".
inline std::string GateWords(const std::vector<Gate>& gates) {
  std::vector<std::string> words;
  for (const Gate& gate : gates) {
    words.push_back(FormatText("%s %.3g (%.3g) %s", gate.name.c_str(),
                               gate.bound, gate.value,
                               gate.passed ? "passed" : "FAILED"));
  }
  return words.empty() ? "none given" : Joined(words);
}

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_GATE_H_
