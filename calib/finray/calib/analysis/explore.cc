#include "finray/calib/analysis/explore.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "finray/calib/analysis/cross_validation.h"
#include "finray/calib/analysis/refit.h"
#include "finray/calib/analysis/score_test.h"
#include "finray/calib/solve/robust_solve.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

Exploration::Step* LastFreed(Exploration* exploration) {
  const auto last =
      std::find_if(exploration->steps.rbegin(), exploration->steps.rend(),
                   [](const Exploration::Step& step) { return step.kept; });
  return last == exploration->steps.rend() ? nullptr : &*last;
}

// Frees the effect that predicts unseen frames best. Returns false if none
// does, and leaves the solution as it was.
bool FreeNext(SolvedProblem* now, Exploration* result) {
  now->problem->Tell("effects that the plan leaves out");
  const WideLinearization wide = LinearizeWide(*now->problem, now->solution);
  const Identifiability found =
      AnalyzeIdentifiability(now->problem, now->solution.at);
  ScoreTest score = TestScores(*now->problem, found, wide);
  constexpr char kNone[] = "no effect that finray knows explains the logs";
  if (score.Best() == nullptr) {
    if (TotalChi2::Of(found).IsLoud()) result->beyond = kNone;
    return false;
  }
  if (!score.Best()->CanBeFreed()) {
    JudgeEffects(*now, &score);
    if (score.FoundNone()) {
      result->beyond = kNone;
      return false;
    }
    if (!score.Best()->CanBeFreed()) {
      result->beyond = "no plan frees this: " + score.Best()->words;
      return false;
    }
  }
  const double before = CrossValidatedLogLikelihood(*now->problem, wide);
  std::vector<ScoreTest::Effect> tried;
  for (const ScoreTest::Effect& effect : score.effects) {
    if (effect.significant && effect.CanBeFreed() &&
        tried.size() < kMostRivals) {
      tried.push_back(effect);
    }
  }
  std::optional<SolvedProblem> best;
  std::optional<std::size_t> kept;
  for (const ScoreTest::Effect& effect : tried) {
    const CandidateEffect candidate = effect.Candidate();
    std::string why_not;
    std::optional<SolvedProblem> with = SolveWith(candidate, *now, &why_not);
    if (!with) {
      const std::string failed = std::string("refit with ") +
                                 FamilyKeyOf(candidate.family) +
                                 " free: " + why_not + "; it stays fixed";
      if (std::count(result->failed.begin(), result->failed.end(), failed) ==
          0) {
        result->failed.push_back(failed);
      }
      continue;
    }
    Exploration::Step step{candidate, effect.words, 0, before, 0, false};
    step.drop = 2 * (now->Cost() - with->Cost());
    step.after = with->log_likelihood;
    result->steps.push_back(step);
    const double bar = kept ? result->steps[*kept].after : before;
    if (!(step.after > bar)) continue;
    kept = result->steps.size() - 1;
    best = std::move(with);
  }
  if (!kept) return false;
  result->steps[*kept].kept = true;
  *now = std::move(*best);
  return true;
}

}  // namespace

Exploration Explore(CalibrationProblem* problem) {
  Exploration result;
  SolvedProblem now{problem, nullptr, SolveRobustly(problem)};
  std::string free;
  while (now.solution.solve.converged && !now.solution.at.frames.empty()) {
    try {
      if (!FreeNext(&now, &result)) break;
    } catch (const std::runtime_error& error) {
      result.failed.push_back("search for effects" + free + ": " +
                              error.what() + "; no more are freed");
      break;
    }
    free =
        std::string(" after ") + FamilyKeyOf(LastFreed(&result)->effect.family);
    const std::string why_not = JudgeAgain(&now);
    if (!why_not.empty()) {
      result.failed.push_back("judging outliers again" + free + ": " + why_not +
                              "; they stay as they were");
    }
  }
  return result;
}

bool FixLast(const std::string& why, Exploration* exploration) {
  Exploration::Step* last = LastFreed(exploration);
  if (last == nullptr) return false;
  last->kept = false;
  exploration->failed.push_back(std::string("calibration with ") +
                                FamilyKeyOf(last->effect.family) +
                                " free: " + why + "; it stays fixed");
  return true;
}

std::string WordsOf(const Exploration::Step& step) {
  return std::string(step.kept ? "freed " : "left fixed ") +
         FamilyKeyOf(step.effect.family) + ": " + step.words +
         FormatText(
             "; refit: chi2 %.0f, log-likelihood of unseen frames %.1f "
             "instead of %.1f",
             -step.drop, step.after, step.before);
}

namespace {

// Returns a path that `file` gives from its own folder on.
std::string InFolderOf(const std::string& file, const std::string& path) {
  return (std::filesystem::path(file).parent_path() / path).string();
}

// Makes the path of a shared mapping absolute, as the YAML that names it is
// written to another folder.
void FindColumnsFromAnywhere(const std::string& file, YAML::Node* yaml) {
  YAML::Node columns = (*yaml)["columns"];
  if (!columns || !columns.IsScalar()) return;
  columns =
      std::filesystem::absolute(InFolderOf(file, columns.as<std::string>()))
          .string();
}

}  // namespace

std::string ExploredPlanYaml(const std::string& path, const std::string& text,
                             const Exploration& exploration) {
  YAML::Node plan = YAML::Load(text);
  FindColumnsFromAnywhere(path, &plan);
  if (plan["scene"] && plan["scene"].IsScalar()) {
    const std::string scene_path =
        InFolderOf(path, plan["scene"].as<std::string>());
    YAML::Node scene = YAML::LoadFile(scene_path);
    FindColumnsFromAnywhere(scene_path, &scene);
    plan["scene"] = scene;
  } else if (plan["scene"]) {
    YAML::Node scene = plan["scene"];
    FindColumnsFromAnywhere(path, &scene);
  }
  const auto freed_before = [&](ParameterFamily family) {
    const YAML::Node node = plan["parameters"][FamilyKeyOf(family)];
    return node && !(node["fixed"] && node["fixed"].as<bool>());
  };
  std::string explored = "# " + path +
                         ", with what finray_calibrate --explore has"
                         " freed.\n";
  for (const Exploration::Step& step : exploration.steps) {
    explored += "# " + WordsOf(step) + "\n";
    if (!step.kept) continue;
    const char* key = FamilyKeyOf(step.effect.family);
    if (step.effect.per_log && freed_before(step.effect.family)) {
      plan["parameters"][key]["per_log"] = true;
      continue;
    }
    YAML::Node family;
    family[PriorKeyOf(step.effect.family)] = NumberText(step.effect.prior_std);
    if (step.effect.per_log) family["per_log"] = true;
    plan["parameters"][key] = family;
  }
  return explored + YAML::Dump(plan) + "\n";
}

}  // namespace finray
