#ifndef FINRAY_CALIB_ANALYSIS_DISCREPANCY_H_
#define FINRAY_CALIB_ANALYSIS_DISCREPANCY_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/analysis/score_test.h"
#include "finray/finger/gauge_discrepancy.h"

namespace finray {

/// By how much the gauges of a frame with contact are off from a finger that
/// has not seen it, at the place and the force that the references say.
struct GaugeError {
  double place_mm, force_N;
  Eigen::VectorXd error_rad;
  /// What noise, references and the calibration explain of it, rad^2.
  Eigen::MatrixXd expected;
};

/// The errors of the frames of each fold with the finger that the other folds
/// calibrate (LeaveFoldOut), and of rejected frames with that of the solution.
/// The place is that of the solution, which the object's place decides; the
/// force is that of the sensor where there is one. Of each kind there are
/// kMostErrors at most, evenly spread.
struct HeldOutErrors {
  std::vector<GaugeError> fitted, rejected;
};
constexpr std::size_t kMostErrors = 500;
HeldOutErrors GaugeErrorsOf(const CalibrationProblem& problem,
                            const CalibrationSolution& solution,
                            const Identifiability& found,
                            const WideLinearization& wide);

/// Fits the discrepancy S to errors e_i ~ N(0, N_i + S(l_i, f_i)), N_i the
/// expected covariance, by expectation and maximisation for several loads and
/// numbers of places. It returns the one with the best criterion of Akaike, or
/// nothing if that is better without. Errors without a discrepancy gain less
/// than half a unit of chi2 for each number, as S cannot be negative. Where the
/// model is wrong, the frames that show it most are rejected; so those join
/// that are not far beyond what the fitted frames show. It uses the threads of
/// the caller's arena.
std::optional<GaugeDiscrepancy> FitDiscrepancy(const HeldOutErrors& errors);

/// "gauges are off by up to 1.2 mrad rms under 5 N at 70 mm".
std::string WordsOf(const GaugeDiscrepancy& discrepancy);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_DISCREPANCY_H_
