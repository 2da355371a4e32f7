#ifndef FINRAY_CALIB_ANALYSIS_EXPLORE_H_
#define FINRAY_CALIB_ANALYSIS_EXPLORE_H_

#include <string>
#include <vector>

#include "finray/calib/analysis/candidate_effects.h"
#include "finray/calib/problem/calibration_problem.h"

namespace finray {

/// How a plan was found that frees what the logs ask for.
struct Exploration {
  struct Step {
    CandidateEffect effect;
    std::string words;  ///< Of the score test, with the drop it expects.
    double drop = 0;    ///< Of chi2 and priors by the refit.
    /// CrossValidatedLogLikelihood of the same frames, with the effect fixed
    /// and free.
    double before = 0, after = 0;
    bool kept = false;
  };
  std::vector<Step> steps;
  /// Says why nothing more is freed though noise does not explain the
  /// residuals: an effect does that no plan frees, such as a change in mid-log,
  /// or none that is known does. Else empty.
  std::string beyond;
  /// Steps that failed, each with the reason. What was solved before them
  /// stands.
  std::vector<std::string> failed;
};

/// Solves, and frees effects one by one. Each time it tries the best few of
/// those that the score test calls significant, solves anew, and keeps the
/// one that predicts unseen frames best, if any predicts them
/// better than the plan did. Outliers are judged again after each. It ends when
/// no effect is significant or none is kept. A clean log frees nothing but by
/// ScoreTest::kSignificant. A step that fails leaves the solution before it.
/// Throws std::runtime_error if there is not even the first one.
Exploration Explore(CalibrationProblem* problem);

/// Fixes what was freed last, for a reason. Returns false if nothing is free.
bool FixLast(const std::string& why, Exploration* exploration);

/// Says in one line what a step did.
std::string WordsOf(const Exploration::Step& step);

/// Returns `text`, that of the plan at `path`, with the kept effects free. A
/// scene in a file of its own is written into the plan, so that it can lie
/// anywhere.
std::string ExploredPlanYaml(const std::string& path, const std::string& text,
                             const Exploration& exploration);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_EXPLORE_H_
