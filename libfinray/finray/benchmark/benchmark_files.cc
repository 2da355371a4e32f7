#include "finray/benchmark/benchmark_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "finray/benchmark/json_emitter.h"
#include "finray/benchmark/pareto.h"
#include "finray/benchmark/recommendation.h"
#include "finray/benchmark/statistics.h"
#include "finray/io/csv_cells.h"
#include "finray/io/number_text.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

// The numbers of a setting under their names in both files.
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

void WriteFacts(const char* key, const Facts& facts, JsonEmitter* json) {
  *json << YAML::Newline;
  json->Key(key);
  *json << YAML::BeginMap;
  for (const auto& [name, value] : facts) json->Pair(name.c_str(), value);
  *json << YAML::EndMap;
}

Facts ReadFacts(const YamlMap& map) {
  Facts facts;
  for (const std::string& name : map.Keys()) facts[name] = map.Text(name);
  return facts;
}

void WriteSettings(const std::vector<Measurement>& settings,
                   JsonEmitter* json) {
  json->Maps("settings", settings, [&](const Measurement& m) {
    json->Pair("id", m.name.id());
    json->Pair("task", m.name.task);
    json->Pair("scene", m.name.scene);
    json->Pair("solver", m.name.solver);
    json->Pair("how", m.name.how);
    json->Pair("words", m.words);
    json->Pair("family", m.family);
    if (!m.scheme.empty()) json->Pair("scheme", m.scheme);
    for (const NamedNumber& number : kNumbers) {
      json->Pair(number.name, number.of(m));
    }
    json->Pair("time_us", m.time_us);
    json->Pair("yardstick_us", m.yardstick_us);
  });
}

void WriteScaling(const Scaling& scaling, JsonEmitter* json) {
  *json << YAML::Newline;
  json->Key("scaling");
  *json << YAML::BeginMap;
  const auto batch = [&](const BatchScaling& one) {
    const double median = Median(one.seconds);
    json->Pair("frames", one.frames);
    json->Pair("threads", one.threads);
    json->Pair("median_s", median);
    json->Pair("frames_per_s", one.frames / median);
    json->Pair("seconds", one.seconds);
  };
  json->Maps("frames", scaling.frames, batch);
  json->Maps("threads", scaling.threads, batch);
  *json << YAML::EndMap;
}

void WriteConclusions(const std::vector<Measurement>& settings,
                      JsonEmitter* json) {
  json->Maps("pareto", ParetoFronts(settings), [&](const SceneFront& front) {
    std::vector<std::string> ids;
    for (const std::size_t i : front.front) {
      ids.push_back(settings[i].name.id());
    }
    json->Pair("task", front.task);
    json->Pair("scene", front.scene);
    json->Pair("front", ids);
  });
  json->Maps("recommended", Recommend(settings), [&](const Recommendation& r) {
    json->Pair("use", r.use);
    json->Pair("id", r.id);
    json->Pair("why", r.why);
    json->Pair("limit_us", r.limit_us);
    json->Pair("time_us", r.time_us);
    json->Pair("margin", r.margin());
    json->Pair("contact_error_mm", r.error_mm);
  });
  json->Maps("defaults", CheckDefaults(settings), [&](const DefaultCheck& c) {
    json->Pair("id", c.id);
    json->Pair("holds", c.holds());
    json->Pair("on_front", c.on_front());
    json->Pair("dominated_by", c.dominated_by);
    json->Pair("faster_and_more_accurate", c.better);
    json->Pair("rival", c.rival);
    json->Pair("rival_time", c.rival_time);
    json->Pair("rival_interval", std::vector<double>{c.rival_interval.low,
                                                     c.rival_interval.high});
  });
}

}  // namespace

std::string BenchmarkJson(const BenchmarkRun& run) {
  JsonEmitter json;
  json << YAML::BeginMap;
  json.Pair("schema_version", 1);
  json.Pair("tool", "finray_benchmark");
  json.Pair("quick", run.quick);
  json.Pair("rounds", run.rounds);
  json.Pair("date", run.date);
  json.Pair("command", run.command);
  WriteFacts("finger",
             {{"name", run.finger_name},
              {"path", run.finger_path},
              {"sha256", run.finger_sha256}},
             &json);
  json.Pair("reference", run.reference);
  WriteFacts("machine", run.machine, &json);
  WriteFacts("build", run.build, &json);
  WriteSettings(run.settings, &json);
  json.Maps("peers", run.peers, [&](const PeerStatus& peer) {
    json.Pair("name", peer.name);
    json.Pair("version", peer.version);
    json.Pair("skipped", peer.skipped);
  });
  WriteScaling(run.scaling, &json);
  WriteConclusions(run.settings, &json);
  json << YAML::EndMap;
  return std::string(json.c_str()) + "\n";
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
  // JSON is YAML, and the YAML reader names the place of an error.
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
  run.machine = ReadFacts(top.Map("machine"));
  run.build = ReadFacts(top.Map("build"));
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
