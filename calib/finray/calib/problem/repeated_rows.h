#ifndef FINRAY_CALIB_PROBLEM_REPEATED_ROWS_H_
#define FINRAY_CALIB_PROBLEM_REPEATED_ROWS_H_

#include <vector>

#include "finray/calib/problem/calibration_log.h"

namespace finray {

/// Leaves out rows that were written twice: those with all the numbers of an
/// earlier row that has the same time, or whose neighbour repeats the neighbour
/// of this one as well, or that is the row before in a log most of whose rows
/// are so. A log without any other row is left out as a whole. Rows of the
/// bench stay. Sets `copies` and `times` of the logs. `times_s` holds the times
/// of all rows.
void LeaveOutCopies(std::vector<std::vector<double>> times_s,
                    CalibrationLogs* logs);

/// Finds rows that repeat each other, and gives each the std with which all of
/// them together tell as much as they know:
///  - n rows of a log whose object, or marked contact, is at the same place
///    within kSamePlace std share the error of that place. The std of the place
///    counts sqrt(n) times. Gauges and force are read anew in each row, so
///    their scatter averages out.
///  - m rows with the same numbers, which are left when copies are out, are one
///    reading of a coarse converter. All std count sqrt(m) times.
///
/// Let D be the covariance of n merged rows, with readings' std / sqrt(n). Each
/// of the n rows has the covariance n D, and so 1 / n of the merged
/// information.
void MarkRepeatedRows(const Plan& plan, CalibrationLogs* logs);
constexpr double kSamePlace = 0.1;

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_REPEATED_ROWS_H_
