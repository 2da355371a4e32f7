#include "finray/calib/problem/row_times.h"

#include <algorithm>
#include <cmath>

#include "finray/calib/problem/calibration_log.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

constexpr ParameterFamily kNeedTimes[] = {
    ParameterFamily::kForceTimeOffset, ParameterFamily::kGaugeCreepShare,
    ParameterFamily::kGaugeCreepTime, ParameterFamily::kGaugeDrift,
    ParameterFamily::kGaugeHysteresis};

// Ties leave the order of rows, and a rate over much more than they span.
bool TiesAllow(ParameterFamily family) {
  return family == ParameterFamily::kGaugeDrift ||
         family == ParameterFamily::kGaugeHysteresis;
}

}  // namespace

RowTimes RowTimes::Of(const std::vector<double>& times_s) {
  RowTimes of;
  double last_s = std::nan("");
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    if (std::isnan(times_s[i])) continue;
    const auto row = static_cast<int>(i) + 1;
    if (times_s[i] == last_s && of.ties++ == 0) of.first_tie = row;
    if (times_s[i] < last_s && of.backs++ == 0) of.first_back = row;
    last_s = times_s[i];
  }
  return of;
}

bool TimesAllow(ParameterFamily family, const CalibrationLogs& logs) {
  if (std::count(std::begin(kNeedTimes), std::end(kNeedTimes), family) == 0) {
    return true;
  }
  return std::all_of(
      logs.times.begin(), logs.times.end(), [&](const RowTimes& log) {
        return log.backs == 0 && (log.ties == 0 || TiesAllow(family));
      });
}

std::vector<ParameterFamily> WithoutTimes(const Plan& plan,
                                          const CalibrationLogs& logs) {
  std::vector<ParameterFamily> without;
  for (const ParameterFamily family : kNeedTimes) {
    if (plan.family(family).free && !TimesAllow(family, logs)) {
      without.push_back(family);
    }
  }
  return without;
}

Plan WithTimesOf(Plan plan, const CalibrationLogs& logs) {
  for (const ParameterFamily family : WithoutTimes(plan, logs)) {
    plan.Fix(family);
  }
  return plan;
}

std::string TimesInWords(const CalibrationLogs& logs) {
  int ties = 0, backs = 0, of_logs = 0;
  std::string first_tie, first_back;
  for (std::size_t log = 0; log < logs.times.size(); ++log) {
    const RowTimes& times = logs.times[log];
    ties += times.ties;
    backs += times.backs;
    of_logs += times.ties + times.backs > 0;
    const auto at = [&](int row) {
      return logs.names[log] + " row " + std::to_string(row);
    };
    if (times.ties > 0 && first_tie.empty()) first_tie = at(times.first_tie);
    if (times.backs > 0 && first_back.empty()) {
      first_back = at(times.first_back);
    }
  }
  if (of_logs == 0) return "";
  std::string words = "time_s does not rise from row to row: ";
  if (ties > 0) {
    words += FormatText("%d times it is that of the row before, first in %s",
                        ties, first_tie.c_str());
  }
  if (backs > 0) {
    if (ties > 0) words += "; ";
    words += FormatText("%d times it goes back, first in %s", backs,
                        first_back.c_str());
  }
  return words + FormatText(" (%d of %zu logs)", of_logs, logs.times.size());
}

}  // namespace finray
