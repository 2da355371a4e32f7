#include "finray/calib/report/doubts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "finray/calib/analysis/candidate_effects.h"
#include "finray/calib/analysis/gate.h"
#include "finray/calib/analysis/gauge_changes.h"
#include "finray/calib/analysis/refit.h"
#include "finray/calib/analysis/unsupported.h"
#include "finray/calib/problem/median.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

void DoubtCoverage(const CalibrationResult& result,
                   std::vector<std::string>* doubts) {
  const bool held_out = result.forces.held_out.force_after_N().judged > 0;
  const ErrorStatistics& forces =
      held_out ? result.forces.held_out.force_after_N()
               : result.cross_validation.errors.contact.force_N;
  if (forces.judged == 0) return;
  const std::pair<double, std::size_t> shares[] = {
      {68.3 - kFewerPercent, forces.within_68},
      {95 - kFewerPercent, forces.within_95}};
  for (const auto& [least, within] : shares) {
    if (BinomialRange(within, forces.judged, kFewer).second >= least) continue;
    doubts->push_back(FormatText(
        "the 68 and 95 %% intervals of force hold in %.0f and %.0f %% of %zu ",
        forces.coverage_68_percent(), forces.coverage_95_percent(),
        forces.judged));
    doubts->back() += held_out ? "held-out frames" : "cross-validated frames";
    return;
  }
}

void DoubtChi2(const Identifiability& found, std::vector<std::string>* doubts) {
  const TotalChi2 total = TotalChi2::Of(found);
  if (!total.IsLoud()) return;
  doubts->push_back(
      FormatText("chi2 is %.0f for %.0f degrees of freedom, %.0f "
                 "std too much",
                 total.chi2, total.dof, total.Excess()));
}

void DoubtQuiet(const Identifiability& found,
                std::vector<std::string>* doubts) {
  for (const ResidualFamily family :
       {ResidualFamily::kGauge, ResidualFamily::kForce}) {
    const Identifiability::Noise& noise = found.noise[static_cast<int>(family)];
    if (!noise.IsTooQuiet()) continue;
    doubts->push_back(QuietInWords(family, noise));
  }
}

void DoubtPriors(const CalibrationParameters& parameters,
                 std::vector<std::string>* doubts) {
  std::string far;
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    const CalibrationParameter& p = parameters.FreeParameter(k);
    if (!p.prior_std) continue;
    const double off = (*p.variable - p.initial) / *p.prior_std;
    if (std::abs(off) <= kFarFromPrior) continue;
    far += (far.empty() ? "" : ", ") + p.name + FormatText(" (%+.2g)", off);
  }
  if (far.empty()) return;
  doubts->push_back("values are far from their priors, in std of these: " +
                    far);
}

void DoubtImpossible(const CalibrationParameters& parameters,
                     const Identifiability& found,
                     std::vector<std::string>* doubts) {
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    const CalibrationParameter& p = parameters.FreeParameter(k);
    const std::optional<double> bound = ImpossibleBound(p, found.std[k]);
    if (!bound) continue;
    const double value = p.Value(*p.variable);
    doubts->push_back(
        p.name +
        FormatText(" is %.3g +- %.1g, and no finger or bench has %s than %.3g",
                   value, p.ValueStd(*p.variable, found.std[k]),
                   value < *bound ? "less" : "more", *bound));
  }
}

// Returns how many std the rank sum of `some` is above that expected if they
// are drawn from the same numbers as `others` (Mann and Whitney).
double RanksApart(const std::vector<double>& some, std::vector<double> others) {
  const auto m = static_cast<double>(some.size());
  const auto n = static_cast<double>(others.size());
  if (some.size() < kLeastRejected || others.empty()) return 0;
  std::sort(others.begin(), others.end());
  double above = 0;
  for (const double x : some) {
    const auto [low, high] = std::equal_range(others.begin(), others.end(), x);
    above +=
        static_cast<double>((low - others.begin()) + (high - others.begin())) /
        2;
  }
  return (above - m * n / 2) / std::sqrt(m * n * (m + n + 1) / 12);
}

double ForceOf(const CalibrationFrame& frame) {
  return frame.Force().magnitude_N;
}

double HeightOf(const CalibrationFrame& frame) {
  return std::isfinite(frame.contact_mm) ? frame.contact_mm
                                         : frame.object_mm.y();
}

// Rows count from 1.
double RowOf(const CalibrationFrame& frame) { return frame.row + 1; }

// Names the row at which a log changes, if the rows on one side of it are
// rejected and those on the other are not, with few exceptions.
std::string ChangeInWords(const CalibrationProblem& problem) {
  struct Row {
    int row;
    bool rejected;
  };
  std::map<int, std::vector<Row>> logs;
  int all = 0;  // rejected rows
  for (const int i : problem.candidates()) {
    const CalibrationFrame& frame = problem.frame(i);
    if (!frame.contact) continue;
    const bool rejected = problem.rejected().count(i) > 0;
    logs[frame.log].push_back({frame.row, rejected});
    all += rejected;
  }
  for (auto& [log, rows] : logs) {
    std::sort(rows.begin(), rows.end(),
              [](const Row& a, const Row& b) { return a.row < b.row; });
    const auto rejected = static_cast<int>(std::count_if(
        rows.begin(), rows.end(), [](const Row& row) { return row.rejected; }));
    const auto fitted = static_cast<int>(rows.size()) - rejected;
    if (rejected < kLeastOfChange || fitted < kLeastOfChange) continue;
    if (all - rejected > kMostExceptions * rejected) continue;
    int before = 0;  // rejected rows, less the fitted ones
    double fewest = kMostExceptions * std::min(rejected, fitted);
    std::string words;
    for (const Row& row : rows) {
      before += row.rejected ? 1 : -1;
      // Exceptions if what is up to this row is rejected, or what is behind it.
      const int early = rejected - before, late = fitted + before;
      if (std::min(early, late) > fewest) continue;
      fewest = std::min(early, late);
      words = FormatText(", nearly all %s row %d of ",
                         early < late ? "up to" : "behind", row.row + 1);
    }
    if (words.empty()) continue;
    return words + problem.logs().names[log] +
           ": something changes there, such as offsets of gauges; give the "
           "rows before and after as logs of their own, with gauge_offset: "
           "{per_log: true}";
  }
  return "";
}

void DoubtRejected(const CalibrationProblem& problem,
                   std::vector<std::string>* doubts) {
  const std::pair<double (*)(const CalibrationFrame&),
                  std::pair<const char*, const char*>>
      kinds[] = {{ForceOf, {"low forces", "high forces"}},
                 {HeightOf, {"places near the base", "places near the tip"}},
                 {RowOf, {"early rows", "late rows"}}};
  for (const auto& [of, ends] : kinds) {
    std::vector<double> rejected, fitted;
    for (const int i : problem.candidates()) {
      const CalibrationFrame& frame = problem.frame(i);
      const double number = of(frame);
      if (!frame.contact || !std::isfinite(number)) continue;
      (problem.rejected().count(i) > 0 ? rejected : fitted).push_back(number);
    }
    const double apart = RanksApart(rejected, fitted);
    if (std::abs(apart) < kRanksApart) continue;
    doubts->push_back(
        FormatText("the %zu rejected frames are of ", rejected.size()) +
        (apart < 0 ? ends.first : ends.second) +
        (of == RowOf ? ChangeInWords(problem) : ""));
  }
}

}  // namespace

std::string QuietInWords(ResidualFamily family,
                         const Identifiability::Noise& noise) {
  const double ratio = noise.chi2 / noise.dof;
  return ResidualFamilyName(family) +
         FormatText(
             " residuals are %.2f of what their std says (chi2/dof %.3g)",
             std::sqrt(ratio), ratio);
}

std::vector<std::string> FindDoubts(const CalibrationProblem& problem,
                                    const CalibrationResult& result) {
  std::vector<std::string> doubts;
  DoubtCoverage(result, &doubts);
  DoubtChi2(result.identifiability, &doubts);
  DoubtQuiet(result.identifiability, &doubts);
  DoubtPriors(problem.parameters(), &doubts);
  DoubtImpossible(problem.parameters(), result.identifiability, &doubts);
  DoubtRejected(problem, &doubts);
  if (result.score.Best() != nullptr) {
    doubts.push_back(result.score.explained.value_or(false)
                         ? "the plan leaves out an effect that the logs show"
                         : "the residuals are not noise");
  }
  for (const std::string& test : result.not_tested) {
    doubts.push_back("not tested: " + test);
  }
  return doubts;
}

namespace {

// Names steps of converters that noise does not cover, as their own noise,
// step / sqrt(12), is larger, if both together explain the residuals.
std::string StepsInWords(const CalibrationProblem& problem,
                         const CalibrationSolution& solution) {
  const Finger& finger = problem.finger();
  std::vector<double> noise_V;
  for (const Gauge& gauge : finger.gauges) noise_V.push_back(gauge.noise_V);
  const std::vector<double> stated_V = noise_V;
  std::map<std::string, std::string> logs;  // by the words of their steps
  for (const auto& [log, faults] : FindGaugeFaults(problem.logs(), finger)) {
    std::vector<GaugeFault> steps;
    for (const GaugeFault& fault : faults) {
      const double own_V = fault.step_V / std::sqrt(12.0);
      const double its_V = stated_V[fault.gauge];
      if (fault.kind != GaugeFault::Kind::kCoarse || own_V < its_V) continue;
      double& all_V = noise_V[fault.gauge];
      all_V = std::max(all_V, std::hypot(its_V, own_V));
      steps.push_back(fault);
    }
    if (steps.empty()) continue;
    std::string& names = logs[WordsOf(steps, true)];
    names += (names.empty() ? " in " : ", ") + problem.logs().names[log];
  }
  if (logs.empty() || !FitsWithNoise(problem, solution, noise_V)) return "";
  std::string words;
  for (const auto& [steps, names] : logs) {
    words += (words.empty() ? "" : ", ") + steps + names;
  }
  return words;
}

// Squares of residuals, and how many.
struct Squares {
  double sum = 0;
  int count = 0;
  double mean() const { return count > 0 ? sum / count : 0; }
};

// Says where residuals are largest: of which gauge, and at which end of the
// loads, places and rows.
std::string WhereInWords(const CalibrationProblem& problem,
                         const Linearization& at) {
  std::map<int, Squares> gauges;
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    if (at.rows[i].family != ResidualFamily::kGauge) continue;
    Squares& gauge = gauges[at.rows[i].gauge];
    gauge.sum += std::pow(at.residuals[i], 2);
    ++gauge.count;
  }
  std::string words;
  double most = 0;
  for (const auto& [gauge, squares] : gauges) {
    if (squares.mean() <= most) continue;
    most = squares.mean();
    words = FormatText("residuals are largest in gauge %d (%.2g std)",
                       gauge + 1, std::sqrt(most));
  }
  const std::pair<double (*)(const CalibrationFrame&), const char*> kinds[] = {
      {ForceOf, "forces %s %.3g N"},
      {HeightOf, "places %s %.3g mm"},
      {RowOf, "rows %s %.0f"}};
  std::string where;
  double apart = 0;
  for (const auto& [of, format] : kinds) {
    if (of == RowOf && problem.logs().paths.size() > 1) continue;
    std::vector<double> numbers;
    for (const ResidualInfo& row : at.rows) {
      const double number = of(problem.frame(row.frame));
      if (std::isfinite(number)) numbers.push_back(number);
    }
    if (numbers.size() < 20) continue;
    const double middle = Median(numbers);
    Squares low, high;
    for (std::size_t i = 0; i < at.rows.size(); ++i) {
      const double number = of(problem.frame(at.rows[i].frame));
      if (!std::isfinite(number)) continue;
      Squares& half = number > middle ? high : low;
      half.sum += std::pow(at.residuals[i], 2);
      ++half.count;
    }
    if (low.count == 0 || high.count == 0) continue;
    const double by = std::abs(high.mean() - low.mean());
    if (by <= apart) continue;
    apart = by;
    const bool above = high.mean() > low.mean();
    where = FormatText(format, above ? "above" : "up to", middle) +
            FormatText(" (%.2g std instead of %.2g)",
                       std::sqrt(std::max(high.mean(), low.mean())),
                       std::sqrt(std::min(high.mean(), low.mean())));
  }
  if (words.empty()) return where;
  return where.empty() ? words : words + ", and at " + where;
}

}  // namespace

void WarnOfDoubts(const CalibrationProblem& problem,
                  CalibrationResult* result) {
  const bool effect = result->score.Best() != nullptr;
  if (result->Verdict() == "good" || (!effect && result->doubts.empty())) {
    return;
  }
  const Identifiability& found = result->identifiability;
  std::vector<std::string> quiet;
  DoubtQuiet(found, &quiet);
  const bool only_quiet = !effect && quiet == result->doubts;
  const bool unexplained = effect || TotalChi2::Of(found).IsLoud();
  const std::string steps =
      unexplained ? StepsInWords(problem, result->solution) : "";
  const std::string named = !steps.empty() ? steps
                            : only_quiet
                                ? "the noise that is stated is too large"
                                : result->score.Words();
  std::string text;
  const auto say = [&text](const std::string& words) {
    if (!words.empty()) text += (text.empty() ? "" : "; ") + words;
  };
  if (!named.empty()) {
    say("likeliest cause: " + named);
  } else if (unexplained) {
    say(result->score.FoundNone()
            ? "likeliest cause: none of the effects that finray knows explains "
              "the logs"
            : "the likeliest cause was not found");
    say(WhereInWords(problem, result->solution.at));
  }
  for (const std::string& doubt : result->doubts) say(doubt);
  // The scatter of free readings is measured, so it is likelier still.
  auto first = result->warnings.begin();
  if (first != result->warnings.end() && first->code == "free_scatter") ++first;
  result->warnings.insert(
      first,
      {"doubtful", text,
       !steps.empty()
           ? "choose a finer range of the converter, or a gauge_std_V of step "
             "/ sqrt(12) in the plan's measurements"
       : only_quiet ? "state the noise that fits (noise_below_plan)"
       : !named.empty()
           ? "check that part of the setup, or free it in the plan; "
             "--explore frees it if frames are then predicted better"
           : "look at the residuals by frame, and at the std in the plan's "
             "measurements"});
}

std::string WhyNotAdopted(const CalibrationResult& explored,
                          const CalibrationResult& given) {
  constexpr double kLess_percent = 2.5;
  const double with = explored.UnseenForces().coverage_95_percent();
  const double without = given.UnseenForces().coverage_95_percent();
  if (explored.Verdict() == "good" || !(with < without - kLess_percent)) {
    return "";
  }
  return FormatText(
      "with the freed effects the verdict is %s, and 95 %% intervals of force "
      "hold in %.0f %% of unseen frames, without them in %.0f %%",
      explored.Verdict().c_str(), with, without);
}

}  // namespace finray
