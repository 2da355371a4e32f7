#include "finray/view/batch_results.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <filesystem>

#include "finray/io/error.h"
#include "finray/io/number_text.h"
#include "finray/io/utf8.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

namespace fs = std::filesystem;
using Kind = FingerVerdict::Kind;

std::vector<Warning> WarningsIn(const YamlMap& yaml) {
  std::vector<Warning> warnings;
  for (const YamlMap& warning : yaml.Maps("warnings")) {
    warnings.push_back({warning.Text("code"), warning.RawText("text"),
                        warning.Text("remedy")});
  }
  return warnings;
}

std::size_t CountIn(const YamlMap& yaml, const std::string& key) {
  return yaml.Has(key) ? static_cast<std::size_t>(yaml.NonNegativeNumber(key))
                       : 0;
}

// Finds a result of the summary below the folder: the longest end of its path
// that is there.
std::string FindResult(const std::string& folder, const std::string& result,
                       const YamlMap& yaml) {
  std::vector<fs::path> ends;
  // A name that is not UTF-8 is written with percents.
  for (const std::string& written : {result, WithoutPercents(result)}) {
    const std::size_t first = ends.size();
    ends.emplace_back();
    for (const fs::path& part : fs::path(written).relative_path()) {
      for (std::size_t i = first; i < ends.size(); ++i) ends[i] /= part;
      ends.emplace_back();
    }
  }
  for (const fs::path& end : ends) {
    std::error_code unknown;
    if (!end.empty() && fs::is_regular_file(fs::path(folder) / end, unknown)) {
      return (fs::path(folder) / end).string();
    }
  }
  yaml.Fail("result", "there is no " + fs::path(result).filename().string() +
                          " in " + folder);
}

LogResult ReadLog(const std::string& folder, const YamlMap& yaml) {
  LogResult log;
  log.log = yaml.RawText("log");
  log.result = FindResult(folder, yaml.RawText("result"), yaml);
  log.frames = CountIn(yaml, "frames");
  const YamlMap status = yaml.Map("status");
  for (const std::string& name : status.Keys()) {
    log.status[name] = CountIn(status, name);
  }
  log.unexplained = CountIn(yaml, "unexplained_frames");
  log.force_compared = CountIn(yaml, "force_compared_frames");
  if (log.force_compared > 0 && yaml.Has("force_rms_error_N")) {
    log.force_rms_N = yaml.NonNegativeNumber("force_rms_error_N");
    log.force_judged = CountIn(yaml, "force_judged_frames");
  }
  log.free_rows = CountIn(yaml, "free_rows");
  if (log.free_rows > 0) log.free_sums_V = yaml.Numbers("free_sums_V");
  log.warnings = WarningsIn(yaml);
  log.day = DayInPath(log.log);
  return log;
}

bool Contains(const std::string& text, const char* words) {
  return text.find(words) != std::string::npos;
}

// The causes in "likeliest cause: ..., or as well: ...; ", the likeliest first.
std::vector<std::string> CausesIn(const std::string& text) {
  static const std::string begin = "likeliest cause: ", next = ", or as well: ";
  std::size_t at = text.find(begin);
  if (at == std::string::npos) return {};
  at += begin.size();
  const std::string all = text.substr(at, text.find("; ", at) - at);
  std::vector<std::string> causes;
  for (at = 0;; at += next.size()) {
    const std::size_t end = all.find(next, at);
    causes.push_back(all.substr(at, end - at));
    if (end == std::string::npos) return causes;
    at = end;
  }
}

// The finger is as it was.
bool IsBeside(const std::string& cause) {
  return Contains(cause, "the force sensor has") ||
         Contains(cause, "friction is not the scene's") ||
         Contains(cause, "readings are noisier") ||
         Contains(cause, " has steps of ");
}

// What one warning of a log asks for.
Kind KindOf(const Warning& warning) {
  if (warning.code == "gauge_fault") return Kind::kRepair;
  if (warning.code != "unexplained_frames" && warning.code != "forces_differ") {
    return Kind::kWatch;
  }
  const std::vector<std::string> causes = CausesIn(warning.text);
  const std::string first = causes.empty() ? "" : causes.front();
  if (Contains(first, " is dead") || Contains(first, " is stuck at ") ||
      Contains(first, " is clipped: ") || Contains(first, " not move in ") ||
      Contains(first, "all gauges read the same") ||
      Contains(first, "1000 times too small") ||
      Contains(first, " has the wrong sign") ||
      Contains(first, " are swapped")) {
    return Kind::kRepair;
  }
  if (Contains(warning.text, "offsets have moved") ||
      Contains(warning.text, "has slipped") ||
      Contains(warning.remedy, "zero the gauges")) {
    return Kind::kZero;
  }
  if (!causes.empty() && std::all_of(causes.begin(), causes.end(), IsBeside)) {
    return Kind::kWatch;
  }
  return Kind::kCalibrate;
}

const char* WordsOf(Kind kind) {
  switch (kind) {
    case Kind::kGood:
      return "No warning, and a force sensor has read forces of the last day "
             "that agree.";
    case Kind::kUnchecked:
      return "No warning, but no force sensor has read a force of the last day "
             "that could show one.";
    case Kind::kWatch:
      return "No log of the last day asks for more; watch the warnings.";
    case Kind::kZero:
      return "Zero the gauges with finray_zero.";
    case Kind::kCalibrate:
      return "Calibrate it anew with finray_calibrate.";
    case Kind::kRepair:
      return "Repair the gauge, then calibrate it anew.";
  }
  return "";
}

}  // namespace

std::string DayInPath(const std::string& path) {
  const auto number = [&](std::size_t at, std::size_t digits) {
    int value = 0;
    for (std::size_t i = at; i < at + digits; ++i) {
      if (i >= path.size() ||
          !std::isdigit(static_cast<unsigned char>(path[i]))) {
        return -1;
      }
      value = 10 * value + (path[i] - '0');
    }
    return value;
  };
  for (std::size_t at = 0; at + 8 <= path.size(); ++at) {
    if (at > 0 && std::isdigit(static_cast<unsigned char>(path[at - 1]))) {
      continue;
    }
    const std::size_t gap = path[at + 4] == '-' ? 1 : 0;
    if (gap == 1 && (at + 7 >= path.size() || path[at + 7] != '-')) continue;
    const int year = number(at, 4), month = number(at + 4 + gap, 2),
              day = number(at + 6 + 2 * gap, 2);
    if (year >= 2000 && year < 2100 && month >= 1 && month <= 12 && day >= 1 &&
        day <= 31) {
      return FormatText("%04d-%02d-%02d", year, month, day);
    }
  }
  return "";
}

std::string DayOfTime(double time_s) {
  constexpr double kYear2001 = 1e9, kYear2100 = 4.1e9;
  if (!(time_s > kYear2001 && time_s < kYear2100)) return "";
  const auto seconds = static_cast<std::time_t>(time_s);
  std::tm utc = {};
  gmtime_r(&seconds, &utc);
  return FormatText("%04d-%02d-%02d", utc.tm_year + 1900, utc.tm_mon + 1,
                    utc.tm_mday);
}

BatchResults ReadBatchResults(const std::string& folder) {
  const fs::path summary = fs::path(folder) / "summary.yaml";
  std::error_code unknown;
  if (fs::is_directory(folder, unknown) && !fs::exists(summary, unknown)) {
    throw InputError(
        folder +
        ": has no summary.yaml, so it holds no results of finray_estimate, or "
        "those of a run that did not end; expected the --out_dir of one");
  }
  const YamlMap yaml = YamlMap::FromFile(summary.string());
  BatchResults batch;
  batch.folder = folder;
  batch.finger = yaml.Text("finger");
  batch.warnings = WarningsIn(yaml);
  for (const YamlMap& log : yaml.Maps("logs")) {
    batch.logs.push_back(ReadLog(folder, log));
  }
  for (const YamlMap& bad : yaml.Maps("bad_logs")) {
    batch.bad_logs.push_back({bad.RawText("log"), bad.RawText("reason")});
  }
  return batch;
}

const char* VerdictName(Kind kind) {
  switch (kind) {
    case Kind::kGood:
      return "good";
    case Kind::kUnchecked:
      return "unchecked";
    case Kind::kWatch:
      return "watch";
    case Kind::kZero:
      return "zero";
    case Kind::kCalibrate:
      return "calibrate";
    case Kind::kRepair:
      return "repair";
  }
  return "";
}

FingerVerdict Judge(const std::vector<Warning>& of_finger,
                    const std::vector<const LogResult*>& logs) {
  std::string last_day;
  for (const LogResult* log : logs) last_day = std::max(last_day, log->day);
  Kind kind = Kind::kGood;
  bool checked = false;
  for (const LogResult* log : logs) {
    checked |= log->day == last_day && log->force_judged > 0;
    for (const Warning& warning : log->warnings) {
      kind =
          std::max(kind, log->day == last_day ? KindOf(warning) : Kind::kWatch);
    }
  }
  if (kind == Kind::kGood && !checked) kind = Kind::kUnchecked;
  const bool uncalibrated =
      std::any_of(of_finger.begin(), of_finger.end(),
                  [](const Warning& w) { return w.code == "not_calibrated"; });
  if (uncalibrated && kind < Kind::kCalibrate) {
    return {Kind::kCalibrate,
            "Nobody has calibrated it: use finray_calibrate."};
  }
  return {kind, WordsOf(kind)};
}

}  // namespace finray
