#ifndef FINRAY_ESTIMATION_FREE_FRAME_H_
#define FINRAY_ESTIMATION_FREE_FRAME_H_

#include "finray/estimation/frame_estimate.h"
#include "finray/fit/calibration_errors.h"
#include "finray/scene/scene.h"

namespace finray {

/// Decides between no_contact and unobservable for a frame in which no contact
/// is significant. `estimate` is FrameEstimator::FreeEstimate with its chi2 and
/// dof. The free finger does not explain the frame if the p-value is below
/// FrameEstimate::kUnexplained, also with the errors that the finger's
/// calibration may have (FrameEstimate::model_chi2, which takes an
/// equilibrium). The frame is then unobservable, without force and shape.
void JudgeFree(const Measurements& row, CalibrationErrors* systematic,
               FrameEstimate* estimate);

/// Makes a frame unobservable, without force and shape: nobody knows whether
/// there is a contact.
void LeaveUnknown(FrameEstimate* estimate);

/// How far the offsets of a scene may be from the finger's (IsPossible):
/// anywhere, if they wander, else nowhere else.
double OffsetsWander_V(const Scene& scene);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_FREE_FRAME_H_
