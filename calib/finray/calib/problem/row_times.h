#ifndef FINRAY_CALIB_PROBLEM_ROW_TIMES_H_
#define FINRAY_CALIB_PROBLEM_ROW_TIMES_H_

#include <string>
#include <vector>

#include "finray/calib/problem/plan.h"

namespace finray {

struct CalibrationLogs;

/// How time_s runs from row to row in a log. Rows without a time are left out.
/// Rows count from 1, and 0 is no row.
struct RowTimes {
  int ties = 0, first_tie = 0;    ///< Rows with the time of the row before.
  int backs = 0, first_back = 0;  ///< Rows that are earlier than that.

  static RowTimes Of(const std::vector<double>& times_s);
};

/// Says whether the times of all logs let a family be free. A force sensor that
/// is late and creep need times that rise from row to row. A drift and the
/// order of rows that hysteresis needs are lost only where times go back.
bool TimesAllow(ParameterFamily family, const CalibrationLogs& logs);

/// The families that the plan frees although times do not allow it.
std::vector<ParameterFamily> WithoutTimes(const Plan& plan,
                                          const CalibrationLogs& logs);
/// Returns the plan with them fixed.
Plan WithTimesOf(Plan plan, const CalibrationLogs& logs);

/// Says in words, over all logs, where times do not rise; empty if they do.
std::string TimesInWords(const CalibrationLogs& logs);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_ROW_TIMES_H_
