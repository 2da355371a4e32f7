#include "finray/calib/analysis/reading_noise.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "finray/io/message_text.h"
#include "finray/io/number_text.h"

namespace finray {

void SetReadingNoise(const CalibrationProblem& problem, Finger* finger,
                     std::vector<Warning>* warnings) {
  const std::optional<double>& row_std_V = problem.plan().gauge_std_V;
  if (!row_std_V) return;
  const std::vector<double>& scatter_V = problem.logs().reading_std_V;
  double most_V = 0;  // of the given finger, where it is replaced
  for (std::size_t j = 0; j < finger->gauges.size(); ++j) {
    if (j < scatter_V.size() && std::isfinite(scatter_V[j])) {
      finger->gauges[j].noise_V = std::max(scatter_V[j], *row_std_V);
    } else {
      most_V = std::max(most_V, problem.given_noise_V()[j]);
    }
  }
  if (*row_std_V >= 0.5 * most_V) return;
  warnings->push_back(
      {"noise_of_rows",
       FormatText("the plan's gauge_std_V of %.2g mV replaces a noise_V of "
                  "%.2g mV in the calibrated finger; if the rows are means, "
                  "single readings scatter more",
                  1e3 * *row_std_V, 1e3 * most_V),
       "before the finger senses by single readings, give it their noise_V; a "
       "log with gauge_<j>_scatter_V, as finray_import --plateaus writes, does "
       "that"});
}

std::string ReadingNoiseWords(const CalibrationProblem& problem,
                              const Finger& finger) {
  const std::vector<double>& scatter_V = problem.logs().reading_std_V;
  std::string noise_mV;
  std::vector<std::string> with_scatter;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    noise_mV += FormatText("%.2g ", 1e3 * finger.gauges[j].noise_V);
    if (j < scatter_V.size() && std::isfinite(scatter_V[j])) {
      with_scatter.push_back(std::to_string(j + 1));
    }
  }
  if (!problem.plan().gauge_std_V || with_scatter.empty()) return "";
  std::string gauges;
  if (with_scatter.size() < finger.gauges.size()) {
    gauges = (with_scatter.size() == 1 ? " of gauge " : " of gauges ") +
             Joined(with_scatter);
  }
  return FormatText("%smV, the scatter of single readings%s; rows have %.2g mV",
                    noise_mV.c_str(), gauges.c_str(),
                    1e3 * *problem.plan().gauge_std_V);
}

}  // namespace finray
