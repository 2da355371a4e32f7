#ifndef FINRAY_CALIB_ANALYSIS_READING_NOISE_H_
#define FINRAY_CALIB_ANALYSIS_READING_NOISE_H_

#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/finger/finger.h"
#include "finray/io/warning.h"

namespace finray {

/// Returns the noise of one reading of each gauge, with which the calibrated
/// finger senses.
///
/// The fit uses the plan's gauge_std_V, which is the std of a row. Rows may be
/// means of many readings. If the logs tell how single readings scatter about
/// them (CalibrationLogs::reading_std_V), the noise is that scatter, but not
/// less than gauge_std_V. If they do not, it is gauge_std_V. Without a
/// gauge_std_V it is the finger's noise_V.
std::vector<double> ReadingNoise_V(const CalibrationProblem& problem);

/// Gives the gauges of a calibrated finger that noise. A warning
/// `noise_of_rows` says where it is gauge_std_V and below half the given
/// finger's noise_V.
void SetReadingNoise(const CalibrationProblem& problem, Finger* finger,
                     std::vector<Warning>* warnings);

/// The noise of a finger after SetReadingNoise(), and which gauges have it from
/// the scatter of single readings; empty if none has.
std::string ReadingNoiseWords(const CalibrationProblem& problem,
                              const Finger& finger);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_READING_NOISE_H_
