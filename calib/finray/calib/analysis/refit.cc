#include "finray/calib/analysis/refit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "finray/calib/analysis/cross_validation.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/information_spectrum.h"
#include "finray/calib/solve/summed_solve.h"

namespace finray {
namespace {

// A turned stage of 1 deg has shown 0.4 of the evidence of clamps that give,
// and a refit with it explains everything.
constexpr double kRival = 0.2;

double LeastOf(ParameterFamily family) {
  const std::vector<CandidateEffect>& all = AllCandidateEffects();
  const auto effect =
      std::find_if(all.begin(), all.end(), [&](const CandidateEffect& other) {
        return other.family == FrontFamilyOf(family);
      });
  return effect == all.end() ? -INFINITY : effect->least;
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
    const double value = p.Value(*p.variable);
    if (!std::isfinite(value) ||
        value + 3 * p.ValueStd(*p.variable, std) < LeastOf(p.family)) {
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
  ContactStore contacts(with.problem);
  contacts.Set(from.solution.contacts);
  try {
    SummedSolution solved =
        SolveSummed(from.solution.at.frames, {}, with.problem, &contacts);
    if (!solved.report.converged) {
      *why_not = "the solver stopped early: " + solved.report.message;
      return {};
    }
    with.solution.solve = solved.report;
    with.solution.at = std::move(solved.at);
    with.solution.contacts = contacts.all();
    const std::string impossible = ImpossibleValue(with);
    if (!impossible.empty() && ImpossibleValue(from).empty()) {
      *why_not = "it ends at an impossible value of " + impossible;
      return {};
    }
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

}  // namespace finray
