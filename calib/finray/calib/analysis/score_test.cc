#include "finray/calib/analysis/score_test.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_set>
#include <utility>

#include "finray/calib/analysis/residual_correlation.h"
#include "finray/calib/solve/information_spectrum.h"
#include "finray/estimation/chi_squared.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

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

// A parameter in some stretches of the logs, and its usual std as the unit.
struct Column {
  Eigen::Index parameter;
  int first, end;
  double unit;
  std::string name;
  // Neighbouring rows that tell as much as one (IntegratedTime).
  double tau = 1;
};

// Columns that are tested together: a family or one of it.
struct Candidates {
  CandidateEffect effect;
  std::vector<int> columns;
  ScoreTest::Where where = ScoreTest::Where::kEverywhere;
  std::string rows = {};
};

// The rank of an effect. A significant one is above all that chance explains.
std::pair<bool, double> RankOf(const ScoreTest::Effect& effect) {
  return {effect.significant, effect.evidence};
}

std::string WithoutLog(const std::string& name) {
  return name.substr(0, name.find('['));
}

class ScoreRanking {
 public:
  ScoreRanking(const CalibrationProblem& problem, const Identifiability& found,
               const WideLinearization& wide, const std::vector<Refit>& refits)
      : wide_(wide), refits_(refits), total_(TotalChi2::Of(found)) {
    FindScores(problem);
    FindTests();
    for (const Candidates& test : tests_) ++tests_of_group_[GroupOf(test)];
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
        static_cast<std::size_t>(columns_[column].parameter));
  }
  const std::string& LogName(int log) const {
    return wide_.problem->logs().names[log];
  }

  void FindColumns() {
    for (const Eigen::Index k : wide_.candidates) {
      columns_.push_back({k, 0, static_cast<int>(wide_.stretches.size()),
                          unit_[k], WideParameter(k).name});
    }
    everywhere_ = columns_.size();
    for (Eigen::Index k = 0; k < unit_.size(); ++k) FindColumnsOf(k);
  }
  const CalibrationParameter& WideParameter(Eigen::Index k) const {
    return wide_.problem->parameters().FreeParameter(
        static_cast<std::size_t>(k));
  }

  // Appends those of a parameter that may differ by log and by stretch.
  void FindColumnsOf(Eigen::Index k) {
    const CalibrationParameter& p = WideParameter(k);
    const CandidateEffect& effect = CandidateOf(p.family);
    if (!effect.differs) return;
    const double unit = PriorStdOf(p, effect.prior_std);
    const auto told = [&](int first, int end) {
      double sum = 0;
      for (int s = first; s < end; ++s) sum += information_[s](k, k);
      return sum * unit * unit > kTold;
    };
    const auto logs = static_cast<int>(wide_.problem->logs().paths.size());
    const auto of_log = static_cast<int>(wide_.stretches.size()) / logs;
    std::vector<int> in;
    for (int log = 0; log < logs; ++log) {
      if (told(log * of_log, (log + 1) * of_log)) in.push_back(log);
    }
    const std::string name = WithoutLog(p.name);
    for (const int log : in) {
      const int first = log * of_log, end = first + of_log;
      if (in.size() > 1) {
        columns_.push_back(
            {k, first, end, unit, name + "[" + LogName(log) + "]"});
      }
      for (int s = first + 1; s < end; ++s) {
        if (!told(first, s) || !told(s, end)) continue;
        columns_.push_back({k, s, end, unit,
                            name + "[" + LogName(log) + " from row " +
                                std::to_string(FirstRow(s)) + "]",
                            RowsAlike(k, first, s, end)});
      }
    }
  }
  // Where residuals go up and down slowly, any stretch of rows is off by more
  // than white noise makes. Returns tau of the pulls of a parameter about their
  // means before and from stretch `from` on, or 1 if these pulls are white.
  double RowsAlike(Eigen::Index k, int first, int from, int end) const {
    std::vector<std::vector<double>> parts(2);
    for (const PulledFrame& one : pulled_) {
      const int stretch = wide_.stretch_of[one.frame];
      if (stretch < first || stretch >= end) continue;
      parts[stretch >= from ? 1 : 0].push_back(
          wide_.folds[one.fold].pulls(k, one.column));
    }
    for (std::vector<double>& part : parts) {
      double mean = 0;
      for (const double pull : part) mean += pull;
      mean /= std::max<double>(1, static_cast<double>(part.size()));
      for (double& pull : part) pull -= mean;
    }
    const IntegratedTime time = IntegrateTime(parts);
    return time.p_value < ResidualCorrelation::kSignificant ? time.tau : 1;
  }

  // Returns the first row of a stretch; rows count from 1.
  int FirstRow(int stretch) const {
    return wide_.stretches[stretch].first_row + 1;
  }

  // Sums what the frames of each stretch say.
  void SumStretches() {
    const std::size_t count = wide_.stretches.size();
    const auto all = wide_.folds[0].gradient.size();
    gradient_.assign(count, Eigen::VectorXd::Zero(all));
    information_.assign(count, Eigen::MatrixXd::Zero(all, all));
    for (std::size_t i = 0; i < wide_.folds.size(); ++i) {
      const Linearization& fold = wide_.folds[i];
      for (std::size_t k = 0; k < fold.frames.size(); ++k) {
        const auto column = static_cast<Eigen::Index>(k);
        pulled_.push_back({fold.frames[k], i, column});
        gradient_[wide_.stretch_of[fold.frames[k]]] +=
            fold.pulls.col(column).cast<double>();
      }
      for (const auto& [stretch, of_stretch] : fold.information) {
        information_[stretch] += fold.InformationOfGroup(stretch);
      }
    }
    std::sort(pulled_.begin(), pulled_.end(),
              [](const PulledFrame& a, const PulledFrame& b) {
                return a.frame < b.frame;
              });
  }

  void FindScores(const CalibrationProblem& problem) {
    unit_ = wide_.problem->parameters().Units();
    SumStretches();
    FindColumns();
    const auto& f = wide_.free;
    const auto n = static_cast<Eigen::Index>(columns_.size());
    const auto all = unit_.size();
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(all);
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(all, all);
    // Scores and information of the columns, and the information between them
    // and all parameters.
    Eigen::VectorXd s = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd across = Eigen::MatrixXd::Zero(all, n);
    for (std::size_t stretch = 0; stretch < information_.size(); ++stretch) {
      std::vector<Eigen::Index> active, parameters;
      for (Eigen::Index c = 0; c < n; ++c) {
        const Column& column = columns_[c];
        const auto at = static_cast<int>(stretch);
        if (at < column.first || at >= column.end) continue;
        active.push_back(c);
        parameters.push_back(column.parameter);
      }
      information += information_[stretch];
      s(active) += gradient_[stretch](parameters);
      a(active, active) += information_[stretch](parameters, parameters);
      across(Eigen::all, active) +=
          information_[stretch](Eigen::all, parameters);
    }
    for (const Linearization& fold : wide_.folds) gradient += fold.gradient;
    // Sums of single precision are exact enough for the other ones.
    for (std::size_t c = 0; c < everywhere_; ++c) {
      s[static_cast<Eigen::Index>(c)] = gradient[columns_[c].parameter];
    }
    Eigen::VectorXd unit(n);
    for (Eigen::Index c = 0; c < n; ++c) unit[c] = columns_[c].unit;
    gradient = gradient.cwiseProduct(unit_);
    information = InUnits(information, unit_);
    const CalibrationParameters& parameters = problem.parameters();
    for (std::size_t k = 0; k < f.size(); ++k) {
      const CalibrationParameter& p = parameters.FreeParameter(k);
      if (!p.prior_std) continue;
      const Eigen::Index i = f[k];
      gradient[i] += p.PriorResidual();
      information(i, i) += 1;
    }
    const Eigen::MatrixXd covariance =
        BoundedCovariance(Eigen::MatrixXd(information(f, f)));
    const Eigen::MatrixXd of_free = unit_(f).asDiagonal() *
                                    Eigen::MatrixXd(across(f, Eigen::all)) *
                                    unit.asDiagonal();
    const Eigen::MatrixXd followed = covariance * of_free;
    scores_.s = s.cwiseProduct(unit) - followed.transpose() * gradient(f);
    scores_.a = InUnits(a, unit) - of_free.transpose() * followed;
    gradient_.clear();
    information_.clear();
  }

  // Appends a test of these columns together, and of each alone.
  void AddTests(const Candidates& all, bool each) {
    if (all.columns.empty()) return;
    tests_.push_back(all);
    for (const int column : all.columns) {
      if (!each || all.columns.size() < 2) break;
      tests_.push_back({all.effect, {column}, all.where, all.rows});
    }
  }

  void FindTests() {
    using Where = ScoreTest::Where;
    const auto logs = static_cast<int>(wide_.problem->logs().paths.size());
    const auto of_log = static_cast<int>(wide_.stretches.size()) / logs;
    const auto count = static_cast<int>(columns_.size());
    const auto everywhere = static_cast<int>(everywhere_);
    for (const CandidateEffect& effect : AllCandidateEffects()) {
      // Returns the columns of the family from `first` on that `is` takes.
      const auto chosen = [&](int first, int end, const auto& is) {
        std::vector<int> columns;
        for (int c = first; c < end; ++c) {
          if (FrontFamilyOf(Parameter(c).family) == effect.family &&
              is(columns_[c])) {
            columns.push_back(c);
          }
        }
        return columns;
      };
      AddTests({effect, chosen(0, everywhere, [](auto&) { return true; })},
               true);
      if (!effect.differs) continue;
      const auto of_whole_log = [&](const Column& column, int log) {
        return column.first == log * of_log && column.end == (log + 1) * of_log;
      };
      if (logs > 1) {
        AddTests({effect,
                  chosen(everywhere, count,
                         [&](const Column& column) {
                           return of_whole_log(column, column.first / of_log);
                         }),
                  Where::kByLog, ", not the same in all logs"},
                 false);
      }
      for (int log = 0; log < logs; ++log) {
        if (logs > 1) {
          AddTests({effect,
                    chosen(everywhere, count,
                           [&](const Column& column) {
                             return of_whole_log(column, log);
                           }),
                    Where::kByLog, " in " + LogName(log)},
                   false);
        }
        for (int s = log * of_log + 1; s < (log + 1) * of_log; ++s) {
          AddTests({effect,
                    chosen(everywhere, count,
                           [&](const Column& c) { return c.first == s; }),
                    Where::kFrom,
                    " from " + LogName(log) + " row " +
                        std::to_string(FirstRow(s)) + " on"},
                   true);
        }
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
      ScoreTest::Effect effect =
          Evaluate(WithPossible(test, scores), scores, dropped);
      if (effect.values.empty()) continue;
      if (best.empty() || best.back().family != effect.family) {
        best.push_back(std::move(effect));
      } else if (RankOf(effect) > RankOf(best.back())) {
        best.back() = std::move(effect);
      }
    }
    std::stable_sort(
        best.begin(), best.end(),
        [](const auto& a, const auto& b) { return RankOf(a) > RankOf(b); });
    return best;
  }

  // Puts effects with a refit first. One that no plan frees has none: it comes
  // before them if it explains more than they were promised and have shown to.
  void SetRefits(std::vector<ScoreTest::Effect>* effects) const {
    if (refits_.empty()) return;
    double promised = 0, shown = 0;
    for (const Refit& refit : refits_) {
      shown = std::max(shown, refit.drop);
      for (const ScoreTest::Effect& effect : *effects) {
        if (effect.family != refit.family || !effect.CanBeFreed()) continue;
        promised = std::max(promised, effect.evidence);
      }
    }
    for (const Refit& refit : refits_) {
      for (ScoreTest::Effect& effect : *effects) {
        if (effect.family != refit.family || !effect.CanBeFreed()) continue;
        effect.drop = refit.drop;
        effect.evidence = refit.evidence;
        for (ScoreTest::Value& value : effect.values) {
          const auto at = refit.values.find(value.name);
          if (at == refit.values.end()) continue;
          value.change += at->second - value.value;
          value.value = at->second;
        }
        effect.words = WordsOf(CandidateOf(effect.family), effect);
      }
    }
    const auto rank = [&](const ScoreTest::Effect& effect) {
      if (!effect.CanBeFreed()) {
        return effect.significant && effect.evidence > promised &&
                       effect.drop > shown
                   ? 2
                   : 0;
      }
      return std::any_of(refits_.begin(), refits_.end(),
                         [&](const Refit& refit) {
                           return refit.family == effect.family;
                         })
                 ? 1
                 : 0;
    };
    std::stable_sort(
        effects->begin(), effects->end(), [&](const auto& a, const auto& b) {
          return std::pair(rank(a), RankOf(a)) > std::pair(rank(b), RankOf(b));
        });
  }

  // Returns the test without parameters whose values would be impossible.
  Candidates WithPossible(Candidates test, const Scores& scores) const {
    const bool bounded =
        std::isfinite(test.effect.least) || std::isfinite(test.effect.most);
    while (bounded && !test.columns.empty()) {
      const Eigen::VectorXd s = scores.s(test.columns);
      Eigen::MatrixXd information = scores.a(test.columns, test.columns);
      information.diagonal().array() += 1;
      const Eigen::VectorXd e = -information.llt().solve(s);
      Eigen::Index farthest = -1;
      for (Eigen::Index i = 0; i < e.size(); ++i) {
        const int c = test.columns[i];
        const CalibrationParameter& p = Parameter(c);
        const double was = p.Value(*p.variable);
        const double value = p.Value(*p.variable + columns_[c].unit * e[i]);
        if (value >= std::min(test.effect.least, was) &&
            value <= std::max(test.effect.most, was)) {
          continue;
        }
        if (farthest < 0 || std::abs(e[i]) > std::abs(e[farthest])) {
          farthest = i;
        }
      }
      if (farthest < 0) break;
      test.columns.erase(test.columns.begin() + farthest);
    }
    return test;
  }

  // The tests of a family in all rows are one group, those in some rows
  // another.
  static std::pair<ParameterFamily, bool> GroupOf(const Candidates& test) {
    return {test.effect.family, test.where == ScoreTest::Where::kEverywhere};
  }
  // Returns Bonferroni's factor of a p-value. Groups share the error rate
  // equally, and the tests of a group share its part: a family of one parameter
  // is not charged for the many stretches and members of others.
  double BonferroniFactor(const Candidates& test) const {
    return static_cast<double>(tests_of_group_.size()) *
           tests_of_group_.at(GroupOf(test));
  }

  ScoreTest::Effect Evaluate(const Candidates& test, const Scores& scores,
                             double dropped) const {
    const std::vector<int>& columns = test.columns;
    const auto k = static_cast<Eigen::Index>(columns.size());
    ScoreTest::Effect effect;
    effect.family = test.effect.family;
    if (k == 0) return effect;
    const Eigen::VectorXd s = scores.s(columns);
    const Eigen::MatrixXd a = scores.a(columns, columns);
    const Eigen::MatrixXd information = a + Eigen::MatrixXd::Identity(k, k);
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    const Eigen::MatrixXd covariance =
        factor.solve(Eigen::MatrixXd::Identity(k, k));
    const Eigen::VectorXd e = -(covariance * s);
    effect.where = test.where;
    effect.rows = test.rows;
    effect.drop = std::max(0.0, -s.dot(e));
    const double rest = total_.chi2 - dropped - effect.drop;
    double tau = 1;
    for (const int column : columns) {
      tau = std::max(tau, columns_[column].tau);
    }
    const double scale2 =
        tau * (total_.dof > 0 ? std::max(1.0, rest / total_.dof) : 1.0);
    const Eigen::MatrixXd l = factor.matrixL();
    effect.evidence =
        effect.drop / scale2 - 2 * l.diagonal().array().log().sum();
    const auto told = static_cast<int>((a.diagonal().array() > kTold).count());
    effect.p_value =
        told > 0 ? ChiSquaredTail(effect.drop / scale2, told) : 1.0;
    effect.significant =
        effect.evidence > 0 &&
        effect.p_value * BonferroniFactor(test) < ScoreTest::kSignificant;
    for (Eigen::Index i = 0; i < k; ++i) {
      const CalibrationParameter& p = Parameter(columns[i]);
      const double unit = columns_[columns[i]].unit;
      const double at = *p.variable + unit * e[i];
      const double std = unit * std::sqrt(scale2 * covariance(i, i));
      effect.values.push_back(
          {columns_[columns[i]].name, p.unit, p.Value(at), p.ValueStd(at, std),
           p.Value(at) - p.Value(*p.variable), p.Value(*p.variable) == 0});
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
    std::string words = candidate.words + effect.rows + ", " + value.name;
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
    for (int i = 0; i < static_cast<int>(columns_.size()); ++i) {
      if (names.count(columns_[i].name) > 0) columns.push_back(i);
    }
    return columns;
  }

  const WideLinearization& wide_;
  const std::vector<Refit>& refits_;
  TotalChi2 total_;
  Eigen::VectorXd unit_;
  // The frames of all folds in their order, and where their pulls are.
  struct PulledFrame {
    int frame;
    std::size_t fold;
    Eigen::Index column;
  };
  std::vector<PulledFrame> pulled_;
  // By stretch, while the scores are found.
  std::vector<Eigen::VectorXd> gradient_;
  std::vector<Eigen::MatrixXd> information_;
  // First those of the candidates in all stretches.
  std::vector<Column> columns_;
  std::size_t everywhere_ = 0;
  Scores scores_;
  std::vector<Candidates> tests_;
  std::map<std::pair<ParameterFamily, bool>, int> tests_of_group_;
};

}  // namespace

bool ScoreTest::Effect::CanBeFreed() const {
  return where == Where::kEverywhere ||
         (where == Where::kByLog && CanDifferByLog(family));
}

CandidateEffect ScoreTest::Effect::Candidate() const {
  CandidateEffect candidate = CandidateOf(family);
  candidate.per_log = where == Where::kByLog;
  return candidate;
}

const ScoreTest::Effect* ScoreTest::Best() const {
  return effects.empty() || !effects[0].significant ? nullptr : &effects[0];
}

bool ScoreTest::FoundNone() const {
  return !effects.empty() && (Best() == nullptr || explained == false);
}

std::string ScoreTest::Words() const {
  const Effect* best = Best();
  if (best == nullptr || !explained.value_or(false)) return "";
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
