#ifndef FINRAY_SENSING_ESTIMATED_FORCE_H_
#define FINRAY_SENSING_ESTIMATED_FORCE_H_

#include "finray/sensing/frame_estimate.h"

namespace finray {

/// Magnitude of the total force of all contacts, for comparison with a
/// reference sensor. NaN if the frame is not solved.
double EstimatedForce(const FrameEstimate& estimate,
                      double friction_coefficient);

}  // namespace finray

#endif  // FINRAY_SENSING_ESTIMATED_FORCE_H_
