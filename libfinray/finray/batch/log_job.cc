#include "finray/batch/log_job.h"

#include <atomic>
#include <future>
#include <utility>

#include "finray/batch/log_stream.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/atomic_file.h"
#include "finray/io/error.h"
#include "finray/io/frame_reader.h"
#include "finray/io/log_list.h"
#include "finray/io/message_text.h"
#include "finray/io/number_text.h"
#include "finray/io/sha256.h"
#include "finray/io/versions.h"
#include "finray/io/yaml_emitter.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

namespace fs = std::filesystem;

std::string SolverName(const BatchSettings& settings) {
  return settings.joint ? "joint" : FrameMethodName(settings.method);
}

std::string WrittenText(const BatchSettings& settings) {
  return Joined(settings.format.columns) + " " +
         std::to_string(settings.format.digits) +
         (settings.skip_bad_rows ? " skip" : "");
}

std::string Key(const BatchSettings& settings, const std::string& log_sha256) {
  return Sha256OfText(
      "results 11\nversion " FINRAY_VERSION "\nlog " + log_sha256 +
      "\nfinger " + settings.finger_sha256 + "\nscene " +
      settings.scene_sha256 + "\nscheme " +
      SchemeName(settings.discretization.scheme) + "\nresolution " +
      std::to_string(settings.discretization.resolution) + "\nsolver " +
      SolverName(settings) + "\nblock_frames " + std::to_string(kBlockFrames) +
      "\nwritten " + WrittenText(settings) + "\n");
}

std::size_t Count(const YamlMap& yaml, const std::string& key) {
  return static_cast<std::size_t>(yaml.NonNegativeNumber(key));
}

EstimationSummary SummaryFromYaml(const YamlMap& yaml) {
  EstimationSummary summary;
  summary.frames = Count(yaml, "frames");
  const YamlMap status = yaml.Map("status");
  for (const FrameStatus s : EstimationSummary::kStatuses) {
    summary.by_status[static_cast<std::size_t>(s)] =
        Count(status, StatusName(s));
  }
  summary.unexplained = Count(yaml, "unexplained_frames");
  summary.search_ended = Count(yaml, "search_ended_frames");
  if (yaml.Has("bad_rows")) summary.bad_rows = Count(yaml, "bad_rows");
  if (yaml.Has("impossible_rows")) {
    summary.impossible = Count(yaml, "impossible_rows");
    summary.impossible_row = Count(yaml, "impossible_row");
    summary.impossible_gauge = Count(yaml, "impossible_gauge");
    summary.impossible_V = yaml.Text("impossible_V");
  }
  if (yaml.Has("force_compared_frames")) {
    summary.force_compared = Count(yaml, "force_compared_frames");
    summary.force_squares_N2 = yaml.NonNegativeNumber("force_squares_N2");
    summary.force_max_N = yaml.NonNegativeNumber("force_max_error_N");
    summary.force_judged = Count(yaml, "force_judged_frames");
    summary.force_far = Count(yaml, "force_far_frames");
    summary.force_variances_N2 = yaml.NonNegativeNumber("force_variances_N2");
  }
  if (yaml.Has("free_rows")) {
    summary.free_rows = Count(yaml, "free_rows");
    summary.free_sums_V = yaml.Numbers("free_sums_V");
  }
  ReadChanges(yaml, &summary);
  return summary;
}

LogCause CauseFromYaml(const YamlMap& yaml) {
  if (!yaml.Has("cause")) return {};
  const YamlMap cause = yaml.Map("cause");
  return {cause.RawText("words"), cause.RawText("details"),
          cause.RawText("remedy"), cause.Has("of_gauges")};
}

LogSummary SummaryOf(const LogJob& job) {
  return {&job.summary(), job.log(), &job.cause()};
}

// The codes of a log's warnings.
std::string WarningCodes(const LogJob& job, const Finger& finger) {
  std::string codes;
  for (const Warning& warning :
       WarningsOf(std::vector{SummaryOf(job)}, finger)) {
    codes += (codes.empty() ? "" : " ") + warning.code;
  }
  return codes;
}

// Calls set(name, text) for each cell of a row of summary.csv.
template <class Set>
void AddCells(const LogJob& job, const Finger& finger, Set set) {
  const EstimationSummary& summary = job.summary();
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
  set("force_squares_N2", compared ? NumberText(summary.force_squares_N2) : "");
  set("force_judged_frames", std::to_string(summary.force_judged));
  set("force_far_frames", std::to_string(summary.force_far));
  set("force_variances_N2",
      compared ? NumberText(summary.force_variances_N2) : "");
  set("unexplained_frames", std::to_string(summary.unexplained));
  set("search_ended_frames", std::to_string(summary.search_ended));
  set("warnings", WarningCodes(job, finger));
  set("key", job.key());
  set("bad_rows", std::to_string(summary.bad_rows));
  set("reason", "");
}

}  // namespace

BatchSettings::BatchSettings(const std::string& finger_path,
                             const std::string& scene_path,
                             const Discretization& discretization_in)
    : finger(ReadFinger(finger_path)),
      discretization(discretization_in),
      finger_sha256(Sha256OfFile(finger_path)) {
  if (scene_path.empty()) return;
  scene = ReadScene(scene_path);
  scene_sha256 = Sha256OfFile(scene_path);
  if (!scene.columns.path.empty()) {
    scene_sha256 =
        Sha256OfText(scene_sha256 + Sha256OfFile(scene.columns.path));
  }
}

LogJob::LogJob(const BatchSettings* settings, std::string log,
               std::string result)
    : settings_(settings), log_(std::move(log)), result_(std::move(result)) {
  const fs::path folder = fs::path(result_).parent_path();
  summary_path_ = (folder / (LogName(log_) + ".summary.yaml")).string();
  bad_rows_path_ = (folder / (LogName(log_) + ".bad_rows.csv")).string();
}

StreamOptions LogJob::Options() const {
  return {settings_->threads, settings_->stop, settings_->format,
          settings_->skip_bad_rows};
}

bool LogJob::Check() {
  std::error_code unknown;
  if (fs::is_fifo(log_, unknown) || fs::is_character_file(log_, unknown)) {
    throw InputError(log_ +
                     ": expected a file; a log is read more than once, but a "
                     "pipe can be read only once");
  }
  bytes_ = fs::file_size(log_, unknown);
  written_ = fs::last_write_time(log_, unknown);
  // Hashes the log in parallel to the check if there is a thread for it. Nobody
  // waits for the hash of a log that the check refuses.
  std::atomic<bool> ended{false};
  auto hash = std::async(
      settings_->threads > 1 ? std::launch::async : std::launch::deferred,
      [&] { return Sha256OfFile(log_, [&] { return ended.load(); }); });
  const struct EndsHash {
    ~EndsHash() { *ended = true; }
    std::atomic<bool>* ended;
  } ends_hash{&ended};
  const auto set_key = [&] {
    log_sha256_ = hash.get();
    key_ = Key(*settings_, log_sha256_);
  };
  const bool perhaps_finished =
      settings_->resume && fs::exists(summary_path_, unknown);
  if (perhaps_finished) {
    set_key();
    finished_before_ = ReadFinished();
    if (finished_before_) return true;
  }
  FrameReader reader(log_, settings_->scene.columns);
  GaugeFaultFinder finder(settings_->finger);
  std::size_t row = 0;
  const auto look = [&](const Measurements& readings) {
    finder.Add(++row, readings);
  };
  if (!CheckStream(settings_->finger, settings_->scene, Options(), &reader,
                   &bad_rows_, look)) {
    return false;
  }
  faulty_ = !WordsOf(finder.Faults(), false).empty();
  frames_ = reader.position() - bad_rows_.size();
  if (frames_ == 0) {
    throw InputError(
        log_ + ": all rows are bad; the first: " + bad_rows_.front().reason);
  }
  if (!perhaps_finished) set_key();
  return true;
}

bool LogJob::SetAside() const {
  std::error_code missing;
  for (const std::string& path : {summary_path_, bad_rows_path_}) {
    fs::remove(path, missing);
  }
  if (ResumableFile::IsUnderWay(result_)) {
    ResumableFile(result_, key_, false).Discard();
  }
  fs::rename(result_, result_ + ".old", missing);
  return !missing;
}

bool LogJob::ReadFinished() {
  std::error_code missing;
  const std::uintmax_t bytes = fs::file_size(result_, missing);
  if (missing) return false;
  try {
    const YamlMap yaml = YamlMap::FromFile(summary_path_);
    if (yaml.Text("key") != key_ ||
        yaml.Number("result_bytes") != static_cast<double>(bytes)) {
      return false;
    }
    summary_ = SummaryFromYaml(yaml);
    cause_ = CauseFromYaml(yaml);
  } catch (const InputError&) {
    return false;  // not ours, or edited by hand: the log is estimated again
  }
  frames_ = summary_.frames;
  return summary_.bad_rows == 0 || fs::exists(bad_rows_path_, missing);
}

bool LogJob::Changed() const {
  std::error_code unknown;
  return fs::file_size(log_, unknown) != bytes_ || unknown ||
         fs::last_write_time(log_, unknown) != written_ || unknown;
}

void LogJob::ReportProgress(std::size_t frames, bool kept) const {
  if (settings_->progress) settings_->progress(frames, kept);
}

bool LogJob::Run(FrameSolverPool* pool) {
  if (finished_before_) {
    // A later run may have begun to estimate the log again; its partial file is
    // of no use.
    if (ResumableFile::IsUnderWay(result_)) {
      ResumableFile(result_, key_, true).Discard();
    }
    ReportProgress(frames_, true);
    return true;
  }
  ResumableFile out(result_, key_, settings_->resume && !settings_->joint);
  damaged_ = out.damaged();
  summary_ = SummaryFromText(out.note()).value_or(EstimationSummary());
  ReportProgress(summary_.frames, true);
  if (!out.finished() && !Estimate(pool, &out)) return false;
  FindCause();
  WriteBadRows();
  WriteSummary(out.bytes());
  out.Forget();
  return true;
}

// Reads the log once more, as few logs need a cause.
void LogJob::FindCause() {
  const bool needed = NeedsCause(summary_);
  if (!needed && !faulty_) return;
  LogEvidence evidence(settings_->finger, settings_->scene);
  FrameReader reader(log_, settings_->scene.columns);
  ReadStream(settings_->finger, settings_->scene, Options(), &reader,
             [&](const Measurements& row) { evidence.Add(row); });
  cause_ = FindLogCause(evidence, settings_->finger, settings_->scene,
                        settings_->discretization, settings_->threads, needed);
}

bool LogJob::Estimate(FrameSolverPool* pool, ResumableFile* out) {
  std::size_t blocks = 0;
  const auto write = [&](const StreamedBlock& block) {
    out->Append(block.csv);
    summary_.Add(block.summary);
    if (++blocks % settings_->chunk_blocks == 0) {
      out->CheckpointSoon(SummaryToText(summary_));
    }
    ReportProgress(block.summary.frames, false);
  };
  bool whole = false;
  try {
    FrameReader reader(log_, settings_->scene.columns);
    whole = settings_->joint
                ? EstimateJointly(settings_->finger, settings_->scene,
                                  settings_->discretization, Options(), &reader,
                                  write)
                : EstimateStream(settings_->finger, settings_->scene, pool,
                                 Options(), &reader, write,
                                 summary_.frames + summary_.bad_rows);
  } catch (const InputError&) {
    if (!Changed()) throw;  // the result cannot be written
  }
  if (Changed()) {
    out->Discard();
    throw InputError(log_ + ": was changed while it was being read");
  }
  if (!whole) {
    out->Checkpoint(SummaryToText(summary_));
    return false;
  }
  // Removes the summary of an older result, which must not stand beside the new
  // one.
  std::error_code missing;
  fs::remove(summary_path_, missing);
  out->Finish(SummaryToText(summary_));
  return true;
}

void LogJob::WriteBadRows() const {
  if (bad_rows_.empty()) {
    std::error_code missing;
    fs::remove(bad_rows_path_, missing);
    return;
  }
  FrameTable table(bad_rows_.size());
  for (std::size_t i = 0; i < bad_rows_.size(); ++i) {
    table.MutableText("line")[i] = std::to_string(bad_rows_[i].line);
    table.MutableText("reason")[i] = bad_rows_[i].reason;
  }
  table.Write(bad_rows_path_);
}

void LogJob::WriteSummary(std::uint64_t bytes) const {
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  YamlPairs(&yaml, "key", key_, "version", FINRAY_VERSION, "scheme",
            SchemeName(settings_->discretization.scheme), "resolution",
            settings_->discretization.resolution, "solver",
            SolverName(*settings_));
  yaml << YAML::Key << "inputs" << YAML::Value << YAML::BeginMap;
  YamlPairs(&yaml, "log_sha256", log_sha256_, "finger_sha256",
            settings_->finger_sha256);
  if (!settings_->scene_sha256.empty()) {
    YamlPair(&yaml, "scene_sha256", settings_->scene_sha256);
  }
  yaml << YAML::EndMap;
  YamlPair(&yaml, "result_bytes", bytes);
  EmitSummary(summary_, &yaml);
  EmitRowsOfLog(summary_, &yaml);
  EmitChanges(summary_, &yaml);
  if (!cause_.words.empty()) {
    yaml << YAML::Key << "cause" << YAML::Value << YAML::BeginMap;
    YamlPairs(&yaml, "words", cause_.words, "details", cause_.details, "remedy",
              cause_.remedy);
    if (cause_.of_gauges) YamlPairs(&yaml, "of_gauges", true);
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndMap;
  WriteFileAtomically(summary_path_, std::string(yaml.c_str()) + "\n");
}

EstimationSummary Total(const std::vector<LogJob>& jobs) {
  EstimationSummary all;
  for (const LogJob& job : jobs) all.Add(job.summary());
  return all;
}

std::vector<LogSummary> SummariesOf(const std::vector<LogJob>& jobs) {
  std::vector<LogSummary> logs;
  for (const LogJob& job : jobs) logs.push_back(SummaryOf(job));
  return logs;
}

namespace {

void EmitWarnings(const std::vector<Warning>& warnings, YamlEmitter* yaml) {
  if (warnings.empty()) return;
  *yaml << YAML::Key << "warnings" << YAML::Value << YAML::BeginSeq;
  for (const Warning& warning : warnings) {
    YamlLine(yaml, "code", warning.code, "text", warning.text, "remedy",
             warning.remedy);
  }
  *yaml << YAML::EndSeq;
}

void EmitHiddenForces(const HiddenForces& hidden, YamlEmitter* yaml) {
  const auto numbers = [&](const char* key, const std::vector<double>& values,
                           int digits) {
    *yaml << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const double value : values) {
      *yaml << YAML::Auto << YamlNumber(value, digits);
    }
    *yaml << YAML::EndSeq;
  };
  *yaml << YAML::Key << "hidden_forces" << YAML::Value << YAML::BeginMap;
  numbers("contact_mm", hidden.contact_mm, 6);
  numbers("normal_N", hidden.normal_N, 3);
  *yaml << YAML::EndMap;
}

}  // namespace

std::optional<HiddenForces> HiddenForcesOf(const BatchSettings& settings) {
  // With --joint offsets hide more than noise does.
  if (settings.joint || settings.scene.contacts == 0) return {};
  return FindHiddenForces(settings.finger, settings.scene,
                          settings.discretization);
}

std::string BatchYaml(const BatchSettings& settings,
                      const std::vector<LogJob>& jobs,
                      const std::vector<BadLog>& bad_logs,
                      const std::optional<HiddenForces>& hidden) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  YamlPairs(&yaml, "finger", settings.finger.name, "scheme",
            SchemeName(settings.discretization.scheme));
  if (settings.joint || settings.method != FrameMethod::kFast) {
    YamlPair(&yaml, "solver", SolverName(settings));
  }
  YamlPair(&yaml, "version", FINRAY_VERSION);
  EmitWarnings(WarningsOf(settings.finger, settings.scene), &yaml);
  if (hidden) EmitHiddenForces(*hidden, &yaml);
  yaml << YAML::Key << "logs" << YAML::Value << YAML::BeginSeq;
  for (const LogJob& job : jobs) {
    yaml << YAML::BeginMap;
    YamlPairs(&yaml, "log", job.log(), "result", job.result(), "key",
              job.key());
    EmitSummary(job.summary(), &yaml);
    EmitRowsOfLog(job.summary(), &yaml);
    EmitWarnings(WarningsOf(std::vector{SummaryOf(job)}, settings.finger),
                 &yaml);
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq << YAML::Key << "all" << YAML::Value << YAML::BeginMap;
  EmitSummary(Total(jobs), &yaml);
  yaml << YAML::EndMap;
  if (!bad_logs.empty()) {
    yaml << YAML::Key << "bad_logs" << YAML::Value << YAML::BeginSeq;
    for (const BadLog& bad : bad_logs) {
      yaml << YAML::BeginMap;
      YamlPairs(&yaml, "log", bad.log, "reason", bad.reason);
      yaml << YAML::EndMap;
    }
    yaml << YAML::EndSeq;
  }
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

FrameTable BatchTable(const BatchSettings& settings,
                      const std::vector<LogJob>& jobs,
                      const std::vector<BadLog>& bad_logs) {
  FrameTable table(jobs.size() + bad_logs.size());
  // The table has its columns even without any log.
  AddCells(LogJob(nullptr, "", ""), settings.finger,
           [&](const std::string& name, const std::string&) {
             table.MutableText(name);
           });
  for (std::size_t row = 0; row < jobs.size(); ++row) {
    AddCells(jobs[row], settings.finger,
             [&](const std::string& name, const std::string& text) {
               table.MutableText(name)[row] = text;
             });
  }
  for (std::size_t i = 0; i < bad_logs.size(); ++i) {
    table.MutableText("log")[jobs.size() + i] = bad_logs[i].log;
    table.MutableText("reason")[jobs.size() + i] = bad_logs[i].reason;
  }
  return table;
}

}  // namespace finray
