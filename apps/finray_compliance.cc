// Measures the stiffness of yielding objects with fingers and sorts them.

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "app.h"
#include "finray/batch/estimation_warnings.h"
#include "finray/io/atomic_file.h"
#include "finray/io/log_list.h"
#include "finray/io/number_text.h"
#include "finray/io/python_script.h"
#include "finray/perception/perception_files.h"

DEFINE_string(finger, "", "finger YAML, preferably calibrated");
DEFINE_string(scene, "",
              "scene YAML: its circle is the pulley, its spring has the "
              "direction of the slider");
DEFINE_string(logs, "",
              "CSV logs with gauge_<j>_V, object_x_mm, object_y_mm and, for "
              "several trials in one log, the text columns object and trial; "
              "files, patterns or lists, separated by commas");
DEFINE_string(second_finger, "",
              "finger YAML of the second finger; default: --finger");
DEFINE_string(second_logs, "",
              "logs of the second finger, one for each of --logs, for objects "
              "that are squeezed between two fingers");
DEFINE_string(out_dir, "",
              "folder for compliance.yaml, stiffness.csv, points.csv, "
              "compliance.svg");
DEFINE_string(direction_deg, "",
              "direction in which objects are pushed, from +x of frame S; "
              "default: that of the scene's spring, else estimated");
DEFINE_double(stage_std_mm, 0.02, "std of object_x_mm and object_y_mm");
DEFINE_int32(most_degree, 3,
             "highest degree of the force law; 1: straight lines");
DEFINE_string(from_N, "",
              "stiffness is compared from this force on; default: 20 % of the "
              "largest force that all trials reach");
DEFINE_string(to_N, "",
              "stiffness is compared up to this force; default: 80 %");
DEFINE_double(least_order_confidence, 0,
              "exit with code 4 if the whole order is right with a lower "
              "probability");
DEFINE_bool(plots, true, "draw compliance.svg and compliance.png");

namespace {

using namespace finray;

std::optional<double> NumberOrNothing(const char* flag,
                                      const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::optional<double> value = ParseNumber(text);
  if (!value) {
    throw UsageError(std::string("--") + flag + ": expected a number, found '" +
                     text + "'");
  }
  return value;
}

ComplianceSettings Settings() {
  ComplianceSettings settings;
  settings.stage_std_mm = FLAGS_stage_std_mm;
  settings.most_degree = FLAGS_most_degree;
  settings.from_N = NumberOrNothing("from_N", FLAGS_from_N);
  settings.to_N = NumberOrNothing("to_N", FLAGS_to_N);
  if (const auto degrees =
          NumberOrNothing("direction_deg", FLAGS_direction_deg)) {
    settings.direction_rad = *degrees * M_PI / 180;
  }
  if (!(FLAGS_stage_std_mm > 0) || !std::isfinite(FLAGS_stage_std_mm)) {
    throw UsageError("--stage_std_mm: expected a number above 0");
  }
  if (FLAGS_most_degree < 1 || FLAGS_most_degree > 5) {
    throw UsageError("--most_degree: expected 1 to 5");
  }
  if (!(FLAGS_least_order_confidence >= 0 &&
        FLAGS_least_order_confidence <= 1)) {
    throw UsageError("--least_order_confidence: expected 0 to 1");
  }
  return settings;
}

std::vector<ComplianceLog> ReadLogs(const Scene& scene,
                                    std::vector<std::string>* inputs) {
  const auto expand = [&](const std::string& list) {
    const auto paths = ExpandLogs(SplitList(list), FLAGS_out_dir);
    inputs->insert(inputs->end(), paths.begin(), paths.end());
    return paths;
  };
  const auto first = expand(Required("logs", FLAGS_logs));
  std::vector<std::string> second;
  if (!FLAGS_second_logs.empty()) {
    second = expand(FLAGS_second_logs);
    if (second.size() != first.size()) {
      throw InputError("--second_logs: has " + std::to_string(second.size()) +
                       " logs, --logs " + std::to_string(first.size()) +
                       "; each log of one finger needs one of the other");
    }
  }
  std::vector<ComplianceLog> logs;
  for (std::size_t i = 0; i < first.size(); ++i) {
    ComplianceLog& log = logs.emplace_back();
    // The name ends at the first dot: cup.left.csv is the log of a cup.
    log.name = std::filesystem::path(first[i]).filename().string();
    log.name = log.name.substr(0, log.name.find('.', 1));
    log.tables.push_back(FrameTable::Read(first[i], scene.columns));
    if (!second.empty()) {
      log.tables.push_back(FrameTable::Read(second[i], scene.columns));
    }
  }
  return logs;
}

void PrintSummary(const Compliance& found) {
  std::printf("%s\n", OutPath("compliance.yaml").c_str());
  std::size_t points = 0, rows = 0, standing = 0, left_out = 0;
  for (const ComplianceTrial& trial : found.trials) {
    points += trial.fit.points;
    standing += trial.fit.standing;
    left_out += trial.fit.left_out.size();
    rows += trial.rows;
  }
  std::printf(
      "points         %zu of %zu rows in %zu trials; left out: %zu because "
      "the slider stood, %zu because they contradict the others\n",
      points, rows, found.trials.size(), standing, left_out);
  std::printf("compared       from %.3g to %.3g N\n", found.from_N, found.to_N);
  for (std::size_t i = 0; i < found.objects.size(); ++i) {
    const ObjectStiffness& object = found.objects[i];
    std::printf("%-14s %.4g +- %.2g N/mm", object.name.c_str(),
                object.mean.N_per_mm,
                std::hypot(object.mean.std, object.calibration_std));
    if (i < found.pair_confidence.size()) {
      std::printf(", stiffer than the next with %.4g %%",
                  100 * found.pair_confidence[i]);
    }
    std::printf("\n");
  }
  if (found.objects.size() > 1) {
    std::printf("whole order    right with %.4g %%\n",
                100 * found.order_confidence);
  }
}

int Run() {
  std::vector<ComplianceFinger> fingers = {
      {ReadFinger(Required("finger", FLAGS_finger)),
       FLAGS_scene.empty() ? Scene() : ReadScene(FLAGS_scene)}};
  const Scene scene = fingers[0].scene;
  const Discretization discretization = DiscretizationFlags();
  if (DumpConfigFlag(fingers[0].finger, scene, discretization)) return kGood;
  Required("logs", FLAGS_logs);
  Required("out_dir", FLAGS_out_dir);
  if (FLAGS_second_logs.empty() && !FLAGS_second_finger.empty()) {
    throw UsageError("--second_finger needs --second_logs");
  }
  const ComplianceSettings settings = Settings();
  std::vector<std::string> inputs = {FLAGS_finger};
  for (const std::string& path : {FLAGS_scene, scene.columns.path}) {
    if (!path.empty()) inputs.push_back(path);
  }
  if (!FLAGS_second_logs.empty()) {
    fingers.push_back(ComplianceFinger(fingers[0]));
    if (!FLAGS_second_finger.empty()) {
      fingers[1].finger = ReadFinger(FLAGS_second_finger);
      inputs.push_back(FLAGS_second_finger);
    }
  }
  const std::vector<ComplianceLog> logs = ReadLogs(scene, &inputs);
  RefuseToOverwrite(inputs, {OutPath("points.csv"), OutPath("stiffness.csv"),
                             OutPath("laws.csv"), OutPath("compliance.yaml")});
  const Compliance found =
      MeasureCompliance(logs, fingers, discretization, settings);

  MakeFolder(FLAGS_out_dir);
  WriteFileAtomically(OutPath("points.csv"), PointCsv(found));
  WriteFileAtomically(OutPath("stiffness.csv"), StiffnessCsv(found));
  WriteFileAtomically(OutPath("laws.csv"), LawCsv(found));
  WriteFileAtomically(OutPath("compliance.yaml"),
                      ComplianceYaml(found, inputs));
  PrintSummary(found);
  Warn(FrictionWarnings(fingers[0].finger, scene));
  if (!FLAGS_second_finger.empty()) {
    Warn(FrictionWarnings(fingers[1].finger, scene));
  }
  if (FLAGS_plots) {
    const std::string problem =
        RunPythonScript("scripts/perception/plot_compliance.py",
                        {FLAGS_out_dir}, "python3-matplotlib");
    if (!problem.empty()) Warn("no plots", problem);
  }
  return found.order_confidence < FLAGS_least_order_confidence ? kGateFailed
                                                               : kGood;
}

}  // namespace

const finray::App finray::kApp = {
    "Measures the stiffness of yielding objects and sorts them.\n"
    "finray_compliance --finger F.yaml --scene S.yaml --logs 'runs/*.csv' "
    "--out_dir D [--second_logs 'other/*.csv']",
    Run};
