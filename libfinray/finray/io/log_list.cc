#include "finray/io/log_list.h"

#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string_view>

#include "finray/io/atomic_file.h"
#include "finray/io/csv_cells.h"
#include "finray/io/error.h"
#include "finray/io/message_text.h"

namespace finray {
namespace {

namespace fs = std::filesystem;

constexpr char kResult[] = ".frames.csv";
constexpr int kLongestList_MiB = 16;

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() &&
         text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool IsResult(const fs::path& path, const std::string& results_folder) {
  const std::string name = path.filename().string();
  if (name != "summary.csv" && !EndsWith(name, kResult)) return false;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code unknown;
  return fs::equivalent(folder, results_folder, unknown);
}

// Returns the files that match a pattern, sorted byte by byte.
std::vector<std::string> Matches(const std::string& pattern,
                                 const std::string& results_folder) {
  glob_t found = {};
  const std::unique_ptr<glob_t, void (*)(glob_t*)> owner(&found, globfree);
  std::vector<std::string> files;
  if (glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) {
      std::error_code unknown;
      if (!fs::is_directory(found.gl_pathv[i], unknown) &&
          !IsResult(found.gl_pathv[i], results_folder)) {
        files.emplace_back(found.gl_pathv[i]);
      }
    }
  }
  // glob's own order depends on the locale.
  std::sort(files.begin(), files.end());
  return files;
}

// Appends a file, or the files that match a pattern. `place` begins messages.
void AddFiles(const std::string& item, const std::string& place,
              const std::string& results_folder,
              std::vector<std::string>* logs) {
  std::error_code unknown;
  if (item.find_first_of("*?[") == std::string::npos ||
      fs::exists(item, unknown)) {
    logs->push_back(item);
    return;
  }
  const std::vector<std::string> files = Matches(item, results_folder);
  if (files.empty()) {
    throw InputError(place + ShownLine("'" + item + "' matches no file"));
  }
  logs->insert(logs->end(), files.begin(), files.end());
}

std::string_view WithoutComment(std::string_view line) {
  for (std::size_t at = line.find('#'); at != std::string_view::npos;
       at = line.find('#', at + 1)) {
    if (at == 0 || line[at - 1] == ' ' || line[at - 1] == '\t') {
      return line.substr(0, at);
    }
  }
  return line;
}

void AddList(const std::string& path, const std::string& results_folder,
             std::vector<std::string>* logs) {
  const std::string text =
      ReadWholeFile(path, "a list of logs", kLongestList_MiB);
  const fs::path folder = fs::path(path).parent_path();
  const std::size_t before = logs->size();
  int number = 0;
  std::istringstream lines(text);
  for (std::string whole; std::getline(lines, whole);) {
    std::string_view line = whole;
    ++number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    line = Trimmed(WithoutComment(line));
    if (line.empty()) continue;
    const std::string place = path + ":" + std::to_string(number) + ": ";
    const std::string file = (folder / std::string(line)).string();
    const std::size_t first = logs->size();
    AddFiles(file, place, results_folder, logs);
    std::error_code unknown;
    if (logs->size() == first + 1 && !fs::exists(logs->back(), unknown)) {
      throw InputError(place +
                       ShownLine("there is no log '" + logs->back() + "'"));
    }
  }
  if (logs->size() == before) {
    throw InputError(path + ": lists no logs");
  }
}

// Returns the folder of `log` relative to `root`.
fs::path FolderBelow(const std::string& root, const std::string& log) {
  const fs::path below =
      fs::absolute(log).lexically_normal().lexically_relative(
          fs::absolute(root).lexically_normal());
  if (below.empty() || *below.begin() == "..") {
    throw InputError("--logs: '" + log + "' is not below --logs_root " + root);
  }
  return below.parent_path();
}

}  // namespace

std::vector<std::string> ExpandLogs(const std::vector<std::string>& items,
                                    const std::string& results_folder) {
  std::vector<std::string> logs;
  for (const std::string& item : items) {
    if (item.front() == '@') {
      AddList(item.substr(1), results_folder, &logs);
    } else if (EndsWith(item, ".txt") || EndsWith(item, ".list")) {
      AddList(item, results_folder, &logs);
    } else {
      AddFiles(item, "--logs: ", results_folder, &logs);
    }
  }
  if (logs.empty()) throw InputError("--logs: names no log");
  return logs;
}

std::string LogName(const std::string& path) {
  std::string name = fs::path(path).filename().string();
  for (const char* end : {".gz", ".csv"}) {
    if (EndsWith(name, end)) name.resize(name.size() - std::string(end).size());
  }
  return name;
}

std::vector<std::string> ResultPaths(const std::vector<std::string>& logs,
                                     const std::string& folder,
                                     const std::string& root) {
  const auto place = [&](const std::string& log) {
    return root.empty() ? fs::path(folder) : folder / FolderBelow(root, log);
  };
  std::vector<std::string> results;
  std::map<std::string, std::string> log_of;
  for (const std::string& log : logs) {
    results.push_back((place(log) / (LogName(log) + kResult)).string());
    const auto [at, is_new] = log_of.insert({results.back(), log});
    if (!is_new) {
      throw InputError("--logs: '" + at->second + "' and '" + log +
                       "' would both be written to " + results.back());
    }
  }
  for (const std::string& log : logs) {
    const auto at =
        log_of.find((place(log) / fs::path(log).filename()).string());
    std::error_code unknown;
    if (at != log_of.end() && fs::equivalent(at->first, log, unknown)) {
      throw InputError("--logs: the result of '" + at->second +
                       "' would overwrite '" + log + "'");
    }
  }
  return results;
}

}  // namespace finray
