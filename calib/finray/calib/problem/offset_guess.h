#ifndef FINRAY_CALIB_PROBLEM_OFFSET_GUESS_H_
#define FINRAY_CALIB_PROBLEM_OFFSET_GUESS_H_

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/parameters.h"

namespace finray {

class CalibrationProblem;

/// Sets each offset to the mean of what its gauge reads in free frames.
void GuessOffsets(const CalibrationLogs& logs,
                  CalibrationParameters* parameters);

/// Where offsets or origins are per log, gives the logs that are held out as a
/// whole those of the last log that was fitted, and then the offsets that their
/// free frames show of the finger as it is now: a lab zeroes its gauges too. To
/// be called after a solve.
void ZeroHeldOutLogs(CalibrationProblem* problem);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_OFFSET_GUESS_H_
