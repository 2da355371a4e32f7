#ifndef FINRAY_CALIB_SOLVE_FRAME_SURFACE_H_
#define FINRAY_CALIB_SOLVE_FRAME_SURFACE_H_

#include <cstddef>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/model/model_surface.h"

namespace finray {

/// From so many frames on the cells of a surface are worth their equilibria.
constexpr std::size_t kFramesForSurface = 2000;

/// Returns the model of all frames at the present values of the parameters,
/// for those that it serves (FrameLinearizer::FitsSurface). It leaves out
/// `exact_std` of the gauges, and at most `most_rad`, where gauges tell hardly
/// anything.
ModelSurface SurfaceOf(const CalibrationProblem& problem, double exact_std,
                       double most_rad, bool by_parameter);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_FRAME_SURFACE_H_
