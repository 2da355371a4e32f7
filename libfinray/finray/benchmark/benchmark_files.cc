#include "finray/benchmark/benchmark_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "finray/benchmark/json_writer.h"
#include "finray/benchmark/pareto.h"
#include "finray/benchmark/recommendation.h"
#include "finray/benchmark/statistics.h"
#include "finray/io/csv_cells.h"
#include "finray/io/number_text.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

// The numbers of a setting by the names they have in both files.
struct NamedNumber {
  const char* name;
  double (*of)(const Measurement&);
};

constexpr NamedNumber kNumbers[] = {
    {"links", [](const Measurement& m) -> double { return m.links; }},
    {"resolution", [](const Measurement& m) -> double { return m.resolution; }},
    {"unknowns", [](const Measurement& m) -> double { return m.unknowns; }},
    {"frames", [](const Measurement& m) -> double { return m.frames; }},
    {"solved_percent", [](const Measurement& m) { return m.solved_percent; }},
    {"iterations", [](const Measurement& m) { return m.iterations; }},
    {"contact_error_mm",
     [](const Measurement& m) { return m.errors.contact_mm; }},
    {"normal_error_N", [](const Measurement& m) { return m.errors.normal_N; }},
    {"normal_error_percent",
     [](const Measurement& m) { return m.errors.normal_percent; }},
    {"tip_error_mm", [](const Measurement& m) { return m.errors.tip_mm; }},
    {"gauges_error_rad",
     [](const Measurement& m) { return m.errors.gauges_rad; }},
    {"median_us", [](const Measurement& m) { return m.median_us(); }},
    {"quartile_1_us",
     [](const Measurement& m) { return Quantile(m.time_us, 0.25); }},
    {"quartile_3_us",
     [](const Measurement& m) { return Quantile(m.time_us, 0.75); }},
    {"median_over_yardstick",
     [](const Measurement& m) { return Median(m.ratios()); }},
    {"quartile_1_over_yardstick",
     [](const Measurement& m) { return m.ratio(); }},
    {"slow_frame_us", [](const Measurement& m) { return m.slow_frame_us; }},
    {"allocations", [](const Measurement& m) { return m.allocations; }},
    {"allocated_bytes", [](const Measurement& m) { return m.bytes; }},
    {"setup_bytes", [](const Measurement& m) { return m.setup_bytes; }},
};

void WriteMachine(const BenchmarkRun& run, JsonWriter* json) {
  const Machine& machine = run.machine;
  json->Open("machine", '{').Text("cpu", machine.cpu);
  json->Number("cores", machine.cores).Text("caches", machine.caches);
  json->Text("governor", machine.governor);
  json->Text("instruction_set", machine.instruction_set);
  json->Text("system", machine.system).Close();
  const Build& build = run.build;
  json->Open("build", '{').Text("version", build.version);
  json->Text("git", build.git).Text("compiler", build.compiler);
  json->Text("flags", build.flags).Text("ceres", build.ceres);
  json->Text("eigen", build.eigen).Close();
}

void WriteSetting(const Measurement& m, JsonWriter* json) {
  json->Open('{').Text("id", m.name.id()).Text("task", m.name.task);
  json->Text("scene", m.name.scene).Text("solver", m.name.solver);
  json->Text("how", m.name.how).Text("words", m.words);
  json->Text("family", m.family);
  if (!m.scheme.empty()) json->Text("scheme", m.scheme);
  for (const NamedNumber& number : kNumbers) {
    json->Number(number.name, number.of(m));
  }
  json->Numbers("time_us", m.time_us).Numbers("yardstick_us", m.yardstick_us);
  json->Close();
}

void WriteScaling(const Scaling& scaling, JsonWriter* json) {
  json->Open("scaling", '{');
  json->Open("links", '[');
  for (const LinkScaling& one : scaling.links) {
    json->Open('{').Text("solver", one.solver).Numbers("links", one.links);
    json->Numbers("time_us", one.time_us).Number("exponent", one.exponent);
    json->Close();
  }
  json->Close();
  const auto batches = [&](const char* key,
                           const std::vector<BatchScaling>& all) {
    json->Open(key, '[');
    for (const BatchScaling& batch : all) {
      const double median = Median(batch.seconds);
      json->Open('{').Number("frames", batch.frames);
      json->Number("threads", batch.threads).Number("median_s", median);
      json->Number("frames_per_s", batch.frames / median);
      json->Numbers("seconds", batch.seconds).Close();
    }
    json->Close();
  };
  batches("frames", scaling.frames);
  batches("threads", scaling.threads);
  json->Close();
}

void WriteConclusions(const std::vector<Measurement>& settings,
                      JsonWriter* json) {
  json->Open("pareto", '[');
  for (const SceneFront& front : ParetoFronts(settings)) {
    std::vector<std::string> ids;
    for (const std::size_t i : front.front) {
      ids.push_back(settings[i].name.id());
    }
    json->Open('{').Text("task", front.task).Text("scene", front.scene);
    json->Texts("front", ids).Close();
  }
  json->Close();
  json->Open("recommended", '[');
  for (const Recommendation& r : Recommend(settings)) {
    json->Open('{').Text("use", r.use).Text("id", r.id).Text("why", r.why);
    json->Number("limit_us", r.limit_us).Number("time_us", r.time_us);
    json->Number("margin", r.margin).Number("contact_error_mm", r.error_mm);
    json->Close();
  }
  json->Close();
  json->Open("defaults", '[');
  for (const DefaultCheck& check : CheckDefaults(settings)) {
    json->Open('{').Text("id", check.id).Boolean("holds", check.holds());
    json->Boolean("on_front", check.on_front);
    json->Texts("dominated_by", check.dominated_by);
    json->Texts("faster_and_more_accurate", check.better);
    json->Text("rival", check.rival).Number("rival_time", check.rival_time);
    json->Numbers("rival_interval",
                  {check.rival_interval.low, check.rival_interval.high});
    json->Close();
  }
  json->Close();
}

}  // namespace

std::string BenchmarkJson(const BenchmarkRun& run) {
  JsonWriter json;
  json.Open('{').Number("schema_version", 1).Text("tool", "finray_benchmark");
  json.Boolean("quick", run.quick).Number("rounds", run.rounds);
  json.Text("date", run.date).Text("command", run.command);
  json.Open("finger", '{').Text("name", run.finger_name);
  json.Text("path", run.finger_path).Text("sha256", run.finger_sha256).Close();
  json.Text("reference", run.reference);
  WriteMachine(run, &json);
  json.Open("settings", '[');
  for (const Measurement& m : run.settings) WriteSetting(m, &json);
  json.Close();
  json.Open("peers", '[');
  for (const PeerStatus& peer : run.peers) {
    json.Open('{').Text("name", peer.name).Text("version", peer.version);
    json.Text("skipped", peer.skipped).Close();
  }
  json.Close();
  WriteScaling(run.scaling, &json);
  WriteConclusions(run.settings, &json);
  json.Close();
  return json.text();
}

std::string BenchmarkCsv(const BenchmarkRun& run) {
  std::string csv = "id,task,scene,solver,how,words";
  for (const NamedNumber& number : kNumbers) {
    csv += std::string(",") + number.name;
  }
  csv += ",pareto\n";
  std::vector<bool> on_front(run.settings.size());
  for (const SceneFront& front : ParetoFronts(run.settings)) {
    for (const std::size_t i : front.front) on_front[i] = true;
  }
  for (std::size_t i = 0; i < run.settings.size(); ++i) {
    const Measurement& m = run.settings[i];
    for (const std::string& text : {m.name.id(), m.name.task, m.name.scene,
                                    m.name.solver, m.name.how, m.words}) {
      AppendCsvText(text, &csv);
      csv += ',';
    }
    for (const NamedNumber& number : kNumbers) {
      const double value = number.of(m);
      if (std::isfinite(value)) csv += NumberText(value);
      csv += ',';
    }
    csv += on_front[i] ? "1\n" : "0\n";
  }
  return csv;
}

BenchmarkRun ReadBenchmark(const std::string& path) {
  std::string file = path;
  if (std::filesystem::is_directory(path)) file += "/benchmark.json";
  // JSON is YAML, and messages have their places.
  const YamlMap top = YamlMap::FromFile(file);
  top.Choice("tool", {"finray_benchmark"});
  if (top.Integer("schema_version") != 1) {
    top.Fail("schema_version", "schema_version: expected 1");
  }
  BenchmarkRun run;
  run.quick = top.Boolean("quick", false);
  run.rounds = top.Integer("rounds");
  run.date = top.Text("date");
  const YamlMap finger = top.Map("finger");
  run.finger_name = finger.Text("name");
  run.finger_sha256 = finger.Text("sha256");
  const YamlMap machine = top.Map("machine");
  run.machine.cpu = machine.Text("cpu");
  run.machine.instruction_set = machine.Text("instruction_set");
  const YamlMap build = top.Map("build");
  run.build.version = build.Text("version");
  run.build.git = build.Text("git");
  run.build.compiler = build.Text("compiler");
  run.build.flags = build.Text("flags");
  for (const YamlMap& map : top.Maps("settings")) {
    Measurement m;
    m.name = {map.Text("task"), map.Text("scene"), map.Text("solver"),
              map.Text("how")};
    m.words = map.Text("words");
    m.family = map.Text("family");
    m.solved_percent = map.NonNegativeNumber("solved_percent");
    const auto error = [&](const char* key) {
      return map.Has(key) ? map.NonNegativeNumber(key) : BenchmarkErrors::kNone;
    };
    m.errors = {error("contact_error_mm"), error("normal_error_N"),
                error("normal_error_percent"), error("tip_error_mm"),
                error("gauges_error_rad")};
    m.time_us = map.Numbers("time_us");
    m.yardstick_us = map.Numbers("yardstick_us");
    if (m.time_us.empty() || m.time_us.size() != m.yardstick_us.size()) {
      map.Fail("yardstick_us",
               "yardstick_us: expected as many numbers as time_us has, " +
                   std::to_string(m.time_us.size()) + ", and at least one");
    }
    run.settings.push_back(std::move(m));
  }
  return run;
}

}  // namespace finray
