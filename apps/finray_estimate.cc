// Estimates contact location and force in every frame of many logs, from their
// gauges.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "app.h"
#include "finray/batch/live_rows.h"
#include "finray/batch/log_job.h"
#include "finray/calib/analysis/gate.h"
#include "finray/io/atomic_file.h"
#include "finray/io/line_reader.h"
#include "finray/io/log_list.h"
#include "progress_bar.h"

DEFINE_string(finger, "", "finger YAML, best a calibrated one");
DEFINE_string(scene, "", "scene YAML; without it contacts: auto");
DEFINE_string(logs, "",
              "CSV logs with gauge_<j>_V, separated by commas: files, patterns "
              "('runs/*.csv'), lists (@list.txt)");
DEFINE_string(out_dir, "", "folder for <log>.frames.csv and summary.yaml");
DEFINE_string(logs_root, "",
              "folder above all logs: results lie in --out_dir as logs lie in "
              "it; without it all lie in --out_dir itself");
DEFINE_int32(threads, 0, "threads over frames; 0: all cores");
DEFINE_bool(resume, false, "keep finished logs, go on with interrupted ones");
DEFINE_string(solver, "fast",
              "fast, or ceres: the residual blocks of the calibration, which "
              "take every kind of measurement");
DEFINE_string(equilibrium, "reduced",
              "with --solver ceres: reduced (eliminated) or weighted (residual "
              "blocks)");
DEFINE_bool(
    joint, false,
    "solve all frames of a log together, with the gauge_offset_walk and "
    "the smoothing of the scene");
DEFINE_bool(strict, false,
            "fail if any frame is not_converged or bad_input, if more than 5 % "
            "of a log are unexplained or contradict its force_N, or if all its "
            "frames have a contact that nothing confirms");
DEFINE_double(most_unexplained_percent, 0,
              "gate: share of solved frames that the finger and its noise do "
              "not explain; default: none");
DEFINE_bool(keep_going, false,
            "leave out logs that are bad input, list them in summary.yaml");
DEFINE_bool(follow, false,
            "a log from standard input, each row at once to standard output");

namespace {

using namespace finray;

// SIGINT and SIGTERM ask to finish; a second signal ends the process at once.
volatile std::sig_atomic_t stop_requested = 0, stop_pipe = -1;

bool IsStopRequested() { return stop_requested != 0; }

// System calls go on after a signal with `flags` SA_RESTART.
void CatchStopSignals(int flags) {
  struct sigaction action = {};
  action.sa_handler = [](int) {
    stop_requested = 1;
    const int error = errno;
    if (stop_pipe >= 0 && write(stop_pipe, "", 1) < 0) errno = error;
  };
  action.sa_flags = flags | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

std::vector<LogJob> MakeJobs(const BatchSettings& settings) {
  const auto logs =
      ExpandLogs(SplitList(Required("logs", FLAGS_logs)), FLAGS_out_dir);
  const auto results = ResultPaths(logs, FLAGS_out_dir, FLAGS_logs_root);
  std::vector<LogJob> jobs;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    jobs.emplace_back(&settings, logs[i], results[i]);
  }
  return jobs;
}

// Checks all logs before anything is written. A bad log is an error, or goes to
// `bad` with --keep_going. Returns false if told to stop.
bool CheckAll(std::vector<LogJob>* jobs, std::vector<BadLog>* bad) {
  std::vector<LogJob> good;
  for (LogJob& job : *jobs) {
    try {
      if (!job.Check()) return false;
      good.push_back(std::move(job));
    } catch (const InputError& error) {
      if (!FLAGS_keep_going) throw;
      std::cerr << "finray_estimate: " << error.what() << "\n";
      bad->push_back({job.log(), error.what()});
    }
  }
  jobs->swap(good);
  return true;
}

void MakeFolders(const std::vector<LogJob>& jobs) {
  MakeFolder(FLAGS_out_dir);
  if (FLAGS_logs_root.empty()) return;
  for (const LogJob& job : jobs) {
    MakeFolder(std::filesystem::path(job.result()).parent_path().string());
  }
}

// The summaries of an earlier run would no longer be true of the folder.
void RemoveOldSummaries() {
  for (const char* name : {"summary.yaml", "summary.csv"}) {
    std::error_code missing;
    std::filesystem::remove(OutPath(name), missing);
  }
}

bool RunAll(FrameSolverPool* pool, std::vector<LogJob>* jobs) {
  for (LogJob& job : *jobs) {
    if (!job.Run(pool)) return false;
  }
  return true;
}

std::size_t Frames(const std::vector<LogJob>& jobs) {
  std::size_t frames = 0;
  for (const LogJob& job : jobs) frames += job.frames();
  return frames;
}

int Interrupted(const std::string& when) {
  std::cerr << "finray_estimate: interrupted " << when
            << "; the same command with --resume goes on from there\n";
  return kInterrupted;
}

void PrintSummary(const std::vector<LogJob>& jobs, const ProgressBar& bar) {
  const EstimationSummary all = Total(jobs);
  const double seconds = bar.seconds();
  std::printf("%s\n", OutPath("summary.yaml").c_str());
  std::printf("frames         %zu in %zu log%s, %.3g s", all.frames,
              jobs.size(), jobs.size() == 1 ? "" : "s", seconds);
  if (bar.done() > 0) {
    std::printf(", %.0f frames/s", static_cast<double>(bar.done()) / seconds);
  }
  if (bar.kept() > 0) std::printf(", %zu kept", bar.kept());
  std::printf("\nok             %zu, no_contact %zu\n",
              all.count(FrameStatus::kOk), all.count(FrameStatus::kNoContact));
  std::printf("unobservable   %zu, unexplained %zu\n",
              all.count(FrameStatus::kUnobservable), all.unexplained);
  std::printf("not solved     %zu not_converged, %zu bad_input\n",
              all.count(FrameStatus::kNotConverged),
              all.count(FrameStatus::kBadInput));
  if (all.force_compared > 0) {
    std::printf("force error    %g N rms, %g N at most, over %zu frames\n",
                all.force_rms_N(), all.force_max_N, all.force_compared);
  } else {
    std::printf(
        "force error    not known: no ok or no_contact frame with a force_N\n");
  }
}

FrameMethod ChosenMethod() {
  const auto choose = [](const char* flag, const std::string& value,
                         const std::string& a, const std::string& b) {
    if (value != a && value != b) {
      throw UsageError(std::string("--") + flag + ": expected " + a + " or " +
                       b + ", found '" + value + "'");
    }
    return value == b;
  };
  const bool ceres = choose("solver", FLAGS_solver, "fast", "ceres");
  const bool weighted =
      choose("equilibrium", FLAGS_equilibrium, "reduced", "weighted");
  if (weighted && !ceres) {
    throw UsageError("--equilibrium weighted goes with --solver ceres");
  }
  return !ceres     ? FrameMethod::kFast
         : weighted ? FrameMethod::kCeresWeighted
                    : FrameMethod::kCeresReduced;
}

// A scene can describe the offsets of a whole log. Only --joint can use that.
void CheckJoint(BatchSettings* settings) {
  if (settings->joint && settings->method != FrameMethod::kFast) {
    throw UsageError("--solver does not go with --joint, which uses Ceres");
  }
  if (settings->joint || !settings->scene.gauge_offset_walk) return;
  Warn("the scene's gauge_offset_walk is for --joint",
       "without it the offsets are the finger's");
  settings->scene.gauge_offset_walk.reset();
}

// Live rows go from one pipe to the other, so flags of batches mean nothing.
void RefuseBatchFlags() {
  for (const char* flag : {"logs", "logs_root", "out_dir", "resume", "threads",
                           "keep_going", "joint"}) {
    if (IsGiven(flag)) {
      throw UsageError(std::string("--") + flag + " does not go with --follow");
    }
  }
}

// Writes to standard output. Returns false if nobody reads the output, or if
// told to stop while it waits for a reader.
bool WriteLive(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(STDOUT_FILENO, text.data(), text.size());
    if (count >= 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EPIPE || (errno == EINTR && IsStopRequested())) {
      return false;
    } else if (errno != EINTR) {
      throw InputError(std::string("stdout: cannot be written: ") +
                       std::strerror(errno));
    }
  }
  return true;
}

void PrintLatency(const LatencyHistogram& latency) {
  const auto us = [&](double share) { return 1e-3 * latency.Quantile(share); };
  std::fprintf(stderr,
               "latency        p50 %.1f us, p99 %.1f us, p99.9 %.1f us, max "
               "%.1f us, over %llu frames\n",
               us(0.5), us(0.99), us(0.999),
               1e-3 * static_cast<double>(latency.max()),
               static_cast<unsigned long long>(latency.count()));
}

// Says how many searches the scene's limit has ended, if it has one.
void PrintEnded(const EstimationSummary& summary, const Scene& scene,
                std::FILE* out) {
  if (!scene.search_iteration_limit) return;
  std::fprintf(out, "searches       %zu ended by the scene's limit of %d\n",
               summary.search_ended, *scene.search_iteration_limit);
}

// Says whether all frames together keep the gate, and prints it.
bool KeepsGate(const EstimationSummary& all) {
  if (!IsGiven("most_unexplained_percent")) return true;
  const double percent =
      all.frames > all.unsolved()
          ? 100 * static_cast<double>(all.unexplained) /
                static_cast<double>(all.frames - all.unsolved())
          : std::nan("");
  const Gate gate{"most_unexplained_percent", FLAGS_most_unexplained_percent,
                  percent, percent <= FLAGS_most_unexplained_percent};
  std::fprintf(FLAGS_follow ? stderr : stdout, "gates          %s\n",
               GateWords({gate}).c_str());
  return gate.passed;
}

// Runs `finray_estimate --follow`: it reads a log from standard input and
// writes each row to standard output at once. It ends with its input, with a
// stop signal, or when nobody reads its output any more. Then it says how long
// the rows have taken, from having the whole line to having written its row.
int FollowInput(const BatchSettings& settings) {
  using Clock = std::chrono::steady_clock;
  constexpr char kSource[] = "stdin";
  std::signal(SIGPIPE, SIG_IGN);
  // A poll() on this pipe cannot miss the request to stop.
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) == 0) stop_pipe = ends[1];
  CatchStopSignals(0);
  LineReader lines = ReadPipe(STDIN_FILENO, ends[0], kSource);
  FrameEstimator estimator(settings.finger, settings.scene,
                           settings.discretization, settings.method);
  CsvLine header;
  do {
    if (!lines.Next()) {
      if (IsStopRequested()) return kGood;
      throw InputError(std::string(kSource) +
                       ": is empty, expected a header and rows");
    }
    header = lines.line();
  } while (!IsHeaderLine(&header));
  LiveRows rows(settings.finger, settings.scene, kSource, header, &estimator);
  LatencyHistogram latency;
  EstimationSummary summary;
  Warn(WarningsOf(settings.finger));
  bool open = WriteLive(rows.HeaderCsv());
  while (open && !IsStopRequested() && lines.Next()) {
    const Clock::time_point start = Clock::now();
    const std::string& row = rows.Next(lines.line());
    if (!rows.error().empty()) {
      if (FLAGS_strict) throw InputError(rows.error());
      std::cerr << "finray_estimate: " << rows.error() << "\n";
    }
    open = WriteLive(row);
    if (open) {
      const std::chrono::nanoseconds time = Clock::now() - start;
      latency.Add(static_cast<std::uint64_t>(time.count()));
    }
    summary.Add(rows.estimate(), settings.scene.friction_coefficient,
                rows.readings());
  }
  PrintLatency(latency);
  PrintEnded(summary, settings.scene, stderr);
  const std::vector<Warning> warnings =
      WarningsOf({{&summary, kSource}}, settings.finger);
  Warn(warnings);
  if (FLAGS_strict && summary.unsolved() > 0) return kSolveFailed;
  const bool kept = KeepsGate(summary);
  return kept && !(FLAGS_strict && FailsStrict(warnings, settings.scene))
             ? kGood
             : kGateFailed;
}

int Run() {
  if (FLAGS_follow) RefuseBatchFlags();
  BatchSettings settings(Required("finger", FLAGS_finger), FLAGS_scene,
                         DiscretizationFlags());
  settings.method = ChosenMethod();
  settings.joint = FLAGS_joint;
  CheckJoint(&settings);
  if (!FLAGS_follow) {
    Required("logs", FLAGS_logs);
    Required("out_dir", FLAGS_out_dir);
  }
  if (DumpConfigFlag(settings.finger, settings.scene,
                     settings.discretization)) {
    return kGood;
  }
  if (FLAGS_follow) return FollowInput(settings);
  settings.threads = Threads(FLAGS_threads);
  settings.resume = FLAGS_resume;
  settings.stop = IsStopRequested;
  CatchStopSignals(SA_RESTART);

  std::vector<LogJob> jobs = MakeJobs(settings);
  std::vector<BadLog> bad_logs;
  if (!CheckAll(&jobs, &bad_logs)) return Interrupted("before the first frame");
  FrameSolverPool pool(FrameSolvers(settings.finger, settings.scene,
                                    settings.discretization, settings.method));
  MakeFolders(jobs);
  RemoveOldSummaries();
  ProgressBar bar(Frames(jobs));
  settings.progress = [&bar](std::size_t frames, bool kept) {
    bar.Add(frames, kept);
  };
  const bool whole = RunAll(&pool, &jobs);
  bar.Clear();
  if (!whole) {
    return Interrupted("after " + std::to_string(bar.done() + bar.kept()) +
                       " of " + std::to_string(Frames(jobs)) + " frames");
  }

  BatchTable(settings, jobs).Write(OutPath("summary.csv"));
  WriteFileAtomically(OutPath("summary.yaml"),
                      BatchYaml(settings, jobs, bad_logs));
  PrintSummary(jobs, bar);
  const EstimationSummary all = Total(jobs);
  PrintEnded(all, settings.scene, stdout);
  const std::vector<Warning> warnings =
      WarningsOf(SummariesOf(jobs), settings.finger);
  Warn(WarningsOf(settings.finger));
  Warn(warnings);
  if (!bad_logs.empty()) return kBadInput;
  if (all.unsolved() == all.frames || (FLAGS_strict && all.unsolved() > 0)) {
    return kSolveFailed;
  }
  const bool kept = KeepsGate(all);
  return kept && !(FLAGS_strict && FailsStrict(warnings, settings.scene))
             ? kGood
             : kGateFailed;
}

}  // namespace

const finray::App finray::kApp = {
    "Contact location and force from the gauges of every frame.\n"
    "finray_estimate --finger F.yaml --logs 'runs/*.csv' --out_dir D "
    "[--scene S.yaml] [--resume] [--joint]\n"
    "sensor | finray_estimate --follow --finger F.yaml [--scene S.yaml] | "
    "consumer",
    Run};
