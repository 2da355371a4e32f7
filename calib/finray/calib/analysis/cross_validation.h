#ifndef FINRAY_CALIB_ANALYSIS_CROSS_VALIDATION_H_
#define FINRAY_CALIB_ANALYSIS_CROSS_VALIDATION_H_

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "finray/calib/analysis/error_table.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/analysis/score_test.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/finger/gauge_discrepancy.h"

namespace finray {

/// What the fitted frames but those of one fold say about the free parameters,
/// from the linearization of all. With the information H and the gradient g of
/// all frames and priors at the solution, and S_k, g_k of the fold,
///
///   theta_k = theta - H_k^-1 (g - g_k),   H_k = H - S_k.
///
/// That is one step of Gauss and Newton; it needs no further pass.
struct LeftOut {
  Eigen::VectorXd values;      ///< theta_k
  Eigen::MatrixXd covariance;  ///< H_k^-1, in Identifiability::unit.
  /// The logarithm of the density that they predict for the fold's residuals,
  /// their best contacts given, but for a constant:
  ///   -(c - g'H^-1 g + ln det H - ln det H_k) / 2
  /// with c = chi2 and g = J'r of the fold at theta_k.
  double log_likelihood = 0;
};
LeftOut LeaveFoldOut(const CalibrationProblem& problem,
                     const WideLinearization& wide, int fold);

/// Calls use(fold, LeaveFoldOut of the fold) for each fold, on the threads of
/// the problem. What `use` makes must not depend on the other folds. As many
/// folds are in memory as there are threads.
void ForEachFold(const CalibrationProblem& problem,
                 const WideLinearization& wide,
                 const std::function<void(int fold, const LeftOut& left)>& use);

/// The finger that all folds but one calibrate, with its covariance, and the
/// problem of some frames of that fold at its values, for one thread.
struct LeftOutFinger {
  LeftOutFinger(const CalibrationProblem& problem, const Identifiability& found,
                const LeftOut& left, const std::vector<int>& frames);

  std::unique_ptr<CalibrationProblem> part;
  Finger finger;
};

/// The sum of the folds' log_likelihood. Of two plans for the same frames the
/// one with the larger sum predicts frames better that it has not seen.
double CrossValidatedLogLikelihood(const CalibrationProblem& problem,
                                   const WideLinearization& wide);

/// Forces from the gauges alone, each fold with the finger that the
/// other folds calibrate, against the references, for the frames of
/// WideLinearization::checked. With a discrepancy the intervals have it too.
///
/// The finger theta_k senses in readings V what the finger theta senses in
///
///   V - dV/dtheta (theta_k - theta),
///
/// to first order like theta_k itself. So `estimator`, one of the finger at the
/// solution with a covariance, serves all folds (SensingEstimator).
struct CrossValidation {
  int folds = 0;  ///< 0 if it was not done: too few frames, or held-out ones.
  ErrorTable errors;
};
CrossValidation CrossValidate(
    const CalibrationProblem& problem, const Identifiability& found,
    const WideLinearization& wide, const FrameEstimator* estimator,
    const std::optional<GaugeDiscrepancy>& discrepancy = std::nullopt);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_CROSS_VALIDATION_H_
