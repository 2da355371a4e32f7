#ifndef FINRAY_CALIB_ANALYSIS_REFIT_H_
#define FINRAY_CALIB_ANALYSIS_REFIT_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/analysis/score_test.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// So many effects are tried at most, the best by the score test first. With a
/// turned stage the turn has been the sixth of them.
inline constexpr std::size_t kMostRivals = 8;

/// A problem at its solution.
struct SolvedProblem {
  CalibrationProblem* problem = nullptr;
  std::unique_ptr<CalibrationProblem> owned;  ///< Null if another owns it.
  CalibrationSolution solution;
  double log_likelihood = 0;  ///< CrossValidatedLogLikelihood of the frames.

  /// Half of chi2, priors included.
  double Cost() const;
};

/// Returns the name of a free parameter at an impossible value: no number, or
/// beyond an ImpossibleBound. Empty if there is none.
std::string ImpossibleValue(const SolvedProblem& at);

/// Solves the same frames with the effect free as well. Returns nothing, and
/// says why not, if the solver does not get there, or to where the model cannot
/// be evaluated, or to an ImpossibleValue where `from` has none, or to values
/// of the effect that are further than CandidateEffect::kFarthest from the
/// plan's.
std::optional<SolvedProblem> SolveWith(const CandidateEffect& effect,
                                       const SolvedProblem& from,
                                       std::string* why_not);

/// The score test extrapolates from one point, and far from the truth it may
/// rank a wrong effect first. Solves with each of the best effects
/// whose evidence is not far below the best, if these are several, and returns
/// what a refit says of them for TestScores.
std::vector<Refit> RefitRivals(const SolvedProblem& from,
                               const ScoreTest& score);

/// Judges again which frames are outliers: an effect may explain frames that
/// were rejected. Where other frames cannot be solved for, these stay, and the
/// text says why; else it is empty.
std::string JudgeAgain(SolvedProblem* at);

/// Says whether the residuals of a solution are noise, and few frames are
/// rejected, where the gauges have this noise.
bool FitsWithNoise(const CalibrationProblem& problem,
                   const CalibrationSolution& solution,
                   const std::vector<double>& noise_V);

/// Leaves only effects that explain the residuals to be named: freeing one (or,
/// where none does alone, the best one and the next) leads to possible values,
/// to a chi2 that is not loud and to hardly any rejected frames. One that no
/// plan can free explains them if the chi2 of the solution that it is judged
/// at, less its drop, is not loud. Sets score->explained.
void JudgeEffects(const SolvedProblem& from, ScoreTest* score);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_REFIT_H_
