#ifndef FINRAY_CALIB_SOLVE_WEIGHTED_CHECK_H_
#define FINRAY_CALIB_SOLVE_WEIGHTED_CHECK_H_

#include "finray/calib/problem/calibration_problem.h"

namespace finray {

/// The same calibration in the weighted form, as a cross-check of the reduced
/// one: base loads and rib tensions of every frame are unknowns too, and
/// equilibrium and closure are residuals of weight kEquilibriumWeight
/// (EquilibriumResidual, RibLengthResidual). Equilibrium and what follows from
/// it for the parameters are found in another way; the sweep along the beams
/// and the residuals of the measurements are common to the two.
struct WeightedCheck {
  int frames = 0;
  bool converged = false;  ///< both forms
  int iterations = 0;      ///< of the weighted form
  /// Largest difference of a free parameter in units of its std, and of a std
  /// relative to itself, over those that the data and priors determine.
  double value_difference_std = 0, std_difference = 0;
};

/// Of the problem's SomeFrames(), from the present solution.
WeightedCheck CheckWeighted(const CalibrationProblem& problem);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_WEIGHTED_CHECK_H_
