#ifndef FINRAY_IO_LOG_LIST_H_
#define FINRAY_IO_LOG_LIST_H_

#include <string>
#include <vector>

namespace finray {

/// The logs that the items of a --logs flag stand for, in their order. An item
/// is
///  - a file: a.csv, a.csv.gz;
///  - a pattern with *, ? or [...]: the files that match, sorted by name;
///  - a list: @list, or a name ending in .txt or .list. It has one file or
///    pattern a line, from the list's own folder on; what follows a # at the
///    start of a line or behind a space is a comment.
/// A file with one of these characters in its name is taken before a pattern.
/// Patterns pass over results that lie in `results_folder`: *.frames.csv and
/// summary.csv. Throws InputError for a pattern without a match, a list without
/// a line and no items at all, naming it (and its line).
std::vector<std::string> ExpandLogs(const std::vector<std::string>& items,
                                    const std::string& results_folder = "");

/// The name that a log's results go by: a.csv and a.csv.gz give "a".
std::string LogName(const std::string& path);

/// folder/<LogName>.frames.csv of each log. With `root`, a folder that all logs
/// are below, results lie in `folder` as the logs lie in `root`, and logs of
/// different folders may share a name. Throws InputError if two logs have one
/// result, if a result would overwrite a log, or if a log is not below `root`.
std::vector<std::string> ResultPaths(const std::vector<std::string>& logs,
                                     const std::string& folder,
                                     const std::string& root = "");

}  // namespace finray

#endif  // FINRAY_IO_LOG_LIST_H_
