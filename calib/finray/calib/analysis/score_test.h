#ifndef FINRAY_CALIB_ANALYSIS_SCORE_TEST_H_
#define FINRAY_CALIB_ANALYSIS_SCORE_TEST_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/analysis/candidate_effects.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/analysis/wide_linearization.h"
#include "finray/calib/problem/calibration_problem.h"

namespace finray {

/// What solving with an effect free has found, where the score test may err.
struct Refit {
  ParameterFamily family;
  double drop;  ///< Of chi2 and priors.
  double
      evidence;  ///< 2 ln of what it does to the likelihood of unseen frames.
  std::map<std::string, double> values;  ///< Of free parameters, as users see.
};

/// Asks which fixed effect the residuals look like. At the solution let r be
/// the whitened residuals, J their derivative by everything free (priors
/// included, contacts eliminated) and a that by fixed parameters e of one
/// family, each in units of its usual std. With P = I - J (J'J)^-1 J' a refit
/// would find, to first order,
///
///   e = -(a'P a + 1)^-1 a'P r,  covariance (a'P a + 1)^-1,
///   drop of chi2 = r'P a (a'P a + 1)^-1 a'P r.
///
/// The 1 is the prior of e. Robust weights are those of the solution. Families
/// of several parameters are tested together, and each parameter alone. Where
/// the candidate has a least value, parameters that would go below are left out
/// of the test: a loop of negative width is noise.
///
/// Candidates that may differ (CandidateEffect::differs), free in the plan or
/// not, are tested by log, for all logs together and each alone, and by stretch
/// of time: from some row of a log to its end. Their derivatives are those of
/// the parameter in these rows, and 0 elsewhere.
///
/// More parameters always lower chi2 more. So effects are ranked by twice the
/// logarithm of their Bayes factor,
///
///   evidence = drop / s^2 - ln det(a'P a + 1),
///
/// which charges each parameter for how much the data narrow its prior (k ln N
/// is its limit for many frames). s^2 = chi2 per degree of freedom without the
/// drop, at least 1: where no effect explains the residuals, none counts more
/// than the rest. An effect is significant if its evidence is above 0 and the
/// probability of its drop / s^2 by chance is below kSignificant / (g t), where
/// g is the number of groups of tests, t the number in its group, and a group
/// are the tests of one family in all rows, or those in some rows (Bonferroni's
/// bound with weights).
struct ScoreTest {
  static constexpr double kSignificant = 0.01;

  struct Value {
    std::string name, unit;
    double value, std;  ///< As the user would see them after a refit.
    double change;      ///< From the fixed value.
    bool from_zero;     ///< The fixed value is 0.
  };
  /// Which rows an effect is in.
  enum class Where {
    kEverywhere,
    kByLog,  ///< It differs from log to log, or in one log.
    kFrom,   ///< From a row of a log on.
  };
  struct Effect {
    ParameterFamily family;
    Where where = Where::kEverywhere;
    std::string rows;  ///< " from a.csv row 31 on"; empty if everywhere.
    std::vector<Value> values;  ///< Largest change over its std first.
    double drop = 0;            ///< Of chi2.
    double evidence = 0;
    double p_value = 1;  ///< Of one test.
    bool significant = false;
    /// "a turned stage, object_rotation_deg 0.98 +- 0.03 (chi2 -830)".
    std::string words;

    /// Says whether a plan can free it.
    bool CanBeFreed() const;
    /// Returns the effect that SolveWith frees to refit this one.
    CandidateEffect Candidate() const;
  };
  /// The best test of each family, the best family first: significant tests
  /// before others, then by evidence.
  std::vector<Effect> effects;
  /// Families that explain what effects[0] explains about as well: their
  /// evidence is near, and little of it is left once effects[0] is free.
  std::vector<Effect> alike;
  /// The best of the others once effects[0] is free, if it is significant.
  std::optional<Effect> next;

  /// Says whether effects[0], alone or with `next`, explains the residuals. It
  /// is empty until JudgeEffects has tried.
  std::optional<bool> explained;

  /// The best effect if it is significant, else null.
  const Effect* Best() const;
  /// Says that the effects were tested, and judged if one is significant, and
  /// that none explains the residuals.
  bool FoundNone() const;
  /// Says what residuals look like; empty if nothing is known to explain them.
  std::string Words() const;
};

/// Effects with a refit come before the others; its drop, evidence and values
/// replace those of the test.
ScoreTest TestScores(const CalibrationProblem& problem,
                     const Identifiability& found,
                     const WideLinearization& wide,
                     const std::vector<Refit>& refits = {});

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_SCORE_TEST_H_
