#include <cmath>
#include <vector>

#include "finray/calib/analysis/validation.h"
#include "finray/calib/report/yaml_rows.h"
#include "finray/io/versions.h"

namespace finray {

FrameTable ValidationFrames(const CalibrationLogs& logs,
                            const Validation& validation, double friction) {
  std::vector<std::size_t> of_finger;
  for (std::size_t i = 0; i < logs.frames.size(); ++i) {
    if (!logs.frames[i].IsBench()) of_finger.push_back(i);
  }
  FrameTable table(of_finger.size());
  for (const char* name : {"log", "kind"}) table.MutableText(name);
  for (const char* name :
       {"row", "time_s", "reference_force_N", "reference_contact_mm", "force_N",
        "force_std_N", "force_error_N", "contact_1_mm", "contact_1_std_mm",
        "contact_error_mm", "chi2_p_value"}) {
    table.MutableNumbers(name);
  }
  const bool compared = validation.baseline_errors.has_value();
  if (compared) {
    for (const char* name :
         {"baseline_force_error_N", "baseline_contact_error_mm"}) {
      table.MutableNumbers(name);
    }
  }
  table.MutableText("status");
  for (std::size_t row = 0; row < of_finger.size(); ++row) {
    const std::size_t i = of_finger[row];
    const CalibrationFrame& frame = logs.frames[i];
    const FrameReference& reference = validation.references[i];
    const FrameEstimate& found = validation.estimates[i];
    const auto set = [&](const char* name, double value) {
      table.MutableNumbers(name)[row] = value;
    };
    table.MutableText("log")[row] = logs.paths[frame.log];
    table.MutableText("kind")[row] = frame.contact ? "contact" : "free";
    table.MutableText("status")[row] = StatusName(found.status);
    const double force = EstimatedForce(found, friction);
    set("row", frame.row + 1);
    set("time_s", frame.time_s);
    set("reference_force_N", reference.force_N);
    set("reference_contact_mm", reference.contact_mm);
    set("force_N", force);
    // The std of the sum of two contacts is not known.
    set("force_std_N", found.contacts == 1 ? EstimatedForceStd(found, friction)
                                           : std::nan(""));
    set("force_error_N", force - reference.force_N);
    set("contact_1_mm", found.contact[0].arc_mm);
    set("contact_1_std_mm", found.contact[0].arc_std_mm);
    set("contact_error_mm", found.contact[0].arc_mm - reference.contact_mm);
    set("chi2_p_value", found.p_value());
    if (!compared) continue;
    const FrameEstimate& before = validation.baseline[i];
    set("baseline_force_error_N",
        EstimatedForce(before, friction) - reference.force_N);
    set("baseline_contact_error_mm",
        before.contact[0].arc_mm - reference.contact_mm);
  }
  return table;
}

std::string ValidationYaml(const CalibrationLogs& logs,
                           const Validation& validation,
                           const std::vector<Gate>& gates,
                           const ValidationInputs& inputs) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  YamlPair(&yaml, "schema_version", 1);
  EmitVerdict(&yaml, gates);
  EmitGates(&yaml, gates);
  EmitErrorTable("errors", validation.errors, &yaml);
  if (validation.baseline_errors) {
    EmitErrorTable("baseline", *validation.baseline_errors, &yaml);
  }
  if (!validation.stages.empty()) {
    EmitSeq(&yaml, "stages", validation.stages, [&](const FittedStage& stage) {
      yaml << YAML::Flow << YAML::BeginMap;
      YamlPairs(&yaml, "log", logs.paths[stage.log], "origin_x_mm",
                stage.origin_mm.x(), "origin_y_mm", stage.origin_mm.y(),
                "origin_x_std_mm", stage.origin_std_mm.x(), "origin_y_std_mm",
                stage.origin_std_mm.y());
      if (stage.rotation_std_deg > 0) {
        YamlPairs(&yaml, "rotation_deg", stage.rotation_deg, "rotation_std_deg",
                  stage.rotation_std_deg);
      }
      yaml << YAML::EndMap;
    });
  }
  BeginMap(&yaml, "inputs");
  const std::pair<const char*, const std::string*> named[] = {
      {"finger", &inputs.finger_path},
      {"baseline", &inputs.baseline_path},
      {"plan_or_scene", &inputs.plan_path},
      {"columns", &inputs.columns_path}};
  for (const auto& [key, path] : named) {
    if (!path->empty()) EmitFile(&yaml, key, *path);
  }
  EmitSeq(&yaml, "logs", logs.paths,
          [&](const std::string& path) { EmitFile(&yaml, path); });
  yaml << YAML::EndMap;
  YamlPairs(&yaml, "command", inputs.command, "version", FINRAY_VERSION);
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace finray
