#include "finray/benchmark/benchmark_run.h"

#include <ceres/version.h>
#include <sys/utsname.h>

#include <Eigen/Core>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "finray/benchmark/build.h"
#include "finray/benchmark/json_emitter.h"
#include "finray/benchmark/recommendation.h"
#include "finray/benchmark/statistics.h"
#include "finray/io/frame_table.h"
#include "finray/io/usable_cores.h"
#include "finray/io/versions.h"
#include "finray/io/yaml_map.h"
#include "finray/ladder/instruction_set.h"

namespace finray {
namespace {

std::string FirstLineOf(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string CpuModel() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0 || line.rfind("CPU part", 0) == 0) {
      const auto colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  }
  return "unknown";
}

std::string Caches() {
  std::string words;
  for (int i = 0; i < 8; ++i) {
    const std::string folder =
        "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(i) + "/";
    const std::string level = FirstLineOf(folder + "level");
    const std::string type = FirstLineOf(folder + "type");
    if (level.empty()) break;
    if (type == "Instruction") continue;
    words += (words.empty() ? "L" : ", L") + level +
             (type == "Data" ? "d " : " ") + FirstLineOf(folder + "size");
  }
  return words.empty() ? "unknown" : words;
}

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
    {"contact_rms_mm",
     [](const Measurement& m) { return m.errors.contact_rms_mm(); }},
    {"normal_rms_N",
     [](const Measurement& m) { return m.errors.normal_rms_N(); }},
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
  *json << YAML::Newline << YAML::Key << key << YAML::Value << YAML::BeginMap;
  for (const auto& [name, value] : facts) json->Pairs(name.c_str(), value);
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
    json->Pairs("id", m.name.id(), "task", m.name.task, "scene", m.name.scene,
                "solver", m.name.solver, "how", m.name.how, "words", m.words,
                "family", m.family);
    if (!m.scheme.empty()) json->Pairs("scheme", m.scheme);
    for (const NamedNumber& number : kNumbers) {
      json->Pairs(number.name, number.of(m));
    }
    json->Pairs("time_us", m.time_us, "yardstick_us", m.yardstick_us);
  });
}

void WriteScaling(const Scaling& scaling, JsonEmitter* json) {
  *json << YAML::Newline << YAML::Key << "scaling" << YAML::Value
        << YAML::BeginMap;
  const auto batch = [&](const BatchScaling& one) {
    const double median = Median(one.seconds);
    json->Pairs("frames", one.frames, "threads", one.threads, "median_s",
                median, "frames_per_s", one.frames / median, "seconds",
                one.seconds);
  };
  json->Maps("frames", scaling.frames, batch);
  json->Maps("threads", scaling.threads, batch);
  *json << YAML::EndMap;
}

void WriteConclusions(const BenchmarkRun& run, JsonEmitter* json) {
  const std::vector<Measurement>& settings = run.settings;
  const NoiseFloor floor = FloorOf(run.noise, "one_contact");
  json->Maps("pareto", ParetoFronts(settings), [&](const SceneFront& front) {
    std::vector<std::string> ids;
    for (const std::size_t i : front.front) {
      ids.push_back(settings[i].name.id());
    }
    json->Pairs("task", front.task, "scene", front.scene, "front", ids);
  });
  json->Maps("recommended", Recommend(settings, floor),
             [&](const Recommendation& r) {
               json->Pairs("use", r.use, "id", r.id, "why", r.why, "limit_us",
                           r.limit_us, "time_us", r.time_us, "margin",
                           r.margin(), "contact_error_mm", r.error_mm);
             });
  json->Pairs("share_of_noise", kShareOfNoise);
  json->Maps("enough", EnoughAgainstNoise(settings, floor),
             [&](const EnoughSetting& e) {
               json->Pairs(
                   "default", e.default_id, "id", e.id, "words", e.words,
                   "contact_rms_mm", e.contact_rms_mm, "normal_rms_N",
                   e.normal_rms_N, "times_faster", e.times_faster, "interval",
                   std::vector<double>{e.interval.low, e.interval.high});
             });
  json->Maps("defaults", CheckDefaults(settings), [&](const DefaultCheck& c) {
    json->Pairs(
        "id", c.id, "holds", c.holds(), "on_front", c.on_front(),
        "dominated_by", c.dominated_by, "faster_and_more_accurate", c.better,
        "rival", c.rival, "rival_time", c.rival_time, "rival_interval",
        std::vector<double>{c.rival_interval.low, c.rival_interval.high});
  });
}

}  // namespace

Facts ThisMachine() {
  const std::string governor =
      FirstLineOf("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  utsname name;
  const bool named = uname(&name) == 0;
  return {{"cpu", CpuModel()},
          {"cores", std::to_string(UsableCores())},
          {"caches", Caches()},
          {"governor", governor.empty() ? "unknown" : governor},
          {"instruction_set", InstructionSetName(0)},
          {"system", named ? std::string(name.sysname) + " " + name.release +
                                 " " + name.machine
                           : "unknown"}};
}

Facts ThisBuild() {
  return {{"version", FINRAY_VERSION},
          {"git", FINRAY_GIT},
          {"compiler", FINRAY_COMPILER},
          {"flags", FINRAY_FLAGS},
          {"ceres", CERES_VERSION_STRING},
          {"eigen", std::to_string(EIGEN_WORLD_VERSION) + "." +
                        std::to_string(EIGEN_MAJOR_VERSION) + "." +
                        std::to_string(EIGEN_MINOR_VERSION)}};
}

std::string BenchmarkJson(const BenchmarkRun& run) {
  JsonEmitter json;
  json << YAML::BeginMap;
  json.Pairs("schema_version", 1, "tool", "finray_benchmark", "quick",
             run.quick, "rounds", run.rounds, "date", run.date, "command",
             run.command);
  WriteFacts("finger", run.finger, &json);
  json.Pairs("reference", run.reference);
  WriteFacts("machine", run.machine, &json);
  WriteFacts("build", run.build, &json);
  json.Maps("noise", run.noise, [&](const NoiseFloor& floor) {
    json.Pairs("scene", floor.scene, "gauge_rad", floor.gauge_rad, "contact_mm",
               floor.contact_mm, "normal_N", floor.normal_N);
  });
  WriteSettings(run.settings, &json);
  json.Maps("peers", run.peers, [&](const PeerStatus& peer) {
    json.Pairs("name", peer.name, "version", peer.version, "skipped",
               peer.skipped);
  });
  WriteScaling(run.scaling, &json);
  json.Maps("latency", run.latencies, [&](const Latency& one) {
    json.Pairs("finger", one.finger, "contacts", one.contacts, "frames",
               one.frames, "p50_us", one.p50_us, "p99_us", one.p99_us,
               "p999_us", one.p999_us, "max_us", one.max_us, "ok", one.ok,
               "ended", one.ended, "most_iterations", one.most_iterations);
    if (one.iteration_limit) {
      json.Pairs("iteration_limit", *one.iteration_limit);
    }
  });
  WriteConclusions(run, &json);
  json << YAML::EndMap;
  return std::string(json.c_str()) + "\n";
}

std::string BenchmarkCsv(const BenchmarkRun& run) {
  FrameTable table(run.settings.size());
  for (std::size_t i = 0; i < run.settings.size(); ++i) {
    const Measurement& m = run.settings[i];
    const std::pair<const char*, std::string> texts[] = {
        {"id", m.name.id()},     {"task", m.name.task},
        {"scene", m.name.scene}, {"solver", m.name.solver},
        {"how", m.name.how},     {"words", m.words}};
    for (const auto& [name, text] : texts) table.MutableText(name)[i] = text;
    for (const NamedNumber& number : kNumbers) {
      table.MutableNumbers(number.name)[i] = number.of(m);
    }
    table.MutableNumbers("pareto")[i] = 0;
  }
  for (const SceneFront& front : ParetoFronts(run.settings)) {
    for (const std::size_t i : front.front) {
      table.MutableNumbers("pareto")[i] = 1;
    }
  }
  return table.ToCsv();
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
  run.finger = ReadFacts(top.Map("finger"));
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
      return map.Has(key) ? map.NonNegativeNumber(key) : kNaN;
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
