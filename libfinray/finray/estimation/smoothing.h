#ifndef FINRAY_ESTIMATION_SMOOTHING_H_
#define FINRAY_ESTIMATION_SMOOTHING_H_

#include <cstddef>
#include <vector>

#include "finray/estimation/frame_estimate.h"
#include "finray/estimation/log_prior.h"
#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Smooths the runs of frames with one contact, as the scene's `smoothing` says
/// (LogProblem). Changes l_c, f_c, their std, poses and rib tensions; chi2, dof
/// and the alternative remain those of the frame alone. `before` is the prior
/// of the first frame. Returns the prior of the frame that comes next. A run
/// whose problem does not converge remains as it is.
///
/// No frame moves to where its own readings are not: a run that would do so is
/// smoothed in parts. `sure` says which frames are ok by themselves, and on
/// return also those that such a frame of their part makes sure. A frame in a
/// valley keeps its std, and one that others make sure has theirs at least.
LogPrior Smooth(const Finger& finger, const Scene& scene,
                const Discretization& discretization,
                const Measurements* readings, std::size_t count,
                const LogPrior& before, FrameEstimate* estimates,
                std::vector<char>* sure);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_SMOOTHING_H_
