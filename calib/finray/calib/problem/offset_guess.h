#ifndef FINRAY_CALIB_PROBLEM_OFFSET_GUESS_H_
#define FINRAY_CALIB_PROBLEM_OFFSET_GUESS_H_

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/parameters.h"

namespace finray {

class CalibrationProblem;

/// Sets each offset to the mean reading of its gauge in free frames.
void GuessOffsets(const CalibrationLogs& logs,
                  CalibrationParameters* parameters);

/// Gives parameters of their own to logs that are held out as a whole, if
/// offsets or origins are per log. They get the values of the last log that was
/// fitted. Their free frames then correct the offsets, with the finger as it is
/// now: a lab zeroes its gauges too. Call it after a solve.
void ZeroHeldOutLogs(CalibrationProblem* problem);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_OFFSET_GUESS_H_
