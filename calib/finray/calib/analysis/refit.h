#ifndef FINRAY_CALIB_ANALYSIS_REFIT_H_
#define FINRAY_CALIB_ANALYSIS_REFIT_H_

#include <cmath>
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

/// Returns the name of a free parameter at an impossible value: no number, or 3
/// std below the least or above the most that a finger or bench has. Empty if
/// there is none.
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

/// Chi2 and degrees of freedom of all residuals.
struct TotalChi2 {
  double chi2 = 0, dof = 0;

  static TotalChi2 Of(const Identifiability& found);
  /// In std of chi2.
  double Excess() const { return (chi2 - dof) / std::sqrt(2 * dof); }
  /// Says that noise does not make so much.
  bool IsLoud() const { return dof >= 1 && Excess() >= kLoudStd; }
  static constexpr double kLoudStd = 4;
};

/// Leaves only effects that explain the residuals to be named: freeing one (or,
/// where none does alone, the best one and the next) leads to possible values,
/// to a chi2 that is not loud and to hardly any rejected frames. One that no
/// plan can free explains them if `total`, the chi2 of the solution, less its
/// drop is not loud. If none does, score->explained is false.
void JudgeEffects(const SolvedProblem& from, const TotalChi2& total,
                  ScoreTest* score);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_REFIT_H_
