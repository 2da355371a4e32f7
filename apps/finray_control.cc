// Simulates force control: a drive presses a finger against an object, with the
// estimator in the loop.

#include <cstdio>
#include <set>

#include "app.h"
#include "finray/control/experiment.h"
#include "finray/control/run_experiment.h"
#include "finray/io/atomic_file.h"
#include "finray/io/sha256.h"
#include "finray/io/versions.h"
#include "finray/io/yaml_emitter.h"
#include "progress_bar.h"

DEFINE_string(finger, "",
              "finger YAML, the model of estimator and controllers; the "
              "simulated finger differs by the experiment's model_error");
DEFINE_string(experiment, "", "experiment YAMLs, separated by commas");
DEFINE_string(out_dir, "", "folder for logs and summary.yaml");
DEFINE_int32(draws, 0,
             "number of draws of finger and noise; 0: that of the experiment");
DEFINE_uint64(seed, 1, "seed of the first draw");
DEFINE_int32(threads, 0, "threads over draws and controllers; 0: all cores");
DEFINE_bool(dump_config, false, "print the settings in force and stop");
DEFINE_bool(
    strict, false,
    "exit with code 4 if a run was stopped or if the first controller's "
    "rms error is not below the paper's");

namespace {

using namespace finray;

constexpr int kDigits = 12;  // writes 0.1 + 0.2 as 0.3

struct Job {
  std::string path;
  Experiment experiment;
  std::vector<ControllerResult> results;
};

// Reads all experiments, so that an error shows before anything runs.
std::vector<Job> ReadJobs(const Finger& finger) {
  std::vector<Job> jobs;
  std::set<std::string> names;
  for (const std::string& path :
       SplitList(Required("experiment", FLAGS_experiment))) {
    jobs.push_back({path, ReadExperiment(path, finger), {}});
    Experiment& experiment = jobs.back().experiment;
    if (!names.insert(experiment.name).second) {
      throw InputError(path + ": another experiment is called '" +
                       experiment.name + "'; both would write the same files");
    }
    if (FLAGS_draws > 0) experiment.draws = FLAGS_draws;
  }
  if (jobs.empty()) throw UsageError("--experiment names no file");
  return jobs;
}

// The number of periods in all runs.
std::size_t Periods(const std::vector<Job>& jobs) {
  double periods = 0;
  for (const Job& job : jobs) {
    const Experiment& e = job.experiment;
    periods += e.duration_s / e.actuation.period_s * e.draws *
               static_cast<double>(e.controllers.size());
  }
  return static_cast<std::size_t>(periods);
}

void WriteLogs(const Finger& finger, const Job& job) {
  for (const ControllerResult& result : job.results) {
    const auto names = ControlLogNames(job.experiment, result.controller);
    for (std::size_t i = 0; i < names.size(); ++i) {
      ControlLog(finger, job.experiment, result.first, static_cast<int>(i))
          .Write(OutPath(names[i]));
    }
  }
}

void WriteSummary(const std::vector<Job>& jobs,
                  const Discretization& discretization) {
  YamlEmitter yaml(kDigits);
  yaml << YAML::BeginMap;
  YamlPairs(&yaml, "finger", FLAGS_finger, "scheme",
            SchemeName(discretization.scheme), "seed", FLAGS_seed, "version",
            FINRAY_VERSION);
  yaml << YAML::Key << "inputs" << YAML::Value << YAML::BeginMap;
  YamlPair(&yaml, FLAGS_finger, Sha256OfFile(FLAGS_finger));
  for (const Job& job : jobs) {
    YamlPair(&yaml, job.path, Sha256OfFile(job.path));
  }
  yaml << YAML::EndMap << YAML::Key << "experiments" << YAML::Value
       << YAML::BeginSeq;
  for (const Job& job : jobs) {
    EmitExperiment(job.path, job.experiment, job.results, &yaml);
  }
  yaml << YAML::EndSeq << YAML::EndMap;
  WriteFileAtomically(OutPath("summary.yaml"),
                      std::string(yaml.c_str()) + "\n");
}

void PrintTable(const std::vector<Job>& jobs) {
  std::printf("%s\n", OutPath("summary.yaml").c_str());
  std::printf("%-20s %-16s %8s %8s %8s %9s %9s %s\n", "experiment",
              "controller", "rms N", "max N", "paper N", "estimate", "settled",
              "stopped");
  for (const Job& job : jobs) {
    for (const ControllerResult& result : job.results) {
      const ControlStatistics& s = result.statistics;
      const bool controlled = s.control.count > 0;
      std::printf("%-20s %-16s %8.3f %8.3f ", job.experiment.name.c_str(),
                  result.controller.name.c_str(), s.errors().rms(),
                  s.errors().most);
      if (job.experiment.paper) {
        std::printf("%8.2f ", job.experiment.paper->rms_N);
      } else {
        std::printf("%8s ", "-");
      }
      std::printf("%9.3f ", s.estimate.rms());
      if (controlled) {
        std::printf("%9.3f %zu/%zu\n", s.settled.rms(), s.stopped_runs, s.runs);
      } else {
        std::printf("%9s -\n", "-");
      }
    }
  }
}

// Warns of runs that ended early. Returns the exit code.
int ExitCodeOf(const std::vector<Job>& jobs) {
  bool failed = false, misses = false;
  for (const Job& job : jobs) {
    for (const ControllerResult& result : job.results) {
      const ControlStatistics& s = result.statistics;
      misses |= s.stopped_runs > 0;
      if (s.failed_runs == 0) continue;
      failed = true;
      Warn(job.experiment.name + ", " + result.controller.name + ": " +
               std::to_string(s.failed_runs) + " of " + std::to_string(s.runs) +
               " runs ended early",
           s.failure);
    }
    const ErrorSums& first = job.results.front().statistics.errors();
    misses |=
        job.experiment.paper && !(first.rms() < job.experiment.paper->rms_N);
  }
  if (failed) return kSolveFailed;
  return FLAGS_strict && misses ? kGateFailed : kGood;
}

int Run() {
  const Finger finger = ReadFinger(Required("finger", FLAGS_finger));
  const Discretization discretization = DiscretizationFlags();
  if (FLAGS_draws < 0 || FLAGS_draws > Experiment::kMostDraws) {
    throw InputError("--draws: expected 0 to " +
                     std::to_string(Experiment::kMostDraws));
  }
  std::vector<Job> jobs = ReadJobs(finger);
  Required("out_dir", FLAGS_out_dir);
  if (FLAGS_dump_config) {
    for (const Job& job : jobs) {
      YamlEmitter yaml(kDigits);
      EmitSettings(job.experiment, &yaml);
      std::cout << "# " << job.path << "\n" << yaml.c_str() << "\n";
      DumpConfig(finger, job.experiment.scene, discretization);
    }
    return kGood;
  }
  ProgressBar bar(Periods(jobs));
  for (Job& job : jobs) {
    job.results =
        RunExperiment(finger, job.experiment, discretization, FLAGS_seed,
                      Threads(FLAGS_threads),
                      [&bar](std::size_t periods) { bar.Add(periods, false); });
  }
  bar.Clear();
  MakeFolder(FLAGS_out_dir);
  for (const Job& job : jobs) WriteLogs(finger, job);
  WriteSummary(jobs, discretization);
  PrintTable(jobs);
  return ExitCodeOf(jobs);
}

}  // namespace

const finray::App finray::kApp = {
    "Simulates force control with the estimator in the loop.\n"
    "finray_control --finger F.yaml --experiment E.yaml[,E2.yaml] "
    "--out_dir D [--seed 1] [--draws 10]",
    Run};
