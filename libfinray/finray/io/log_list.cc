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
constexpr char kAnyFolders[] = "**";
constexpr const char* kLogs[] = {"*.csv", "*.csv.gz"};
constexpr int kLongestList_MiB = 16;

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() &&
         text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Says whether a file is a result below `folder`.
bool IsResult(const fs::path& path, const std::string& folder) {
  const std::string name = path.filename().string();
  if (folder.empty() || (name != "summary.csv" && !EndsWith(name, kResult) &&
                         !EndsWith(name, ".bad_rows.csv"))) {
    return false;
  }
  std::error_code unknown;
  const fs::path below =
      fs::weakly_canonical(path, unknown)
          .lexically_relative(fs::weakly_canonical(folder, unknown));
  return !below.empty() && *below.begin() != "..";
}

// Adds the folder and those below it, but no hidden ones and no links.
void AddFolders(const fs::path& folder, std::vector<fs::path>* folders) {
  folders->push_back(folder);
  std::error_code unknown;
  for (const auto& entry : fs::directory_iterator(
           folder.empty() ? fs::path(".") : folder, unknown)) {
    if (entry.is_directory(unknown) && !entry.is_symlink(unknown) &&
        entry.path().filename().string().front() != '.') {
      AddFolders(folder / entry.path().filename(), folders);
    }
  }
}

// Returns the paths that a pattern without ** matches.
std::vector<fs::path> Glob(const std::string& pattern) {
  glob_t found = {};
  const std::unique_ptr<glob_t, void (*)(glob_t*)> owner(&found, globfree);
  if (glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found) != 0) return {};
  return {found.gl_pathv, found.gl_pathv + found.gl_pathc};
}

// A folder's name as a pattern that matches only itself.
std::string Escaped(const std::string& path) {
  std::string pattern;
  for (const char c : path) {
    if (c == '*' || c == '?' || c == '[' || c == '\\') pattern += '\\';
    pattern += c;
  }
  return pattern;
}

// Appends the files in `folder` that a pattern matches.
void Match(const fs::path& folder, const fs::path& pattern,
           std::vector<std::string>* files) {
  fs::path before, behind;
  bool any_folders = false;
  for (const fs::path& part : pattern) {
    if (!any_folders && part == kAnyFolders) {
      any_folders = true;
    } else {
      (any_folders ? behind : before) /= part;
    }
  }
  std::vector<fs::path> found = {folder};
  if (!before.empty()) {
    found = Glob((fs::path(Escaped(folder.string())) / before).string());
  }
  std::error_code unknown;
  if (!any_folders) {
    for (const fs::path& path : found) {
      if (!fs::is_directory(path, unknown)) files->push_back(path.string());
    }
    return;
  }
  std::vector<fs::path> folders;
  for (const fs::path& path : found) {
    if (path.empty() || fs::is_directory(path, unknown)) {
      AddFolders(path, &folders);
    }
  }
  for (const fs::path& path : folders) {
    if (behind.empty()) {
      for (const char* logs : kLogs) Match(path, logs, files);
    } else {
      Match(path, behind, files);
    }
  }
}

// Appends a file, or the logs in a folder, or the files that match a pattern.
// `place` begins messages.
void AddFiles(const std::string& item, const std::string& place,
              const std::string& results_folder,
              std::vector<std::string>* logs) {
  std::error_code unknown;
  const bool is_folder = fs::is_directory(item, unknown);
  const bool is_pattern = item.find_first_of("*?[") != std::string::npos &&
                          !fs::exists(item, unknown);
  if (!is_folder && !is_pattern) {
    logs->push_back(item);
    return;
  }
  std::vector<std::string> files;
  if (is_pattern) Match("", item, &files);
  if (is_folder) {
    for (const char* pattern : kLogs) Match(item, pattern, &files);
  }
  files.erase(std::remove_if(files.begin(), files.end(),
                             [&](const std::string& file) {
                               return IsResult(file, results_folder);
                             }),
              files.end());
  // glob's own order depends on the locale.
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  if (files.empty() && is_folder) {
    throw InputError(ShownLine(item +
                               ": is a folder without *.csv and *.csv.gz; logs "
                               "in its folders are '" +
                               (fs::path(item) / "**").string() + "'"));
  }
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
