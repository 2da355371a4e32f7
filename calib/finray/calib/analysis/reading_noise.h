#ifndef FINRAY_CALIB_ANALYSIS_READING_NOISE_H_
#define FINRAY_CALIB_ANALYSIS_READING_NOISE_H_

#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/finger/finger.h"
#include "finray/io/warning.h"

namespace finray {

/// Gives the gauges of a calibrated finger the noise of one reading, which it
/// senses with.
///
/// The fit uses the plan's gauge_std_V, which is the std of a row. Rows may be
/// means of many readings. If the logs tell how single readings scatter about
/// them (CalibrationLogs::reading_std_V), noise_V becomes that scatter, but not
/// less than gauge_std_V. If they do not, noise_V is gauge_std_V; a warning
/// `noise_of_rows` then says where that is below half the given finger's
/// noise_V. Without a gauge_std_V nothing changes.
void SetReadingNoise(const CalibrationProblem& problem, Finger* finger,
                     std::vector<Warning>* warnings);

/// The noise of a finger after SetReadingNoise(), and which gauges have it from
/// the scatter of single readings; empty if none has.
std::string ReadingNoiseWords(const CalibrationProblem& problem,
                              const Finger& finger);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_READING_NOISE_H_
