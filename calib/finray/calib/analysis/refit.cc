#include "finray/calib/analysis/refit.h"

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

// Says whether the values of an effect are possible within 3 std.
bool IsPossible(const CandidateEffect& effect, const Linearization& at,
                const CalibrationParameters& parameters) {
  if (std::isinf(effect.least)) return true;
  const Eigen::VectorXd unit = parameters.Units();
  const Eigen::MatrixXd covariance = BoundedCovariance(
      InUnits(SumsWithPriors(at, parameters).information, unit));
  for (Eigen::Index k = 0; k < unit.size(); ++k) {
    const CalibrationParameter& p =
        parameters.FreeParameter(static_cast<std::size_t>(k));
    if (FrontFamilyOf(p.family) != effect.family) continue;
    const double std = unit[k] * std::sqrt(covariance(k, k));
    const double value = p.Value(*p.variable);
    if (value + 3 * p.ValueStd(*p.variable, std) < effect.least) return false;
  }
  return true;
}

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
    if (!IsPossible(effect, solved.at, with.problem->parameters())) return {};
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
    const auto with = SolveWith(rival->Candidate(), from);
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
