// Estimates contact location and force in every frame of many logs, from their
// gauges.

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <future>
#include <optional>

#include "app.h"
#include "finray/batch/log_job.h"
#include "finray/calib/analysis/gate.h"
#include "finray/io/atomic_file.h"
#include "finray/io/log_list.h"
#include "finray/view/live_server.h"
#include "finray/view/view_files.h"
#include "follow_input.h"
#include "listen.h"
#include "progress_bar.h"

DEFINE_string(finger, "", "finger YAML, best a calibrated one");
DEFINE_string(scene, "", "scene YAML; without it contacts: auto");
DEFINE_string(logs, "",
              "CSV logs with gauge_<j>_V, separated by commas: files, folders, "
              "patterns ('runs/*.csv', 'runs/**'), lists (@list.txt)");
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
DEFINE_string(bad_rows, "error",
              "error, or skip: leave out rows that are bad input and list them "
              "in <log>.bad_rows.csv");
DEFINE_string(columns, "",
              "columns of the results, separated by commas, in this order; * "
              "stands for any text; default: all");
DEFINE_int32(digits, 0,
             "significant digits of computed numbers; 0: as many as read back "
             "the same");
DEFINE_bool(follow, false,
            "a log from standard input, each row at once to standard output");
DEFINE_bool(report, false,
            "write a page of each log beside its result, and index.html");
DEFINE_string(listen, "",
              "with --follow: clients of a socket in place of standard input, "
              "a session each: unix:PATH, PORT or ADDRESS:PORT (a PORT alone "
              "is of 127.0.0.1; 0: any free one)");
DEFINE_int32(serve, -1,
             "with --follow: port of a live page; 0: any free one; -1: none");
DEFINE_string(serve_address, "127.0.0.1",
              "address of the live page; any but this machine's own needs "
              "--serve_token");
DEFINE_string(serve_token, "",
              "the live page asks for it: http://...?token=...");
DEFINE_double(serve_rate_Hz, 20, "updates of the live page in a second");

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

// A result and the page beside it.
ViewJob PageOf(const LogJob& job) {
  const std::string folder =
      std::filesystem::path(job.result()).parent_path().string();
  return {job.result(), PagePath(job.result(), folder)};
}

std::vector<LogJob> MakeJobs(const BatchSettings& settings) {
  const auto logs =
      ExpandLogs(SplitList(Required("logs", FLAGS_logs)), FLAGS_out_dir);
  const auto results = ResultPaths(logs, FLAGS_out_dir, FLAGS_logs_root);
  std::vector<LogJob> jobs;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    jobs.emplace_back(&settings, logs[i], results[i]);
  }
  if (FLAGS_report) {
    std::vector<ViewJob> pages;
    for (const LogJob& job : jobs) pages.push_back(PageOf(job));
    RefuseSamePages(pages);
  }
  return jobs;
}

// Checks all logs before anything is written. A bad log is an error, or goes to
// `bad` and its job to `left_out` with --keep_going. Returns false if told to
// stop.
bool CheckAll(std::vector<LogJob>* jobs, std::vector<LogJob>* left_out,
              std::vector<BadLog>* bad) {
  std::vector<LogJob> good;
  for (LogJob& job : *jobs) {
    try {
      if (!job.Check()) return false;
      good.push_back(std::move(job));
    } catch (const InputError& error) {
      if (!FLAGS_keep_going) throw;
      std::cerr << "finray_estimate: " << error.what() << "\n";
      bad->push_back({job.log(), error.what()});
      left_out->push_back(std::move(job));
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

// The summaries and pages of an earlier run would no longer be true of the
// folder.
void RemoveOldSummaries(const std::vector<LogJob>& jobs) {
  for (const char* name : {"summary.yaml", "summary.csv"}) {
    std::error_code missing;
    std::filesystem::remove(OutPath(name), missing);
  }
  RemoveOldPage(OutPath("index.html"));
  for (const LogJob& job : jobs) RemoveOldPage(PageOf(job).page);
}

// No result stands under the name of a log that is left out.
void SetAside(const std::vector<LogJob>& left_out, std::vector<BadLog>* bad) {
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    RemoveOldPage(PageOf(left_out[i]).page);
    if (!left_out[i].SetAside()) continue;
    const std::string told =
        "the result of an earlier run is now " + left_out[i].result() + ".old";
    std::cerr << "finray_estimate: " << told << "\n";
    (*bad)[i].reason += "; " + told;
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
  if (all.bad_rows > 0) {
    std::printf(", %zu bad row%s left out", all.bad_rows,
                all.bad_rows == 1 ? "" : "s");
  }
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

// Says whether the value of a flag is `b`. It must be `a` or `b`.
bool IsSecond(const char* flag, const std::string& value, const std::string& a,
              const std::string& b) {
  if (value != a && value != b) {
    throw UsageError(std::string("--") + flag + ": expected " + a + " or " + b +
                     ", found '" + value + "'");
  }
  return value == b;
}

FrameMethod ChosenMethod() {
  const bool ceres = IsSecond("solver", FLAGS_solver, "fast", "ceres");
  const bool weighted =
      IsSecond("equilibrium", FLAGS_equilibrium, "reduced", "weighted");
  if (weighted && !ceres) {
    throw UsageError("--equilibrium weighted goes with --solver ceres");
  }
  return !ceres     ? FrameMethod::kFast
         : weighted ? FrameMethod::kCeresWeighted
                    : FrameMethod::kCeresReduced;
}

ResultFormat ChosenFormat() {
  if (FLAGS_report && IsGiven("columns")) {
    throw UsageError("--columns does not go with --report, which shows all");
  }
  constexpr int kMostDigits = 17;
  if (FLAGS_digits < 0 || FLAGS_digits > kMostDigits) {
    throw UsageError("--digits: expected 0 (all) to 17, found " +
                     std::to_string(FLAGS_digits));
  }
  return {SplitList(FLAGS_columns), FLAGS_digits};
}

// A scene can describe offsets that wander. Frames by themselves, each in any
// order, cannot use that.
void CheckJoint(BatchSettings* settings) {
  if (settings->joint && settings->method != FrameMethod::kFast) {
    throw UsageError("--solver does not go with --joint, which uses Ceres");
  }
  if (settings->joint || FLAGS_follow || !settings->scene.gauge_offset_walk) {
    return;
  }
  Warn("the scene's gauge_offset_walk is for --joint and --follow",
       "without it the offsets are the finger's");
  settings->scene.gauge_offset_walk.reset();
}

// Live rows go from one pipe to the other, so flags of batches mean nothing.
void RefuseBatchFlags() {
  for (const char* flag : {"logs", "logs_root", "out_dir", "resume", "threads",
                           "keep_going", "joint", "report", "bad_rows"}) {
    if (IsGiven(flag)) {
      throw UsageError(std::string("--") + flag + " does not go with --follow");
    }
  }
}

// A client sees the status of each of its rows, and a page shows one log.
void RefuseFlagsOfOneLog() {
  for (const char* flag : {"strict", "most_unexplained_percent", "serve"}) {
    if (IsGiven(flag)) {
      throw UsageError(std::string("--") + flag + " does not go with --listen");
    }
  }
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

// Checks who may see a live page.
std::optional<ServeSettings> LivePage() {
  if (FLAGS_serve < 0) {
    for (const char* flag : {"serve_address", "serve_token", "serve_rate_Hz"}) {
      if (IsGiven(flag)) {
        throw UsageError(std::string("--") + flag + " goes with --serve");
      }
    }
    return {};
  }
  if (FLAGS_serve > 65535) {
    throw UsageError("--serve: expected a port, 0 to 65535, found " +
                     std::to_string(FLAGS_serve));
  }
  if (!(FLAGS_serve_rate_Hz >= 0.1 && FLAGS_serve_rate_Hz <= 1000)) {
    throw UsageError("--serve_rate_Hz: expected 0.1 to 1000");
  }
  constexpr std::size_t kShortestToken = 16;
  constexpr char kDigits[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  const std::string& token = FLAGS_serve_token;
  if (token.empty() && !IsLoopback(FLAGS_serve_address)) {
    throw UsageError("--serve_address " + FLAGS_serve_address +
                     ": other machines reach it, so it needs a --serve_token");
  }
  if (IsGiven("serve_token") &&
      (token.size() < kShortestToken ||
       token.find_first_not_of(kDigits) != std::string::npos)) {
    throw UsageError("--serve_token: expected at least " +
                     std::to_string(kShortestToken) +
                     " letters, digits, - and _, found " +
                     (token.size() < kShortestToken
                          ? std::to_string(token.size()) + " characters"
                          : "another character"));
  }
  return ServeSettings{FLAGS_serve_address, FLAGS_serve, FLAGS_serve_token};
}

// Runs `finray_estimate --follow`.
int Follow(const BatchSettings& settings) {
  // A poll() on this pipe cannot miss the request to stop.
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) == 0) stop_pipe = ends[1];
  CatchStopSignals(0);
  FollowSettings follow;
  follow.strict = FLAGS_strict;
  follow.serve = LivePage();
  follow.updates_Hz = FLAGS_serve_rate_Hz;
  follow.stop_file = ends[0];
  follow.stop = IsStopRequested;
  if (IsGiven("listen")) {
    Listen(settings, FLAGS_listen, follow);
    return kGood;
  }
  const auto followed = FollowInput(settings, follow);
  if (!followed) return kGood;
  const EstimationSummary& summary = followed->summary;
  PrintLatency("latency", followed->latency);
  PrintEnded("searches", summary, settings.scene, stderr);
  const std::vector<Warning> warnings =
      WarningsOf({{&summary, follow.source}}, settings.finger);
  Warn(warnings);
  if (FLAGS_strict && summary.unsolved() > 0) return kSolveFailed;
  const bool kept = KeepsGate(summary);
  return kept && !(FLAGS_strict && FailsStrict(warnings, settings.scene))
             ? kGood
             : kGateFailed;
}

// Writes D/<log>.html of each log, and D/index.html.
void WriteReport(const BatchSettings& settings) {
  const BatchResults batch = ReadBatchResults(FLAGS_out_dir);
  const std::vector<ViewJob> jobs = JobsOf(batch, FLAGS_out_dir);
  ProgressBar bar(jobs.size());
  WriteBatchPages({batch}, {jobs}, OutPath("index.html"), &settings.finger,
                  settings.discretization, [&] { bar.Add(1, false); });
  bar.Clear();
  std::printf("report         %s\n", OutPath("index.html").c_str());
}

int Run() {
  if (FLAGS_follow) RefuseBatchFlags();
  if (!FLAGS_follow && FLAGS_serve >= 0) {
    throw UsageError("--serve goes with --follow");
  }
  if (IsGiven("listen")) {
    if (!FLAGS_follow) throw UsageError("--listen goes with --follow");
    RefuseFlagsOfOneLog();
  }
  BatchSettings settings(Required("finger", FLAGS_finger), FLAGS_scene,
                         DiscretizationFlags());
  settings.method = ChosenMethod();
  settings.joint = FLAGS_joint;
  settings.format = ChosenFormat();
  settings.skip_bad_rows =
      IsSecond("bad_rows", FLAGS_bad_rows, "error", "skip");
  CheckJoint(&settings);
  if (!FLAGS_follow) {
    Required("logs", FLAGS_logs);
    Required("out_dir", FLAGS_out_dir);
  }
  if (DumpConfigFlag(settings.finger, settings.scene,
                     settings.discretization)) {
    return kGood;
  }
  if (FLAGS_follow) return Follow(settings);
  settings.threads = Threads(FLAGS_threads);
  settings.resume = FLAGS_resume;
  settings.stop = IsStopRequested;
  CatchStopSignals(SA_RESTART);

  std::vector<LogJob> jobs = MakeJobs(settings);
  std::vector<BadLog> bad_logs;
  std::vector<LogJob> left_out;
  if (!CheckAll(&jobs, &left_out, &bad_logs)) {
    return Interrupted("before the first frame");
  }
  FrameSolverPool pool(FrameSolvers(settings.finger, settings.scene,
                                    settings.discretization, settings.method));
  MakeFolders(jobs);
  RemoveOldSummaries(jobs);
  SetAside(left_out, &bad_logs);
  ProgressBar bar(Frames(jobs));
  settings.progress = [&bar](std::size_t frames, bool kept) {
    bar.Add(frames, kept);
  };
  // They take as long as some thousand frames, so they are found beside these.
  auto hidden = std::async(
      settings.threads > 1 ? std::launch::async : std::launch::deferred,
      [&settings] { return HiddenForcesOf(settings); });
  const bool whole = RunAll(&pool, &jobs);
  bar.Clear();
  for (const LogJob& job : jobs) {
    if (job.damaged().empty()) continue;
    Warn(job.damaged() + ": its checksum is wrong",
         "the rows behind the last good checkpoint are estimated again");
  }
  if (!whole) {
    return Interrupted("after " + std::to_string(bar.done() + bar.kept()) +
                       " of " + std::to_string(Frames(jobs)) + " frames");
  }

  BatchTable(settings, jobs, bad_logs).Write(OutPath("summary.csv"));
  WriteFileAtomically(OutPath("summary.yaml"),
                      BatchYaml(settings, jobs, bad_logs, hidden.get()));
  PrintSummary(jobs, bar);
  if (FLAGS_report) WriteReport(settings);
  const EstimationSummary all = Total(jobs);
  PrintEnded("searches", all, settings.scene, stdout);
  const std::vector<Warning> warnings =
      WarningsOf(SummariesOf(jobs), settings.finger);
  Warn(WarningsOf(settings.finger, settings.scene));
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
    "sensor | finray_estimate --follow --finger F.yaml [--scene S.yaml] "
    "[--serve 8080] | consumer\n"
    "finray_estimate --follow --finger F.yaml --listen 9000",
    Run};
