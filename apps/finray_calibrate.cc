// Calibrates a finger from logs with a reference force, object place, or both.

#include <cstdio>
#include <memory>

#include "app.h"
#include "finray/calib/analysis/plausibility.h"
#include "finray/calib/analysis/reading_noise.h"
#include "finray/calib/report/calibration_result.h"
#include "finray/calib/report/explored_calibration.h"
#include "finray/io/atomic_file.h"
#include "finray/io/log_list.h"
#include "finray/io/yaml_limits.h"
#include "heartbeat.h"

DEFINE_string(finger, "", "finger YAML to start from");
DEFINE_string(plan, "", "plan YAML: free parameters, priors, noise");
DEFINE_string(logs, "", "CSV logs, patterns and lists, separated by commas");
DEFINE_string(out_dir, "", "folder for finger.yaml, calibration.yaml, report");
DEFINE_int32(threads, 0, "threads over frames; 0: all cores");
DEFINE_double(tolerance_std, 0.01,
              "parameters move until their gradient is below this, in std");
DEFINE_bool(report, true, "render report.html");
DEFINE_bool(leave_one_log_out, true,
            "with several logs: repeat without each, to see if they agree");
DEFINE_bool(explore, false,
            "free effects that the plan leaves out while unseen frames are "
            "predicted better; writes the plan beside the finger");

namespace {

using namespace finray;

// Says how far forces from the gauges alone are off, over frames with contact
// that have a usable estimate.
std::string ForceWords(const ForceCheck& forces) {
  const ErrorRow& after = forces.fitted.after.contact;
  const ErrorStatistics& before = forces.fitted.before.contact.force_N;
  const ErrorStatistics& kept = forces.held_out.after.contact.force_N;
  if (after.force_N.frames == 0) {
    return "not known: it takes a reference force and two gauges";
  }
  std::string words;
  if (before.frames > 0)
    words = FormatText("%.3g N rms before, ", before.rms());
  words += FormatText("%.3g N rms", after.force_N.rms());
  if (before.frames > 0) words += " after";
  if (kept.frames > 0) words += FormatText(", %.3g N held out", kept.rms());
  if (after.usable < after.frames) {
    words += FormatText("; %zu of %zu frames without a usable estimate",
                        after.frames - after.usable, after.frames);
  }
  return words;
}

void PrintSummary(CalibrationProblem& problem,
                  const CalibrationResult& result) {
  int counts[4] = {};
  for (const ParameterStatus status : result.identifiability.status) {
    ++counts[static_cast<int>(status)];
  }
  int contact = 0, free = 0, held_out = 0, bench = 0;
  for (std::size_t i = 0; i < problem.logs().frames.size(); ++i) {
    if (problem.rejected().count(static_cast<int>(i)) > 0) continue;
    const CalibrationFrame& frame = problem.logs().frames[i];
    ++(frame.held_out    ? held_out
       : frame.IsBench() ? bench
       : frame.contact   ? contact
                         : free);
  }
  std::printf("%s\n", OutPath("finger.yaml").c_str());
  const CalibrationSolution& solution = result.solution;
  std::printf("solver         %s after %d iterations",
              solution.solve.converged ? "converged" : "did not converge",
              solution.solve.iterations);
  if (!solution.starts.empty()) {
    std::printf(", %d of %zu starts agree", solution.agreeing(),
                solution.starts.size());
  }
  if (result.Verdict() != "good") {
    std::printf("; verdict: %s", result.Verdict().c_str());
  }
  std::printf("\nframes         %d contact, %d free, %d held out", contact,
              free, held_out);
  if (bench > 0) std::printf(", %d on the bench", bench);
  if (!problem.rejected().empty()) {
    std::printf(", %zu rejected", problem.rejected().size());
  }
  std::printf("\n");
  std::printf(
      "parameters     %d estimated, %d prior_dominated, %d unidentifiable\n",
      counts[0], counts[1], counts[2]);
  std::printf("noise          chi2/dof");
  for (int i = 0; i < kResidualFamilies; ++i) {
    const Identifiability::Noise& noise = result.identifiability.noise[i];
    if (noise.residuals == 0 || noise.dof < 0.5) continue;
    std::printf(" %s %.2f", ResidualFamilyName(static_cast<ResidualFamily>(i)),
                noise.chi2 / noise.dof);
  }
  std::printf("\n");
  const std::string noise = ReadingNoiseWords(problem, result.finger);
  if (!noise.empty()) std::printf("noise_V        %s\n", noise.c_str());
  std::printf("force error    %s\n", ForceWords(result.forces).c_str());
  if (result.discrepancy) {
    std::printf(
        "model error    %s; finger.yaml and the std of estimates have it",
        WordsOf(*result.discrepancy).c_str());
    if (result.UnseenForces().judged > 0) {
      std::printf(": 95 %% intervals of unseen forces hold in %.0f %%",
                  result.UnseenForces().coverage_95_percent());
    }
    std::printf("\n");
  }
  for (std::size_t k = 0; k < problem.parameters().free().size(); ++k) {
    // The finger's file does not keep it.
    const CalibrationParameter& p = problem.parameters().FreeParameter(k);
    if (p.family != ParameterFamily::kFriction) continue;
    std::printf(
        "friction       %.3f +- %.3f; scenes take it as friction_coefficient: "
        "%.3f\n",
        *p.variable, result.identifiability.std[static_cast<int>(k)],
        *p.variable);
  }
  std::printf("next           %s\n", NextWords(result.next).c_str());
  constexpr int kMostWeak = 3;  // all are in calibration.yaml
  int weak = 0;
  for (const Warning& warning : result.warnings) {
    if (warning.code == "weak_direction" && ++weak > kMostWeak) continue;
    Warn(warning.text, warning.remedy);
  }
  if (weak > kMostWeak) {
    Warn(std::to_string(weak - kMostWeak) + " more directions are weak",
         "see weak_directions in calibration.yaml");
  }
}

void PrintExploration(const Exploration& exploration) {
  for (const Exploration::Step& step : exploration.steps) {
    std::printf("explored       %s\n", WordsOf(step).c_str());
  }
  if (!exploration.beyond.empty()) {
    std::printf("explored       ended: %s\n", exploration.beyond.c_str());
  } else if (exploration.steps.empty() && exploration.failed.empty()) {
    std::printf(
        "explored       the logs show no effect that the plan leaves "
        "out\n");
  }
}

// Calibrates with the plan that --explore ends with, and writes that plan. It
// is then the input, and its command makes the same result.
ExploredCalibration ExploreAndCalibrate(const Plan& plan,
                                        const ProblemOfPlan& problem_of) {
  ExploredCalibration done = CalibrateExplored(
      plan, FLAGS_plan, ReadWholeFile(FLAGS_plan, "a YAML file", kMostYaml_MiB),
      problem_of, FLAGS_leave_one_log_out);
  PrintExploration(done.exploration);
  MakeFolder(FLAGS_out_dir);
  WriteFileAtomically(OutPath("plan.yaml"), done.plan_yaml);
  if (!done.as_given) FLAGS_plan = OutPath("plan.yaml");
  return done;
}

int Run() {
  const Finger finger = ReadFinger(Required("finger", FLAGS_finger));
  const Plan plan = ReadPlan(Required("plan", FLAGS_plan));
  Required("out_dir", FLAGS_out_dir);
  const auto paths =
      ExpandLogs(SplitList(Required("logs", FLAGS_logs)), FLAGS_out_dir);
  if (!(FLAGS_tolerance_std > 0)) {
    throw UsageError("--tolerance_std: expected a number above 0");
  }
  const Discretization discretization = DiscretizationFlags();
  Scene with_columns = plan.scene;
  with_columns.columns = plan.columns;
  if (DumpConfigFlag(finger, with_columns, discretization)) return kGood;
  ExploredCalibration done;
  {
    Heartbeat heartbeat;
    const auto problem_of = [&](const Plan& with) {
      auto problem = std::make_unique<CalibrationProblem>(
          finger, with, ReadCalibrationLogs(paths, finger, with),
          discretization, Threads(FLAGS_threads));
      problem->set_tolerance_std(FLAGS_tolerance_std);
      RefuseImplausible(problem.get());
      problem->TellProgress(
          [&](const std::string& step) { heartbeat.Say(step); });
      return problem;
    };
    if (FLAGS_explore) {
      done = ExploreAndCalibrate(plan, problem_of);
    } else {
      done.problem = problem_of(plan);
      done.result = Calibrate(done.problem.get(), FLAGS_leave_one_log_out);
    }
    done.problem->TellProgress({});
  }
  CalibrationProblem& problem = *done.problem;
  const CalibrationResult& result = done.result;

  const std::string command =
      CommandWith({"finger", "plan", "logs", "out_dir", "scheme", "resolution",
                   "leave_one_log_out", "tolerance_std"});
  const std::string why_not = WriteCalibration(
      problem, result,
      {FLAGS_finger, FLAGS_plan, FLAGS_scheme, FLAGS_resolution, command, {}},
      FLAGS_out_dir, FLAGS_report);
  if (!why_not.empty()) Warn("no report.html", why_not);
  PrintSummary(problem, result);
  const std::string verdict = result.Verdict();
  return verdict == "good"            ? kGood
         : verdict == "not_converged" ? kSolveFailed
                                      : kGateFailed;
}

}  // namespace

const finray::App finray::kApp = {
    "Calibrates stiffness, gauges and rib lengths of a finger from logs.\n"
    "finray_calibrate --finger F.yaml --plan P.yaml --logs a.csv,b.csv "
    "--out_dir D",
    Run};
