#ifndef FINRAY_CALIB_ANALYSIS_FINGER_COVARIANCE_H_
#define FINRAY_CALIB_ANALYSIS_FINGER_COVARIANCE_H_

#include "finray/calib/analysis/identifiability.h"
#include "finray/finger/finger.h"

namespace finray {

/// Hands the covariance of a calibration's free parameters to the calibrated
/// finger: the part that belongs to it, which is their marginal covariance
/// where the object's origin is free too. It replaces what an earlier
/// calibration has left, unless nothing of the finger was free.
void KeepCovariance(const CalibrationParameters& parameters,
                    const Identifiability& found, Finger* finger);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_FINGER_COVARIANCE_H_
