#include "finray/calib/analysis/refit.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "finray/calib/analysis/cross_validation.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/information_spectrum.h"
#include "finray/calib/solve/modelled_readings.h"
#include "finray/calib/solve/outliers.h"
#include "finray/calib/solve/summed_solve.h"

namespace finray {
namespace {

// A turned stage of 1 deg has shown 0.4 of the evidence of clamps that give,
// and a refit with it explains everything.
constexpr double kRival = 0.2;

// A refit fits if at most this share of the frames, or kFewRejected frames,
// stay rejected.
constexpr double kMostRejected = 0.02;
constexpr std::size_t kFewRejected = 3;
// So many significant effects are tried until one explains the residuals.
constexpr std::size_t kMostJudged = 6;

// Says whether all readings are on the branch of the gauges' curves on which
// more bend reads more.
bool IsMonotonic(const CalibrationProblem& problem) {
  const Finger finger = problem.parameters().Apply(problem.finger());
  for (const CalibrationFrame& frame : problem.logs().frames) {
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      const Gauge& gauge = finger.gauges[j];
      const double volts = frame.gauges_V[j];
      if (gauge.IsInRange(volts) && !gauge.IsMeasured(volts)) return false;
    }
  }
  return true;
}

// Says why no finger and no bench has what freeing the effect leads to; empty
// if one may have it.
std::string WhyImpossible(const CandidateEffect& effect,
                          const SolvedProblem& at) {
  if (effect.family == ParameterFamily::kGaugeCurvature &&
      !IsMonotonic(*at.problem)) {
    return "readings lie beyond the turn of a gauge's curve";
  }
  const CalibrationParameters& parameters = at.problem->parameters();
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    const CalibrationParameter& p = parameters.FreeParameter(k);
    if (FrontFamilyOf(p.family) == effect.family &&
        std::abs(*p.variable - p.initial) >
            CandidateEffect::kFarthest * PriorStdOf(p, effect.prior_std)) {
      return p.name + " ends far from any usual value";
    }
  }
  return "";
}

// Solves the frames of another solution from there. Says why it does not get to
// the end; empty if it does.
std::string SolveFrom(const CalibrationSolution& from, SolvedProblem* with) {
  ContactStore contacts(with->problem);
  contacts.Set(from.contacts);
  SummedSolution solved =
      SolveSummed(from.at.frames, {}, with->problem, &contacts);
  if (!solved.report.converged) {
    return "the solver stopped early: " + solved.report.message;
  }
  with->solution.solve = solved.report;
  with->solution.at = std::move(solved.at);
  with->solution.contacts = contacts.all();
  return "";
}

// Says whether the residuals of a solution are noise.
bool Fits(const SolvedProblem& at) {
  const std::size_t rejected = at.problem->rejected().size();
  if (rejected > kFewRejected &&
      static_cast<double>(rejected) >
          kMostRejected *
              static_cast<double>(at.problem->candidates().size())) {
    return false;
  }
  return !TotalChi2::Of(AnalyzeIdentifiability(at.problem, at.solution.at))
              .IsLoud();
}

}  // namespace

std::string ImpossibleValue(const SolvedProblem& at) {
  const CalibrationParameters& parameters = at.problem->parameters();
  const Eigen::VectorXd unit = parameters.Units();
  const Eigen::MatrixXd covariance = BoundedCovariance(
      InUnits(SumsWithPriors(at.solution.at, parameters).information, unit));
  for (Eigen::Index k = 0; k < unit.size(); ++k) {
    const CalibrationParameter& p =
        parameters.FreeParameter(static_cast<std::size_t>(k));
    const double std = unit[k] * std::sqrt(covariance(k, k));
    if (!std::isfinite(p.Value(*p.variable)) || ImpossibleBound(p, std)) {
      return p.name;
    }
  }
  return "";
}

double SolvedProblem::Cost() const {
  return SumsWithPriors(solution.at, problem->parameters()).cost;
}

std::optional<SolvedProblem> SolveWith(const CandidateEffect& effect,
                                       const SolvedProblem& from,
                                       std::string* why_not) {
  SolvedProblem with;
  with.owned = from.problem->WithPlan(Freed(from.problem->plan(), effect));
  with.problem = with.owned.get();
  try {
    *why_not = SolveFrom(from.solution, &with);
    if (!why_not->empty()) return {};
    const std::string impossible = ImpossibleValue(with);
    if (!impossible.empty() && ImpossibleValue(from).empty()) {
      *why_not = "it ends at an impossible value of " + impossible;
      return {};
    }
    *why_not = WhyImpossible(effect, with);
    if (!why_not->empty()) return {};
    with.log_likelihood = CrossValidatedLogLikelihood(
        *with.problem, LinearizeFolds(*with.problem, with.solution));
  } catch (const std::runtime_error& error) {
    *why_not = error.what();
    return {};
  }
  return with;
}

std::vector<Refit> RefitRivals(const SolvedProblem& from,
                               const ScoreTest& score) {
  std::vector<const ScoreTest::Effect*> rivals;
  for (const ScoreTest::Effect& effect : score.effects) {
    if (!effect.significant || rivals.size() == kMostRivals ||
        effect.evidence < kRival * score.effects[0].evidence) {
      break;
    }
    if (effect.CanBeFreed()) rivals.push_back(&effect);
  }
  std::vector<Refit> refits;
  if (rivals.size() < 2) return refits;
  for (const ScoreTest::Effect* rival : rivals) {
    std::string why_not;
    const auto with = SolveWith(rival->Candidate(), from, &why_not);
    if (!with) continue;
    Refit refit{rival->family,
                2 * (from.Cost() - with->Cost()),
                2 * (with->log_likelihood - from.log_likelihood),
                {}};
    const CalibrationParameters& parameters = with->problem->parameters();
    for (std::size_t k = 0; k < parameters.free().size(); ++k) {
      const CalibrationParameter& p = parameters.FreeParameter(k);
      refit.values[p.name] = p.Value(*p.variable);
    }
    refits.push_back(std::move(refit));
  }
  return refits;
}

std::string JudgeAgain(SolvedProblem* at) {
  const auto rejected = at->problem->rejected();
  const Eigen::VectorXd values = at->problem->Values();
  ContactStore contacts(at->problem);
  contacts.Set(at->solution.contacts);
  SummedSolution solved;
  std::string why_not;
  try {
    const Outliers outliers =
        FindOutliers(at->solution.at, at->problem, &contacts);
    at->problem->SetRejected(outliers.reasons);
    for (const auto& [frame, reason] : at->problem->rejected()) {
      contacts.Forget(frame);
    }
    KeepHistory(at->solution.at, at->problem);
    at->problem->KeepFriction();
    solved =
        SolveSummed(at->problem->FittedFrames(), {}, at->problem, &contacts);
    if (!solved.report.converged) {
      why_not = "the solver stopped early: " + solved.report.message;
    }
  } catch (const std::runtime_error& error) {
    why_not = error.what();
  }
  if (!why_not.empty()) {
    at->problem->SetRejected(rejected);
    at->problem->SetValues(values);
    return why_not;
  }
  at->solution.solve = solved.report;
  at->solution.at = std::move(solved.at);
  at->solution.contacts = contacts.all();
  return "";
}

bool FitsWithNoise(const CalibrationProblem& problem,
                   const CalibrationSolution& solution,
                   const std::vector<double>& noise_V) {
  Finger finger = problem.finger();
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    finger.gauges[j].noise_V = noise_V[j];
  }
  Plan plan = problem.plan();
  plan.gauge_std_V.reset();
  SolvedProblem with;
  try {
    with.owned = std::make_unique<CalibrationProblem>(
        finger, plan, problem.logs(), problem.discretization(),
        problem.threads());
    with.problem = with.owned.get();
    with.problem->SetRejected(problem.rejected());
    with.problem->SetValues(problem.Values());
    with.problem->KeepFriction();
    if (!SolveFrom(solution, &with).empty()) return false;
    JudgeAgain(&with);
    return Fits(with);
  } catch (const std::runtime_error&) {
    return false;
  }
}

void JudgeEffects(const SolvedProblem& from, ScoreTest* score) {
  // Returns what freeing it leads to, if that explains the residuals. One that
  // no plan frees is judged by what the score test expects.
  const auto explains = [&](const ScoreTest::Effect& effect,
                            const SolvedProblem& start,
                            std::optional<SolvedProblem>* with) {
    if (!effect.CanBeFreed()) {
      TotalChi2 rest = TotalChi2::Of(
          AnalyzeIdentifiability(start.problem, start.solution.at));
      rest.chi2 -= effect.drop;
      return !rest.IsLoud();
    }
    std::string why_not;
    *with = SolveWith(effect.Candidate(), start, &why_not);
    if (!*with) return false;
    JudgeAgain(&**with);
    return Fits(**with);
  };
  std::vector<ScoreTest::Effect>& effects = score->effects;
  const auto is_alike = [&](const ScoreTest::Effect& effect) {
    return std::any_of(
        score->alike.begin(), score->alike.end(),
        [&](const auto& alike) { return alike.family == effect.family; });
  };
  std::optional<SolvedProblem> with_best, with;
  std::vector<ScoreTest::Effect> named;
  for (std::size_t i = 0; i < effects.size() && i < kMostJudged; ++i) {
    if (!effects[i].significant) break;
    if (!named.empty() && !is_alike(effects[i])) continue;
    if (explains(effects[i], from, &with)) named.push_back(effects[i]);
    if (i == 0) with_best = std::move(with);
  }
  if (named.empty()) {
    // Two that go together.
    score->alike.clear();
    score->explained =
        score->next && with_best && explains(*score->next, *with_best, &with);
    return;
  }
  const auto first = std::find_if(
      effects.begin(), effects.end(),
      [&](const auto& effect) { return effect.family == named[0].family; });
  if (first != effects.begin()) score->next.reset();
  score->explained = true;
  std::rotate(effects.begin(), first, first + 1);
  score->alike.assign(named.begin() + 1, named.end());
}

}  // namespace finray
