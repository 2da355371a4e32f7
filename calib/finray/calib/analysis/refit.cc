#include "finray/calib/analysis/refit.h"

#include <stdexcept>
#include <utility>

#include "finray/calib/analysis/cross_validation.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/summed_solve.h"

namespace finray {
namespace {

// A turned stage of 1 deg has shown 0.4 of the evidence of clamps that give,
// and a refit with it explains everything.
constexpr double kRival = 0.2;

}  // namespace

double SolvedProblem::Cost() const {
  return SumsWithPriors(solution.at, problem->parameters()).cost;
}

std::optional<SolvedProblem> SolveWith(const CandidateEffect& effect,
                                       const SolvedProblem& from) {
  SolvedProblem with;
  with.owned = from.problem->WithPlan(Freed(from.problem->plan(), effect));
  with.problem = with.owned.get();
  ContactStore contacts(with.problem);
  contacts.Set(from.solution.contacts);
  try {
    SummedSolution solved =
        SolveSummed(from.solution.at.frames, {}, with.problem, &contacts);
    if (!solved.report.converged) return {};
    with.solution.solve = solved.report;
    with.solution.at = std::move(solved.at);
    with.solution.contacts = contacts.all();
    with.log_likelihood = CrossValidatedLogLikelihood(
        *with.problem, LinearizeFolds(*with.problem, with.solution));
  } catch (const std::runtime_error&) {
    return {};
  }
  return with;
}

std::vector<Refit> RefitRivals(const SolvedProblem& from,
                               const ScoreTest& score) {
  std::vector<ParameterFamily> rivals;
  for (const ScoreTest::Effect& effect : score.effects) {
    if (!effect.significant || rivals.size() == kMostRivals ||
        effect.evidence < kRival * score.effects[0].evidence) {
      break;
    }
    rivals.push_back(effect.family);
  }
  std::vector<Refit> refits;
  if (rivals.size() < 2) return refits;
  for (const ParameterFamily family : rivals) {
    const auto with = SolveWith(CandidateOf(family), from);
    if (!with) continue;
    Refit refit{family,
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
