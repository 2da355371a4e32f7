#ifndef FINRAY_SENSING_SMOOTHING_H_
#define FINRAY_SENSING_SMOOTHING_H_

#include <cstddef>

#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"
#include "finray/sensing/frame_estimate.h"
#include "finray/sensing/log_prior.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Smooths the runs of frames with one contact, as the scene's `smoothing` says
/// (LogProblem). Changes l_c, f_c, their std, poses and rib tensions; chi2, dof
/// and the alternative remain those of the frame alone. `before` is the prior
/// of the first frame. Returns the prior of the frame that comes next. A run
/// whose problem does not converge remains as it is.
LogPrior Smooth(const Finger& finger, const Scene& scene,
                const Discretization& discretization,
                const Measurements* readings, std::size_t count,
                const LogPrior& before, FrameEstimate* estimates);

}  // namespace finray

#endif  // FINRAY_SENSING_SMOOTHING_H_
