// Compares a calibrated finger with logs that it was not calibrated from.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app.h"
#include "finray/batch/estimation_warnings.h"
#include "finray/calib/analysis/validation.h"
#include "finray/io/atomic_file.h"
#include "finray/io/log_list.h"
#include "finray/io/message_text.h"
#include "finray/io/number_text.h"

DEFINE_string(finger, "", "calibrated finger YAML");
DEFINE_string(scene, "", "scene YAML; neither this nor a plan: contacts: auto");
DEFINE_string(plan, "", "plan YAML, for its scene, std and columns");
DEFINE_string(logs, "",
              "CSV logs with a reference (force, contact or object), separated "
              "by commas");
DEFINE_string(out_dir, "", "folder for validation.yaml, validation.frames.csv");
DEFINE_string(baseline, "", "finger YAML to compare with, e.g. uncalibrated");
DEFINE_int32(threads, 0, "threads over frames; 0: all cores");
DEFINE_bool(strict, false,
            "fail, exit code 4, if the errors are large or contradict their "
            "std, whatever the gates");

DEFINE_double(most_force_rms_N, 0,
              "gate: rms error of the force; default: none");
DEFINE_double(most_force_percent, 0,
              "gate: the same in percent of the rms force; default: none");
DEFINE_double(most_contact_rms_mm, 0, "gate: rms error of l_c; default: none");
DEFINE_double(least_coverage_68_percent, 0,
              "gate: frames within one predicted std; default: none");
DEFINE_double(least_coverage_95_percent, 0,
              "gate: frames within 1.96 predicted std; default: none");
DEFINE_double(least_usable_percent, 0,
              "gate: frames that are ok or no_contact; default: none");

namespace {

using namespace finray;

Plan PlanOrScene() {
  Plan plan;
  if (!FLAGS_plan.empty()) plan = ReadPlan(FLAGS_plan);
  if (FLAGS_scene.empty()) return plan;
  plan.scene = ReadScene(FLAGS_scene);
  RefuseBackContacts(plan.scene);
  plan.columns = plan.scene.columns;
  return plan;
}

void CheckBound(const std::string& name, double bound) {
  const auto refuse = [&](const std::string& expected) {
    throw UsageError("--" + name + ": expected " + expected + ", found " +
                     NumberText(bound));
  };
  if (!(bound > 0) || std::isinf(bound)) refuse("a number above 0");
  if (name.find("_percent") == std::string::npos) return;
  if (bound > 100) refuse("at most 100 percent");
  if (name.find("least_") == 0 && bound < 1) {
    refuse("a number in percent, such as " + NumberText(100 * bound));
  }
}

// Returns the names and bounds of the gates that are given.
std::vector<std::pair<std::string, double>> Bounds() {
  const std::pair<const char*, double> all[] = {
      {"most_force_rms_N", FLAGS_most_force_rms_N},
      {"most_force_percent", FLAGS_most_force_percent},
      {"most_contact_rms_mm", FLAGS_most_contact_rms_mm},
      {"least_coverage_68_percent", FLAGS_least_coverage_68_percent},
      {"least_coverage_95_percent", FLAGS_least_coverage_95_percent},
      {"least_usable_percent", FLAGS_least_usable_percent}};
  std::vector<std::pair<std::string, double>> given;
  for (const auto& [name, bound] : all) {
    if (!IsGiven(name)) continue;
    CheckBound(name, bound);
    given.emplace_back(name, bound);
  }
  return given;
}

// These parameters belong to the calibration's own logs. The finger YAML does
// not hold them, so the errors found here contain their effect, unless the
// stage of each log was found anew.
void WarnOfParametersOfLogs(const Plan& plan, bool all_aligned) {
  const std::pair<ParameterFamily, const char*> of_logs[] = {
      {ParameterFamily::kObjectOrigin, "object_origin"},
      {ParameterFamily::kObjectRotation, "object_rotation"},
      {ParameterFamily::kObjectScale, "object_scale"},
      {ParameterFamily::kObjectRadius, "object_radius"},
      {ParameterFamily::kForceScale, "force_scale"},
      {ParameterFamily::kForceOffset, "force_offset"},
      {ParameterFamily::kForceTimeOffset, "force_time_offset"},
      {ParameterFamily::kForceTilt, "force_tilt"},
      {ParameterFamily::kForceWeight, "force_weight"},
      {ParameterFamily::kTemperatureCoefficient, "temperature_coefficient"},
      {ParameterFamily::kGaugeDrift, "gauge_drift"}};
  std::vector<std::string> names;
  for (const auto& [family, name] : of_logs) {
    const bool of_stage = family == ParameterFamily::kObjectOrigin ||
                          family == ParameterFamily::kObjectRotation;
    if (plan.family(family).free && !(of_stage && all_aligned)) {
      names.push_back(name);
    }
  }
  if (names.empty()) return;
  Warn("the plan frees " + Joined(names) +
           ": its value from the calibration is not applied to these logs, so "
           "the errors contain it",
       "correct the logs, or use `holdout` in the plan");
}

// Where the stage of a log is, as far as it differs from that of the plan.
void PrintStages(const CalibrationLogs& logs,
                 const std::vector<FittedStage>& stages) {
  constexpr std::size_t kMostShown = 5;
  for (std::size_t i = 0; i < std::min(stages.size(), kMostShown); ++i) {
    const FittedStage& stage = stages[i];
    std::printf("origin         %+.3f, %+.3f mm (std %.2g, %.2g) fitted to %s",
                stage.origin_mm.x(), stage.origin_mm.y(),
                stage.origin_std_mm.x(), stage.origin_std_mm.y(),
                logs.names[stage.log].c_str());
    if (stage.rotation_std_deg > 0) {
      std::printf(", turned by %+.3f deg (std %.2g)", stage.rotation_deg,
                  stage.rotation_std_deg);
    }
    std::printf("\n");
  }
  if (stages.size() > kMostShown) {
    std::printf("               and %zu more in validation.yaml\n",
                stages.size() - kMostShown);
  }
}

void WarnOfStages(const CalibrationLogs& logs,
                  const std::vector<FittedStage>& stages) {
  constexpr double kFar = 3;  // std of the prior
  for (const FittedStage& stage : stages) {
    if (stage.over_prior <= kFar) continue;
    Warn(FormatText("the stage of %s is %.3g std of the plan's prior from "
                    "where the plan has it",
                    logs.names[stage.log].c_str(), stage.over_prior),
         "look at how the object was set up, and at the columns of its place");
  }
}

// Returns whether there is something to warn of.
bool WarnOfErrors(const Finger& finger, const ErrorRow& errors) {
  const std::vector<std::string> faults = FaultsOf(errors);
  if (faults.empty()) return false;
  Warn((finger.calibration ? "the finger has changed since its calibration, "
                             "or the scene is another: "
                           : "the finger is not calibrated: ") +
           Joined(faults),
       finger.calibration ? "zero the gauges, then calibrate anew"
                          : "calibrate it with finray_calibrate");
  return true;
}

void PrintErrors(const char* name, const ErrorStatistics& errors,
                 const ErrorStatistics* baseline, const char* unit) {
  if (errors.frames == 0) {
    std::printf("%s not known: no usable frame with a reference\n", name);
    return;
  }
  std::printf("%s %.3g %s rms", name, errors.rms(), unit);
  if (unit[0] == 'N') std::printf(" (%.3g %%)", errors.percent());
  std::printf(", %.3g %s at most", errors.largest, unit);
  if (baseline != nullptr && baseline->frames > 0) {
    std::printf("; baseline %.3g %s rms", baseline->rms(), unit);
  }
  std::printf("\n");
}

void PrintSummary(const CalibrationLogs& logs, const Validation& validation,
                  const std::vector<Gate>& gates) {
  const ErrorRow& errors = validation.errors.contact;
  const ErrorRow* baseline = validation.baseline_errors
                                 ? &validation.baseline_errors->contact
                                 : nullptr;
  std::printf("%s\n", OutPath("validation.yaml").c_str());
  std::printf(
      "frames         %zu with contact (%zu usable, %zu missed), %zu free (%zu "
      "untrue), in %zu log%s\n",
      errors.frames, errors.usable, errors.missed,
      validation.errors.free.frames, validation.errors.free.untrue,
      logs.paths.size(), logs.paths.size() == 1 ? "" : "s");
  PrintErrors("force error   ", errors.force_N,
              baseline ? &baseline->force_N : nullptr, "N");
  PrintErrors("contact error ", errors.contact_mm,
              baseline ? &baseline->contact_mm : nullptr, "mm");
  const std::pair<const char*, const ErrorStatistics*> quantities[] = {
      {"force", &errors.force_N}, {"contact", &errors.contact_mm}};
  std::vector<std::string> words;
  for (const auto& [name, statistics] : quantities) {
    if (statistics->judged == 0) continue;
    words.push_back(FormatText(" %s %.1f and %.1f %%", name,
                               statistics->coverage_68_percent(),
                               statistics->coverage_95_percent()));
  }
  std::printf("coverage      %s (68 and 95 %% predicted)\n",
              Joined(words, ",").c_str());
  PrintStages(logs, validation.stages);
  std::printf("gates          %s\n", gates.empty()
                                         ? "none given, so nothing is judged"
                                         : GateWords(gates).c_str());
}

int Run() {
  const Finger finger = ReadFinger(Required("finger", FLAGS_finger));
  const Plan plan = PlanOrScene();
  Required("out_dir", FLAGS_out_dir);
  const auto paths =
      ExpandLogs(SplitList(Required("logs", FLAGS_logs)), FLAGS_out_dir);
  const auto bounds = Bounds();
  std::optional<Finger> baseline;
  if (!FLAGS_baseline.empty()) {
    baseline = ReadFinger(FLAGS_baseline);
    if (baseline->gauges.size() != finger.gauges.size()) {
      throw InputError(FLAGS_baseline + ": " +
                       std::to_string(baseline->gauges.size()) +
                       " gauges, but " + FLAGS_finger + " has " +
                       std::to_string(finger.gauges.size()));
    }
  }
  const Discretization discretization = DiscretizationFlags();
  Scene with_columns = plan.scene;
  with_columns.columns = plan.columns;
  if (DumpConfigFlag(finger, with_columns, discretization)) return kGood;
  Plan whole = plan;
  whole.holdout_by = HoldoutBy::kNothing;  // these logs are held out already
  // The finger states the noise of a reading, and the logs how many of them
  // are a row.
  whole.gauge_std_V.reset();
  const CalibrationLogs logs = ReadCalibrationLogs(paths, finger, whole);
  if (!logs.copies.empty()) Warn(logs.copies, kCopiesRemedy);
  const Validation validation = Validate(
      finger, baseline, whole, logs, discretization, Threads(FLAGS_threads));
  Warn(FrictionWarnings(finger, plan.scene));
  WarnOfParametersOfLogs(plan, validation.stages.size() == logs.paths.size());
  WarnOfStages(logs, validation.stages);
  const std::vector<Gate> gates = CheckGates(validation, bounds);

  std::vector<const char*> flags = {"finger",   "plan",      "scene",
                                    "baseline", "logs",      "out_dir",
                                    "scheme",   "resolution"};
  for (const Gate& gate : gates) flags.push_back(gate.name.c_str());
  MakeFolder(FLAGS_out_dir);
  WriteFileAtomically(
      OutPath("validation.yaml"),
      ValidationYaml(logs, validation, gates,
                     {FLAGS_finger, FLAGS_baseline,
                      FLAGS_plan.empty() ? FLAGS_scene : FLAGS_plan,
                      plan.columns.path, CommandWith(flags)}));
  ValidationFrames(logs, validation, plan.scene.friction_coefficient)
      .Write(OutPath("validation.frames.csv"));
  PrintSummary(logs, validation, gates);
  const bool doubtful = WarnOfErrors(finger, validation.errors.contact);
  return AllPassed(gates) && !(FLAGS_strict && doubtful) ? kGood : kGateFailed;
}

}  // namespace

const finray::App finray::kApp = {
    "Errors and coverage of a calibrated finger on logs with a reference.\n"
    "finray_validate --finger D/finger.yaml --plan P.yaml --logs c.csv "
    "--out_dir V [--baseline F.yaml] [--most_force_rms_N 0.1]",
    Run};
