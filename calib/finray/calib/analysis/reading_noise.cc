#include "finray/calib/analysis/reading_noise.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "finray/io/message_text.h"
#include "finray/io/number_text.h"

namespace finray {

namespace {

bool HasScatter(const CalibrationProblem& problem, std::size_t gauge) {
  const std::vector<double>& scatter_V = problem.logs().reading_std_V;
  return gauge < scatter_V.size() && std::isfinite(scatter_V[gauge]);
}

}  // namespace

std::vector<double> ReadingNoise_V(const CalibrationProblem& problem) {
  const std::optional<double>& row_std_V = problem.plan().gauge_std_V;
  std::vector<double> noise_V;
  for (const Gauge& gauge : problem.finger().gauges) {
    noise_V.push_back(gauge.noise_V);
    const std::size_t j = noise_V.size() - 1;
    if (!row_std_V || !HasScatter(problem, j)) continue;
    noise_V[j] = std::max(problem.logs().reading_std_V[j], *row_std_V);
  }
  return noise_V;
}

void SetReadingNoise(const CalibrationProblem& problem, Finger* finger,
                     std::vector<Warning>* warnings) {
  const std::vector<double> noise_V = ReadingNoise_V(problem);
  double most_V = 0;  // of the given finger, where the plan's replaces it
  for (std::size_t j = 0; j < finger->gauges.size(); ++j) {
    finger->gauges[j].noise_V = noise_V[j];
    if (!HasScatter(problem, j)) {
      most_V = std::max(most_V, problem.given_noise_V()[j]);
    }
  }
  const std::optional<double>& row_std_V = problem.plan().gauge_std_V;
  if (!row_std_V || *row_std_V >= 0.5 * most_V) return;
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
  std::string noise_mV;
  std::vector<std::string> with_scatter;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    noise_mV += FormatText("%.2g ", 1e3 * finger.gauges[j].noise_V);
    if (HasScatter(problem, j)) {
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
