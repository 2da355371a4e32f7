#include "finray/batch/batch_summary.h"

#include "finray/io/number_text.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

EstimationSummary Total(const std::vector<LogJob>& jobs) {
  EstimationSummary all;
  for (const LogJob& job : jobs) all.Add(job.summary());
  return all;
}

std::string BatchYaml(const BatchSettings& settings,
                      const std::vector<LogJob>& jobs,
                      const std::vector<BadLog>& bad_logs) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  YamlPair(&yaml, "finger", settings.finger.name);
  YamlPair(&yaml, "scheme", SchemeName(settings.discretization.scheme));
  if (settings.method != FrameMethod::kFast) {
    YamlPair(&yaml, "solver",
             settings.joint ? "joint" : FrameMethodName(settings.method));
  }
  YamlPair(&yaml, "version", FINRAY_VERSION);
  yaml << YAML::Key << "logs" << YAML::Value << YAML::BeginSeq;
  for (const LogJob& job : jobs) {
    yaml << YAML::BeginMap;
    YamlPair(&yaml, "log", job.log());
    YamlPair(&yaml, "result", job.result());
    YamlPair(&yaml, "key", job.key());
    EmitSummary(job.summary(), &yaml);
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq << YAML::Key << "all" << YAML::Value << YAML::BeginMap;
  EmitSummary(Total(jobs), &yaml);
  yaml << YAML::EndMap;
  if (!bad_logs.empty()) {
    yaml << YAML::Key << "bad_logs" << YAML::Value << YAML::BeginSeq;
    for (const BadLog& bad : bad_logs) {
      yaml << YAML::BeginMap;
      YamlPair(&yaml, "log", bad.log);
      YamlPair(&yaml, "reason", bad.reason);
      yaml << YAML::EndMap;
    }
    yaml << YAML::EndSeq;
  }
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

FrameTable BatchTable(const std::vector<LogJob>& jobs) {
  FrameTable table(jobs.size());
  // The table has its columns even without any log.
  for (const char* name : {"log", "result", "frames"}) table.MutableText(name);
  for (const FrameStatus status : EstimationSummary::kStatuses) {
    table.MutableText(StatusName(status));
  }
  for (const char* name :
       {"force_compared_frames", "force_rms_error_N", "force_max_error_N",
        "force_squares_N2", "unexplained_frames", "key"}) {
    table.MutableText(name);
  }
  for (std::size_t row = 0; row < jobs.size(); ++row) {
    const LogJob& job = jobs[row];
    const EstimationSummary& summary = job.summary();
    const auto set = [&](const std::string& name, const std::string& text) {
      table.MutableText(name)[row] = text;
    };
    set("log", job.log());
    set("result", job.result());
    set("frames", std::to_string(summary.frames));
    for (const FrameStatus status : EstimationSummary::kStatuses) {
      set(StatusName(status), std::to_string(summary.count(status)));
    }
    const bool compared = summary.force_compared > 0;
    set("force_compared_frames", std::to_string(summary.force_compared));
    set("force_rms_error_N", compared ? NumberText(summary.force_rms_N()) : "");
    set("force_max_error_N", compared ? NumberText(summary.force_max_N) : "");
    set("force_squares_N2",
        compared ? NumberText(summary.force_squares_N2) : "");
    set("unexplained_frames", std::to_string(summary.unexplained));
    set("key", job.key());
  }
  return table;
}

}  // namespace finray
