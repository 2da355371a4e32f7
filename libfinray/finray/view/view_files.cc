#include "finray/view/view_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

#include "finray/io/atomic_file.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"
#include "finray/io/versions.h"
#include "finray/view/json_text.h"
#include "finray/view/log_channels.h"
#include "finray/view/log_page.h"
#include "finray/view/page_text.h"

namespace finray {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWorstFrames = 5;  // of a log
// In the head of every page, page/page.html.
constexpr char kPageMark[] = "<meta name=\"generator\" content=\"finray\">";

struct WorstFrame {
  std::size_t frame;
  double time_s, p_value;
};

// The frames of a log that are explained least, one of each group of
// neighbours.
std::vector<WorstFrame> WorstOf(const LogChannels& log) {
  const auto p = std::find_if(
      log.channels.begin(), log.channels.end(),
      [](const Channel& channel) { return channel.name == "chi2_p_value"; });
  if (p == log.channels.end()) return {};
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < log.frames; ++i) {
    if (p->values[i] < FrameEstimate::kUnexplained) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) {
                     return p->values[a] < p->values[b];
                   });
  const std::size_t near = std::max<std::size_t>(10, log.frames / 100);
  std::vector<WorstFrame> worst;
  for (const std::size_t frame : order) {
    const bool taken =
        std::any_of(worst.begin(), worst.end(), [&](const WorstFrame& other) {
          return std::max(frame, other.frame) - std::min(frame, other.frame) <
                 near;
        });
    if (taken) continue;
    worst.push_back({frame, log.time_s[frame], p->values[frame]});
    if (worst.size() == kWorstFrames) break;
  }
  return worst;
}

std::string WorstJson(const std::vector<WorstFrame>& worst, bool has_time) {
  JsonArray array;
  for (const WorstFrame& frame : worst) {
    array.Add(JsonObject()
                  .Add("frame", std::to_string(frame.frame))
                  .Add("time_s", has_time ? JsonNumber(frame.time_s) : "null")
                  .Add("p", JsonNumber(frame.p_value))
                  .str());
  }
  return array.str();
}

// Returns a path as a link of a page.
std::string LinkTo(const std::string& path) {
  constexpr char kUnreserved[] = "/-._~";
  std::string link;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool letter = byte < 0x80 && std::isalnum(byte) != 0;
    if (letter || (c != '\0' && std::strchr(kUnreserved, c) != nullptr)) {
      link += c;
    } else {
      link += FormatText("%%%02X", byte);
    }
  }
  return link;
}

std::string LogJson(const LogResult& log, const LogChannels& channels,
                    const std::string& page) {
  JsonObject status;
  for (const auto& [name, count] : log.status) {
    status.Add(name, std::to_string(count));
  }
  std::vector<double> free_V = log.free_sums_V;
  for (double& volts : free_V) volts /= static_cast<double>(log.free_rows);
  return JsonObject()
      .Add("name", JsonText(channels.name))
      .Add("log", JsonText(log.log))
      .Add("page", JsonText(LinkTo(page)))
      .Add("day", JsonText(log.day))
      .Add("frames", std::to_string(log.frames))
      .Add("status", status.str())
      .Add("unexplained", std::to_string(log.unexplained))
      .Add("force_compared", std::to_string(log.force_compared))
      .Add("force_rms_N",
           JsonNumber(log.force_compared > 0 ? log.force_rms_N : std::nan("")))
      .Add("free_V", JsonNumbers(free_V))
      .Add("warnings", WarningsJson(log.warnings))
      .Add("worst", WorstJson(WorstOf(channels), channels.has_time))
      .str();
}

void WritePage(const std::string& path, const std::string& text) {
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty()) MakeFolder(folder.string());
  WriteFileAtomically(path, text);
}

void WriteLog(const LogChannels& log, const std::string& page,
              const std::vector<Warning>& warnings, const Finger* finger,
              const Discretization& discretization) {
  WritePage(page, LogPageText(log.name, LogPageJson({{&log, warnings}}, finger,
                                                    discretization)));
}

}  // namespace

void WriteLogPage(const ViewJob& job, const std::vector<Warning>& warnings,
                  const Finger* finger, const Discretization& discretization) {
  WriteLog(ReadLogChannels(job.result, finger, discretization), job.page,
           warnings, finger, discretization);
}

void WriteComparison(const std::string& result, const std::string& other,
                     const std::string& page, const Finger* finger,
                     const Discretization& discretization) {
  LogChannels a = ReadLogChannels(result, finger, discretization);
  LogChannels b = ReadLogChannels(other, finger, discretization);
  if (a.name == b.name) {  // one log, two runs
    a.name = fs::path(result).parent_path().filename() / a.name;
    b.name = fs::path(other).parent_path().filename() / b.name;
  }
  WritePage(page, LogPageText(a.name + " and " + b.name,
                              LogPageJson({{&a, {}}, {&b, {}}}, finger,
                                          discretization)));
}

std::string PagePath(const std::string& result, const std::string& folder) {
  const std::string name = ResultName(result);
  const char* const end = name == "index" ? "_log.html" : ".html";
  return (fs::path(folder) / (name + end)).string();
}

std::vector<ViewJob> JobsOf(const BatchResults& batch,
                            const std::string& folder) {
  std::vector<ViewJob> jobs;
  for (const LogResult& log : batch.logs) {
    const fs::path below =
        fs::path(log.result).lexically_relative(batch.folder);
    jobs.push_back(
        {log.result,
         PagePath(log.result, (folder / below.parent_path()).string())});
  }
  return jobs;
}

void RefuseSamePages(const std::vector<ViewJob>& jobs) {
  std::map<std::string, std::string> result_of;
  for (const ViewJob& job : jobs) {
    const auto [at, is_new] = result_of.insert({job.page, job.result});
    if (!is_new) {
      throw InputError(job.page + ": would be the page of " + at->second +
                       " and of " + job.result +
                       "; rename one, or make their pages one by one");
    }
  }
}

void RemoveOldPage(const std::string& page) {
  std::ifstream file(page, std::ios::binary);
  std::string start(1024, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start.find(kPageMark) == std::string::npos) return;
  std::error_code missing;
  fs::remove(page, missing);
}

void WriteBatchPages(const std::vector<BatchResults>& batches,
                     const std::vector<std::vector<ViewJob>>& jobs,
                     const std::string& index, const Finger* finger,
                     const Discretization& discretization,
                     const std::function<void()>& progress) {
  struct FingerLogs {
    std::vector<Warning> warnings;
    std::vector<LogResult> logs;
    JsonArray json;
  };
  std::map<std::string, FingerLogs> fingers;
  JsonArray bad_logs;
  for (std::size_t b = 0; b < batches.size(); ++b) {
    FingerLogs& of = fingers[batches[b].finger];
    of.warnings = batches[b].warnings;
    for (std::size_t i = 0; i < jobs[b].size(); ++i) {
      LogResult log = batches[b].logs[i];
      const ViewJob& job = jobs[b][i];
      const LogChannels channels =
          ReadLogChannels(job.result, finger, discretization);
      if (log.day.empty() && channels.has_time) {
        log.day = DayOfTime(channels.time_s.front());
      }
      WriteLog(channels, job.page, log.warnings, finger, discretization);
      of.json.Add(LogJson(log, channels,
                          fs::path(job.page)
                              .lexically_relative(fs::path(index).parent_path())
                              .generic_string()));
      of.logs.push_back(std::move(log));
      progress();
    }
    for (const BadResult& bad : batches[b].bad_logs) {
      bad_logs.Add(JsonObject()
                       .Add("log", JsonText(bad.log))
                       .Add("reason", JsonText(bad.reason))
                       .str());
    }
  }
  JsonArray array;
  for (const auto& [name, of] : fingers) {
    std::vector<const LogResult*> logs;
    for (const LogResult& log : of.logs) logs.push_back(&log);
    const FingerVerdict verdict = Judge(of.warnings, logs);
    array.Add(JsonObject()
                  .Add("name", JsonText(name))
                  .Add("verdict", JsonText(VerdictName(verdict.kind)))
                  .Add("words", JsonText(verdict.words))
                  .Add("warnings", WarningsJson(of.warnings))
                  .Add("logs", of.json.str())
                  .str());
  }
  WritePage(index, BatchPageText("All logs",
                                 JsonObject()
                                     .Add("version", JsonText(FINRAY_VERSION))
                                     .Add("fingers", array.str())
                                     .Add("bad_logs", bad_logs.str())
                                     .str()));
}

}  // namespace finray
