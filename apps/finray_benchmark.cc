// Measures speed and accuracy of every solver on this machine, and compares two
// such runs.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <set>

#include "app.h"
#include "count_allocations.h"
#include "finray/benchmark/benchmark_run.h"
#include "finray/benchmark/peers.h"
#include "finray/benchmark/recommendation.h"
#include "finray/benchmark/run_comparison.h"
#include "finray/io/atomic_file.h"
#include "finray/io/python_script.h"
#include "finray/io/resources.h"
#include "finray/io/sha256.h"
#include "progress_bar.h"

DEFINE_string(finger, "", "finger YAML; without it the paper's finger");
DEFINE_string(out_dir, "",
              "folder for benchmark.json, benchmark.csv, report.html");
DEFINE_bool(quick, false, "less than a minute: part of the log, few rounds");
DEFINE_string(only, "",
              "settings whose id contains one of these, separated by commas; "
              "without it all");
DEFINE_int32(threads, 0, "batches run on 1 .. this many; 0: all cores");
DEFINE_int32(rounds, 0, "repeats of every setting; 0: 9 if quick, else 15");
DEFINE_string(peers, "none",
              "other programs to measure too: none, auto (all that are "
              "installed), or some of scipy,octave,calculix,getfem,"
              "mujoco");
DEFINE_bool(calibration, false,
            "measure calibrations too: minutes, less with --quick");
DEFINE_string(compare, "",
              "A,B: compare two runs (folders or benchmark.json) instead");
DEFINE_double(most_slowdown_percent, 15,
              "--compare: a setting slower than this fails the gate");
DEFINE_bool(report, true, "render report.html");

namespace {

using namespace finray;

int Compare() {
  const std::vector<std::string> paths = SplitList(FLAGS_compare);
  if (paths.size() != 2) throw UsageError("--compare: expected two runs, A,B");
  if (!(FLAGS_most_slowdown_percent > 0)) {
    throw UsageError("--most_slowdown_percent: expected a number above 0");
  }
  const BenchmarkRun a = ReadBenchmark(paths[0]), b = ReadBenchmark(paths[1]);
  const BenchmarkComparison comparison =
      CompareRuns(a, b, FLAGS_most_slowdown_percent / 100);
  for (const std::string& difference : comparison.differences) {
    Warn("the runs differ in " + difference, "compare runs of the same kind");
  }
  std::printf("%-62s %6s %15s  %s\n", "time over the yardstick's, B / A",
              "ratio", "99 % interval", "verdict");
  for (const SettingComparison& one : comparison.settings) {
    std::printf(
        "%-62s %6.3f %6.3f .. %5.3f  %s%s%s\n", one.id.c_str(), one.ratio,
        one.interval.low, one.interval.high, SpeedVerdictName(one.speed),
        one.worse.empty() ? "" : "; less accurate: ", one.worse.c_str());
  }
  if (comparison.settings.empty()) {
    throw InputError(paths[1] + ": has no setting in common with " + paths[0]);
  }
  for (const std::string& id : comparison.only_a) {
    std::printf("%-62s only in A\n", id.c_str());
  }
  for (const std::string& id : comparison.only_b) {
    std::printf("%-62s only in B\n", id.c_str());
  }
  const double percent = FLAGS_most_slowdown_percent, band = 1 + percent / 100;
  std::vector<double> ratios;
  int within = 0;
  for (const SettingComparison& one : comparison.settings) {
    ratios.push_back(one.ratio);
    within += one.ratio <= band && one.ratio >= 1 / band;
  }
  std::printf(
      "settings       %zu in both: %d faster, %d slower, %d same (within %g "
      "%%), %d undecided; %d less accurate\n",
      ratios.size(), comparison.Count(SpeedVerdict::kFaster),
      comparison.Count(SpeedVerdict::kSlower),
      comparison.Count(SpeedVerdict::kSame), percent,
      comparison.Count(SpeedVerdict::kUndecided), comparison.CountWorse());
  std::printf("ratios         %.3f .. %.3f, median %.3f; %d within %g %%\n",
              Quantile(ratios, 0), Quantile(ratios, 1), Median(ratios), within,
              percent);
  std::printf("gate           %s\n", comparison.passes() ? "pass" : "FAIL");
  return comparison.passes() ? kGood : kGateFailed;
}

std::string UtcNow() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

std::vector<BenchmarkSetting> ChosenSettings(const Finger& finger) {
  std::vector<BenchmarkSetting> grid = BenchmarkGrid(finger, FLAGS_quick);
  const std::vector<std::string> only = SplitList(FLAGS_only);
  if (only.empty()) return grid;
  std::vector<BenchmarkSetting> chosen;
  for (BenchmarkSetting& setting : grid) {
    const std::string id = setting.name.id();
    if (std::any_of(only.begin(), only.end(), [&](const std::string& part) {
          return id.find(part) != std::string::npos;
        })) {
      chosen.push_back(std::move(setting));
    }
  }
  if (chosen.empty()) {
    throw InputError("--only: no setting's id contains '" + FLAGS_only +
                     "'; ids are like " + grid.front().name.id());
  }
  return chosen;
}

// Prints the times of ceres::Solve and of the paper's chain over that of the
// fast solver, which does the same for a frame with one contact.
void PrintRatios(const std::vector<Measurement>& all, const std::string& task,
                 const std::string& fast) {
  const auto find = [&](const std::string& setting) -> const Measurement* {
    for (const Measurement& m : all) {
      if (m.name.id() == task + "/one_contact/" + setting) return &m;
    }
    return nullptr;
  };
  const Measurement* ours = find(fast);
  if (ours == nullptr) return;
  const std::string how = "/" + ours->name.how;
  for (const char* solver : {"ceres_reduced", "ceres_weighted", "paper100"}) {
    const Measurement* other = find(solver + how);
    if (other == nullptr) continue;
    std::printf(
        "ratio          %s: %.3g us, %.3g times %s; l_c off by %.1e mm\n",
        other->name.id().c_str(), other->median_us(),
        other->ratio() / ours->ratio(), fast.c_str(), other->errors.contact_mm);
  }
}

// Says what is exact enough for the finger's own gauges.
void PrintNoise(const BenchmarkRun& run) {
  const NoiseFloor floor = FloorOf(run.noise, "one_contact");
  std::printf(
      "noise          %.2g rad of the gauges leaves %.2g mm of l_c and %.2g N "
      "of f_c (std, one contact)\n",
      floor.gauge_rad, floor.contact_mm, floor.normal_N);
  for (const EnoughSetting& one : EnoughAgainstNoise(run.settings, floor)) {
    if (one.id == one.default_id) {
      std::printf("enough         %s: nothing faster is\n", one.id.c_str());
      continue;
    }
    std::printf(
        "enough         %s: at your noise (%.2g rad) %s, is enough and %.2g "
        "times faster than the default (%.2f .. %.2f)\n",
        one.id.c_str(), floor.gauge_rad, one.words.c_str(), one.times_faster,
        one.interval.low, one.interval.high);
  }
}

void PrintSummary(const BenchmarkRun& run) {
  std::printf("%s\n", OutPath("benchmark.json").c_str());
  std::printf("settings       %zu, %d rounds; %s, %s\n", run.settings.size(),
              run.rounds, run.machine.at("cpu").c_str(),
              run.machine.at("instruction_set").c_str());
  for (const Recommendation& r :
       Recommend(run.settings, FloorOf(run.noise, "one_contact"))) {
    std::printf("%-14s %s", r.use.c_str(),
                r.id.empty() ? "nothing serves" : r.id.c_str());
    if (!r.id.empty()) {
      std::printf(", %.3g us, l_c off by %.1e mm", r.time_us, r.error_mm);
    }
    if (std::isfinite(r.margin())) std::printf(", margin %.0f", r.margin());
    std::printf("\n");
  }
  PrintNoise(run);
  for (const Latency& one : run.latencies) {
    std::printf(
        "live           finger %s, contacts: %s%s: p50 %.0f us, p99 %.0f us, "
        "p99.9 %.0f us, max %.0f us; %d of %d ok, %d ended\n",
        one.finger.c_str(), one.contacts.c_str(),
        one.iteration_limit ? (", search_iteration_limit: " +
                               std::to_string(*one.iteration_limit))
                                  .c_str()
                            : "",
        one.p50_us, one.p99_us, one.p999_us, one.max_us, one.ok, one.frames,
        one.ended);
  }
  PrintRatios(run.settings, "sensing", "default/alone");
  PrintRatios(run.settings, "estimation", "default/search");
  for (const DefaultCheck& check : CheckDefaults(run.settings)) {
    std::printf(
        "default        %s: %s; fastest with l_c as good: %s, %.2f of its time "
        "(%.2f .. %.2f)\n",
        check.id.c_str(),
        check.holds() ? "on the Pareto front, none is 20 % faster and more "
                        "accurate"
        : !check.on_front() ? "NOT on the Pareto front"
                            : "BEATEN",
        check.rival.empty() ? "none" : check.rival.c_str(), check.rival_time,
        check.rival_interval.low, check.rival_interval.high);
    for (const std::string& id : check.dominated_by) {
      std::printf("               dominated by %s\n", id.c_str());
    }
    for (const std::string& id : check.better) {
      std::printf("               20 %% faster and more accurate: %s\n",
                  id.c_str());
    }
  }
  for (const PeerStatus& peer : run.peers) {
    std::printf("peer           %s %s\n", peer.name.c_str(),
                peer.skipped.empty() ? peer.version.c_str()
                                     : ("skipped: " + peer.skipped).c_str());
  }
}

// Calibrates with the finray_calibrate beside this program.
void MeasureCalibrations() {
  std::vector<std::string> arguments = {
      std::filesystem::read_symlink("/proc/self/exe").parent_path().string(),
      OutPath("calibration.json")};
  if (FLAGS_quick) arguments.push_back("210");
  const std::string problem =
      RunPythonScript("scripts/studies/calibration_speed.py", arguments,
                      "finray_calibrate, finray_simulate and python3-yaml");
  if (!problem.empty()) Warn("no calibration.json", problem);
}

int Measure() {
  if (FLAGS_finger.empty()) {
    FLAGS_finger = ResourcePath("configs/fingers/paper_140mm.yaml");
  }
  const Finger finger = ReadFinger(FLAGS_finger);
  Required("out_dir", FLAGS_out_dir);
  if (FLAGS_rounds < 0) throw UsageError("--rounds: expected 0 or more");
  const std::vector<std::string> peers = ParsePeers(FLAGS_peers);
  if (finger.gauges.size() < 4) {
    throw InputError(FLAGS_finger +
                     ": the benchmark senses up to two contacts and needs 4 "
                     "gauges; '" +
                     finger.name + "' has " +
                     std::to_string(finger.gauges.size()));
  }
  const std::vector<BenchmarkSetting> grid = ChosenSettings(finger);
  MakeFolder(FLAGS_out_dir);

  BenchmarkRun run;
  run.quick = FLAGS_quick;
  run.date = UtcNow();
  run.command = CommandWith({"finger", "out_dir", "quick", "only", "rounds",
                             "threads", "peers", "calibration"});
  run.finger = {{"name", finger.name},
                {"path", FLAGS_finger},
                {"sha256", Sha256OfFile(FLAGS_finger)}};
  run.machine = ThisMachine();
  run.build = ThisBuild();
  const Discretization finest = ReferenceDiscretization(finger);
  run.reference = SchemeName(finest.scheme) + ", order 16, " +
                  std::to_string(finest.resolution) + " elements";

  // Batches need one contact; peers need that and friction.
  std::set<std::string> scenes = {"one_contact"};
  if (!peers.empty()) scenes.insert("friction");
  for (const BenchmarkSetting& one : grid) scenes.insert(one.name.scene);
  std::vector<BenchmarkCase> cases;
  for (const std::string& scene : scenes) {
    cases.push_back(MakeBenchmarkCase(finger, scene));
    run.noise.push_back(NoiseFloorOf(finger, cases.back()));
  }
  {
    MeasuringOptions options;
    options.rounds = FLAGS_rounds > 0 ? FLAGS_rounds : FLAGS_quick ? 9 : 15;
#ifdef FINRAY_COUNTS_ALLOCATIONS
    options.allocations = [] {
      return AllocationCount{static_cast<double>(allocations),
                             static_cast<double>(allocated_bytes)};
    };
#endif
    ProgressBar bar(grid.size() * static_cast<std::size_t>(options.rounds + 1));
    options.progress = [&bar] { bar.Add(1, false); };
    run.rounds = options.rounds;
    run.settings = MeasureSettings(grid, cases, options);
  }
  const int threads = Threads(FLAGS_threads);
  run.scaling =
      MeasureBatches(CaseOf(cases, "one_contact"), FLAGS_quick ? 4096 : 65536,
                     threads, FLAGS_quick ? 3 : 7);
  run.latencies =
      MeasureLatencies(finger, FLAGS_quick ? 1000 : 20000, FLAGS_quick ? 1 : 2);
  for (const std::string& peer : peers) {
    MeasurePeer(peer, FLAGS_out_dir, finger, cases, &run);
  }

  std::filesystem::remove(OutPath("calibration.json"));  // of another run
  if (FLAGS_calibration) MeasureCalibrations();
  WriteFileAtomically(OutPath("benchmark.json"), BenchmarkJson(run));
  WriteFileAtomically(OutPath("benchmark.csv"), BenchmarkCsv(run));
  if (FLAGS_report) {
    const std::string problem =
        RunPythonScript("scripts/benchmark/render.py", {FLAGS_out_dir},
                        "python3-matplotlib and python3-jinja2");
    if (!problem.empty()) Warn("no report.html", problem);
  }
  PrintSummary(run);
  return kGood;
}

int Run() { return FLAGS_compare.empty() ? Measure() : Compare(); }

}  // namespace

const finray::App finray::kApp = {
    "Measures speed and accuracy of every solver, or compares two such "
    "runs.\n"
    "finray_benchmark --out_dir D [--finger F.yaml] [--quick] "
    "[--peers auto]\n"
    "finray_benchmark --compare A,B [--most_slowdown_percent 15]",
    Run};
