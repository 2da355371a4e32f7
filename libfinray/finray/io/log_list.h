#ifndef FINRAY_IO_LOG_LIST_H_
#define FINRAY_IO_LOG_LIST_H_

#include <string>
#include <vector>

namespace finray {

/// Expands the items of a --logs flag into logs, in their order. An item is
///  - a file: a.csv, a.csv.gz;
///  - a folder: the logs in it, *.csv and *.csv.gz, sorted by name;
///  - a pattern with *, ? or [...]: the files that match, sorted by name. ** as
///    a part of the path stands for any folders, none too, and at its end for
///    all logs in them. Hidden folders and links to folders are passed over;
///  - a list: @list, or a name that ends in .txt or .list. Each line has a file
///    or pattern, relative to the list's own folder. A # at the start of a line
///    or after a space begins a comment.
/// A file whose name looks like a pattern is taken as a file. Folders and
/// patterns skip the results below `results_folder`: *.frames.csv,
/// *.bad_rows.csv and summary.csv. Throws InputError, with the item (and its
/// line), for a folder or a pattern without a log, a list without logs, and for
/// no items.
std::vector<std::string> ExpandLogs(const std::vector<std::string>& items,
                                    const std::string& results_folder = "");

/// Returns the name of a log in its results: "a" for a.csv and a.csv.gz.
std::string LogName(const std::string& path);

/// Returns folder/<LogName>.frames.csv for each log. With `root`, a folder
/// above all logs, `folder` gets the subfolders of `root`, and logs of
/// different folders may share a name. Throws InputError if two logs have the
/// same result, if a result would overwrite a log, or if a log is not below
/// `root`.
std::vector<std::string> ResultPaths(const std::vector<std::string>& logs,
                                     const std::string& folder,
                                     const std::string& root = "");

}  // namespace finray

#endif  // FINRAY_IO_LOG_LIST_H_
