#ifndef FINRAY_CALIB_ANALYSIS_GATE_H_
#define FINRAY_CALIB_ANALYSIS_GATE_H_

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
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
  /// The range of a share in percent that such a sample may come from.
  std::optional<std::pair<double, double>> range = {};
};

/// Returns Wilson's interval, in percent, of the share behind `hits` of
/// `trials`: the 98 % interval, or that of z standard deviations.
inline std::pair<double, double> BinomialRange(std::size_t hits,
                                               std::size_t trials,
                                               double z = 2.326) {
  const auto n = static_cast<double>(trials);
  const double p = static_cast<double>(hits) / n;
  const double middle = p + z * z / (2 * n);
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  const double scale = 100 / (1 + z * z / n);
  return {scale * (middle - half), scale * (middle + half)};
}

inline bool AllPassed(const std::vector<Gate>& gates) {
  return std::all_of(gates.begin(), gates.end(),
                     [](const Gate& gate) { return gate.passed; });
}

/// Returns the gates for people, e.g. "most_force_rms_N 0.1 (0.08) passed".
inline std::string GateWords(const std::vector<Gate>& gates) {
  std::vector<std::string> words;
  for (const Gate& gate : gates) {
    const std::string range =
        gate.range ? FormatText(", 98 %% range %.3g to %.3g", gate.range->first,
                                gate.range->second)
                   : "";
    words.push_back(FormatText("%s %.3g (%.3g%s) %s", gate.name.c_str(),
                               gate.bound, gate.value, range.c_str(),
                               gate.passed ? "passed" : "FAILED"));
  }
  return words.empty() ? "none given" : Joined(words);
}

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_GATE_H_
