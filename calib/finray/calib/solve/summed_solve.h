#ifndef FINRAY_CALIB_SOLVE_SUMMED_SOLVE_H_
#define FINRAY_CALIB_SOLVE_SUMMED_SOLVE_H_

#include <optional>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/frame_sum_residual.h"
#include "finray/calib/solve/joint_solve.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

/// Fits the contacts of the frames at the present values and gathers what the
/// frames say about the parameters. Returns nothing if the model cannot be
/// evaluated at one of them; the contacts then stay where they were.
std::optional<Linearization> FitFrames(const std::vector<int>& frames,
                                       CalibrationProblem* problem,
                                       ContactStore* contacts);

/// Adds the priors at the present values.
FrameSums SumsWithPriors(const Linearization& at,
                         const CalibrationParameters& parameters);

struct SummedSolution {
  SolveReport report;
  Linearization at;  ///< The frames at the solution.
};

/// Solves for the parameters by these frames, through FrameSumResidual. The
/// present values must be near the solution. Every pass fits the contact of
/// each frame by itself. Time is linear in the number of frames, and memory is
/// that of a Linearization. `start` saves the first pass if it is the
/// linearization of these frames at the present values. Throws
/// std::runtime_error if the model cannot be evaluated.
SummedSolution SolveSummed(const std::vector<int>& frames,
                           std::optional<Linearization> start,
                           CalibrationProblem* problem, ContactStore* contacts);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_SUMMED_SOLVE_H_
