#include "finray/calib/analysis/score_test.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_set>
#include <utility>

#include "finray/calib/solve/frame_pass.h"
#include "finray/calib/solve/information_spectrum.h"
#include "finray/io/number_text.h"
#include "finray/sensing/chi_squared.h"

namespace finray {
namespace {

// Neighbouring rows share what drifts, so folds are made of blocks of them.
constexpr std::size_t kMostBlockRows = 10;
// A candidate of which the data say less than this, in units of its usual std,
// is none of its family's degrees of freedom.
constexpr double kTold = 1e-3;
// Effects are alike if their evidence is as near as that of a 20-fold Bayes
// factor, or as derivatives at one point can tell.
constexpr double kNear = 6, kNearShare = 0.1;
// Of the drop of an effect so much is left at most if another one explains it.
constexpr double kExplained = 0.5;

// What the frames say about the candidates once everything free has followed,
// without and with the candidates' priors: -s and A = a'P a, in units of their
// usual std.
struct Scores {
  Eigen::VectorXd s;
  Eigen::MatrixXd a;

  // Lets some candidates follow too.
  Scores Given(const std::vector<int>& freed) const {
    Eigen::MatrixXd own = a(freed, freed);
    own.diagonal().array() += 1;
    const Eigen::LDLT<Eigen::MatrixXd> factor(own);
    const Eigen::MatrixXd across = a(freed, Eigen::all);
    return {s - across.transpose() * factor.solve(Eigen::VectorXd(s(freed))),
            a - across.transpose() * factor.solve(across)};
  }
};

// A set of candidates that are tested together: a family or one of it.
struct Candidates {
  CandidateEffect effect;
  std::vector<int> columns;
};

class ScoreRanking {
 public:
  ScoreRanking(const CalibrationProblem& problem, const Identifiability& found,
               const WideLinearization& wide, const std::vector<Refit>& refits)
      : wide_(wide), refits_(refits) {
    for (const Identifiability::Noise& noise : found.noise) {
      if (noise.residuals == 0) continue;
      chi2_ += noise.chi2;
      dof_ += std::max(0.0, noise.dof);
    }
    FindScores(problem);
    FindTests();
  }

  ScoreTest Rank() const {
    ScoreTest result;
    if (tests_.empty()) return result;
    result.effects = BestOfEach(scores_, 0, {});
    SetRefits(&result.effects);
    if (result.effects.empty() || !result.effects[0].significant) return result;
    const ScoreTest::Effect& best = result.effects[0];
    const std::vector<int> freed = ColumnsOf(best);
    const Scores rest = scores_.Given(freed);
    std::set<ParameterFamily> named = {best.family};
    const std::vector<ScoreTest::Effect> left =
        BestOfEach(rest, best.drop, named);
    for (const ScoreTest::Effect& other : result.effects) {
      if (other.family == best.family || !other.significant) continue;
      if (other.evidence <
          best.evidence - std::max(kNear, kNearShare * best.evidence)) {
        continue;
      }
      const auto after = std::find_if(left.begin(), left.end(),
                                      [&](const ScoreTest::Effect& effect) {
                                        return effect.family == other.family;
                                      });
      if (after != left.end() && after->drop > kExplained * other.drop) {
        continue;
      }
      result.alike.push_back(other);
      named.insert(other.family);
    }
    for (const ScoreTest::Effect& other : left) {
      if (named.count(other.family) == 0 && other.significant) {
        result.next = other;
        break;
      }
    }
    return result;
  }

 private:
  const CalibrationParameter& Parameter(int column) const {
    return wide_.problem->parameters().FreeParameter(
        static_cast<std::size_t>(wide_.candidates[column]));
  }

  void FindScores(const CalibrationProblem& problem) {
    const auto all = wide_.folds[0].gradient.size();
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(all);
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(all, all);
    for (const Linearization& fold : wide_.folds) {
      gradient += fold.gradient;
      information += fold.Information();
    }
    unit_ = wide_.problem->parameters().Units();
    gradient = gradient.cwiseProduct(unit_);
    information = InUnits(information, unit_);
    const CalibrationParameters& parameters = problem.parameters();
    for (std::size_t k = 0; k < wide_.free.size(); ++k) {
      const CalibrationParameter& p = parameters.FreeParameter(k);
      if (!p.prior_std) continue;
      const Eigen::Index i = wide_.free[k];
      gradient[i] += p.PriorResidual();
      information(i, i) += 1;
    }
    const auto& f = wide_.free;
    const auto& c = wide_.candidates;
    const Eigen::MatrixXd covariance =
        BoundedCovariance(Eigen::MatrixXd(information(f, f)));
    const Eigen::MatrixXd across = covariance * information(f, c);
    scores_.s = gradient(c) - across.transpose() * gradient(f);
    scores_.a = information(c, c) - Eigen::MatrixXd(information(c, f)) * across;
  }

  void FindTests() {
    std::vector<Candidates> families;
    for (int column = 0; column < static_cast<int>(wide_.candidates.size());
         ++column) {
      const CandidateEffect& effect = CandidateOf(Parameter(column).family);
      if (families.empty() || families.back().effect.family != effect.family) {
        families.push_back({effect, {}});
      }
      families.back().columns.push_back(column);
    }
    for (const Candidates& family : families) {
      tests_.push_back(family);
      if (family.columns.size() < 2) continue;
      for (const int column : family.columns) {
        tests_.push_back({family.effect, {column}});
      }
    }
  }

  // Returns the best test of each family but some, the best family first.
  std::vector<ScoreTest::Effect> BestOfEach(
      const Scores& scores, double dropped,
      const std::set<ParameterFamily>& but) const {
    std::vector<ScoreTest::Effect> best;
    for (const Candidates& test : tests_) {
      if (but.count(test.effect.family) > 0) continue;
      ScoreTest::Effect effect = Evaluate(test, scores, dropped);
      if (best.empty() || best.back().family != effect.family) {
        best.push_back(std::move(effect));
      } else if (effect.evidence > best.back().evidence) {
        best.back() = std::move(effect);
      }
    }
    std::stable_sort(
        best.begin(), best.end(),
        [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
    return best;
  }

  // Puts effects with a refit first.
  void SetRefits(std::vector<ScoreTest::Effect>* effects) const {
    for (const Refit& refit : refits_) {
      for (ScoreTest::Effect& effect : *effects) {
        if (effect.family != refit.family) continue;
        effect.drop = refit.drop;
        effect.evidence = refit.evidence;
        for (ScoreTest::Value& value : effect.values) {
          const double at = refit.values.at(value.name);
          value.change += at - value.value;
          value.value = at;
        }
        effect.words = WordsOf(CandidateOf(effect.family), effect);
      }
    }
    const auto refitted = [&](const ScoreTest::Effect& effect) {
      return std::any_of(
          refits_.begin(), refits_.end(),
          [&](const Refit& refit) { return refit.family == effect.family; });
    };
    std::stable_sort(effects->begin(), effects->end(),
                     [&](const auto& a, const auto& b) {
                       return std::pair(refitted(a), a.evidence) >
                              std::pair(refitted(b), b.evidence);
                     });
  }

  ScoreTest::Effect Evaluate(const Candidates& test, const Scores& scores,
                             double dropped) const {
    const std::vector<int>& columns = test.columns;
    const auto k = static_cast<Eigen::Index>(columns.size());
    const Eigen::VectorXd s = scores.s(columns);
    const Eigen::MatrixXd a = scores.a(columns, columns);
    const Eigen::MatrixXd information = a + Eigen::MatrixXd::Identity(k, k);
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    const Eigen::MatrixXd covariance =
        factor.solve(Eigen::MatrixXd::Identity(k, k));
    const Eigen::VectorXd e = -(covariance * s);
    ScoreTest::Effect effect;
    effect.family = test.effect.family;
    effect.drop = std::max(0.0, -s.dot(e));
    const double rest = chi2_ - dropped - effect.drop;
    const double scale2 = dof_ > 0 ? std::max(1.0, rest / dof_) : 1.0;
    const Eigen::MatrixXd l = factor.matrixL();
    effect.evidence =
        effect.drop / scale2 - 2 * l.diagonal().array().log().sum();
    const auto told = static_cast<int>((a.diagonal().array() > kTold).count());
    effect.p_value =
        told > 0 ? ChiSquaredTail(effect.drop / scale2, told) : 1.0;
    effect.significant = effect.evidence > 0 &&
                         effect.p_value * static_cast<double>(tests_.size()) <
                             ScoreTest::kSignificant;
    for (Eigen::Index i = 0; i < k; ++i) {
      const CalibrationParameter& p = Parameter(columns[i]);
      const double unit = unit_[wide_.candidates[columns[i]]];
      const double at = *p.variable + unit * e[i];
      const double std = unit * std::sqrt(scale2 * covariance(i, i));
      effect.values.push_back({p.name, p.unit, p.Value(at), p.ValueStd(at, std),
                               p.Value(at) - p.Value(*p.variable),
                               p.Value(*p.variable) == 0});
    }
    std::stable_sort(effect.values.begin(), effect.values.end(),
                     [](const auto& x, const auto& y) {
                       return std::abs(x.change / x.std) >
                              std::abs(y.change / y.std);
                     });
    effect.words = WordsOf(test.effect, effect);
    return effect;
  }

  static std::string WordsOf(const CandidateEffect& candidate,
                             const ScoreTest::Effect& effect) {
    const ScoreTest::Value& value = effect.values[0];
    std::string words = candidate.words;
    words += ", " + value.name;
    words += value.from_zero
                 ? FormatText(" %.3g", value.value)
                 : FormatText(" %.4g, by %+.2g", value.value, value.change);
    words += FormatText(" +- %.1g", value.std);
    if (value.unit != "1") words += " " + value.unit;
    if (effect.values.size() > 1) {
      words += " and " + std::to_string(effect.values.size() - 1) + " more";
    }
    return words + FormatText(" (chi2 %.0f)", -effect.drop);
  }

  std::vector<int> ColumnsOf(const ScoreTest::Effect& effect) const {
    std::unordered_set<std::string> names;
    for (const ScoreTest::Value& value : effect.values) {
      names.insert(value.name);
    }
    std::vector<int> columns;
    for (int i = 0; i < static_cast<int>(wide_.candidates.size()); ++i) {
      if (names.count(Parameter(i).name) > 0) columns.push_back(i);
    }
    return columns;
  }

  const WideLinearization& wide_;
  const std::vector<Refit>& refits_;
  double chi2_ = 0, dof_ = 0;
  Eigen::VectorXd unit_;
  Scores scores_;
  std::vector<Candidates> tests_;
};

// The derivatives of readings, from the residuals of a frame.
Eigen::MatrixXd ReadingsBy(const std::vector<Eigen::Index>& columns,
                           std::size_t gauges, const LinearizedFrame& at) {
  Eigen::MatrixXd readings_V =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(gauges),
                            static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    if (at.rows[i].family != ResidualFamily::kGauge) continue;
    const auto row = static_cast<Eigen::Index>(i);
    readings_V.row(at.rows[i].gauge) =
        at.rows[i].std_V / at.weights[row] * at.by_parameter(row, columns);
  }
  return readings_V;
}

// Linearises the frames of a solution with more parameters free, those of
// `plan`.
WideLinearization LinearizeWith(const Plan& plan,
                                const CalibrationProblem& problem,
                                const CalibrationSolution& solution) {
  WideLinearization wide;
  wide.problem = problem.WithPlan(plan);
  const CalibrationParameters& parameters = wide.problem->parameters();
  std::unordered_set<std::string> free;
  for (const int i : problem.parameters().free()) {
    free.insert(problem.parameters().all()[i].name);
  }
  const auto columns = static_cast<Eigen::Index>(parameters.free().size());
  for (Eigen::Index k = 0; k < columns; ++k) {
    const CalibrationParameter& p =
        parameters.FreeParameter(static_cast<std::size_t>(k));
    (free.count(p.name) > 0 ? wide.free : wide.candidates).push_back(k);
  }
  const std::vector<int>& frames = solution.at.frames;
  wide.frames.resize(WideLinearization::kFolds);
  std::vector<int> fold_of(problem.logs().frames.size(), 0);
  const std::size_t block = std::clamp<std::size_t>(
      frames.size() / (2 * WideLinearization::kFolds), 1, kMostBlockRows);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto fold = (k / block) % WideLinearization::kFolds;
    fold_of[frames[k]] = static_cast<int>(fold);
    wide.frames[fold].push_back(frames[k]);
  }
  for (const std::vector<int>& of_fold : wide.frames) {
    wide.folds.emplace_back(static_cast<int>(columns), of_fold.size());
    std::vector<int>& checked = wide.checked.emplace_back();
    const std::size_t count =
        std::min(of_fold.size(),
                 WideLinearization::kMostChecked / WideLinearization::kFolds);
    for (std::size_t k = 0; k < count; ++k) {
      const int i = of_fold[k * of_fold.size() / count];
      if (problem.frame(i).IsBench()) continue;
      checked.push_back(i);
      wide.readings_V[i];
    }
  }
  ContactStore contacts(wide.problem.get());
  contacts.Set(solution.contacts);
  LinearizeFrames(frames, wide.problem.get(), &contacts,
                  [&](int i, const LinearizedFrame& frame) {
                    wide.folds[fold_of[i]].Add(i, problem.frame(i).log, frame);
                    const auto kept = wide.readings_V.find(i);
                    if (kept == wide.readings_V.end()) return;
                    kept->second = ReadingsBy(
                        wide.free, problem.finger().gauges.size(), frame);
                  });
  for (Linearization& fold : wide.folds) fold.Finish();
  return wide;
}

}  // namespace

WideLinearization LinearizeWide(const CalibrationProblem& problem,
                                const CalibrationSolution& solution) {
  Plan plan = problem.plan();
  for (const CandidateEffect& effect :
       CandidatesFor(problem.finger(), plan, problem.logs())) {
    plan = Freed(plan, effect);
  }
  return LinearizeWith(plan, problem, solution);
}

WideLinearization LinearizeFolds(const CalibrationProblem& problem,
                                 const CalibrationSolution& solution) {
  Plan plan = problem.plan();
  for (const CandidateEffect& effect :
       CandidatesFor(problem.finger(), plan, problem.logs())) {
    if (!plan.ForceZeroIsKnown()) break;
    const Plan freed = Freed(plan, effect);
    if (!freed.ForceZeroIsKnown()) plan = freed;
  }
  return LinearizeWith(plan, problem, solution);
}

const ScoreTest::Effect* ScoreTest::Best() const {
  return effects.empty() || !effects[0].significant ? nullptr : &effects[0];
}

std::string ScoreTest::Words() const {
  const Effect* best = Best();
  if (best == nullptr) return "";
  std::string words = "residuals look like " + best->words;
  for (const Effect& effect : alike) {
    words += ", or as well like " + effect.words;
  }
  if (next) words += "; next: " + next->words;
  return words;
}

ScoreTest TestScores(const CalibrationProblem& problem,
                     const Identifiability& found,
                     const WideLinearization& wide,
                     const std::vector<Refit>& refits) {
  return ScoreRanking(problem, found, wide, refits).Rank();
}

}  // namespace finray
