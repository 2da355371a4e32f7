#ifndef FINRAY_CALIB_ANALYSIS_FINGER_COVARIANCE_H_
#define FINRAY_CALIB_ANALYSIS_FINGER_COVARIANCE_H_

#include "finray/calib/analysis/identifiability.h"
#include "finray/finger/finger.h"

namespace finray {

/// Gives the calibrated finger the part of the covariance that belongs to its
/// own parameters. If the origin of the object is free too, that is their
/// marginal covariance. It replaces what an earlier calibration has left,
/// unless no parameter of the finger was free.
void KeepCovariance(const CalibrationParameters& parameters,
                    const Identifiability& found, Finger* finger);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_FINGER_COVARIANCE_H_
