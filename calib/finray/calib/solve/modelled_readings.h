#ifndef FINRAY_CALIB_SOLVE_MODELLED_READINGS_H_
#define FINRAY_CALIB_SOLVE_MODELLED_READINGS_H_

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

/// Keeps in the problem what depends on the rows before
/// (CalibrationParameters::KeepHistory), at a solution: play follows what the
/// gauges would read without noise, creep and play at the fitted contacts.
/// Fitted values and residuals of least squares are uncorrelated, so that
/// noise does not look like hysteresis. Frames that are not fitted keep their
/// readings.
bool KeepHistory(const Linearization& at, CalibrationProblem* problem);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_MODELLED_READINGS_H_
