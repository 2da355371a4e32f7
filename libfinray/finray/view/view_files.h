#ifndef FINRAY_VIEW_VIEW_FILES_H_
#define FINRAY_VIEW_VIEW_FILES_H_

#include <functional>
#include <string>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/view/batch_results.h"

namespace finray {

/// A result and where its page goes.
struct ViewJob {
  std::string result, page;
};

/// Writes the page of one log. `warnings` are those of its batch.
void WriteLogPage(const ViewJob& job, const std::vector<Warning>& warnings,
                  const Finger* finger, const Discretization& discretization);

/// Writes a page with two logs of one finger.
void WriteComparison(const std::string& result, const std::string& other,
                     const std::string& page, const Finger* finger,
                     const Discretization& discretization);

/// Returns F/a.html for the result a.frames.csv and a folder F. index.html is
/// the page of all logs, so that of a log `index` is index_log.html.
std::string PagePath(const std::string& result, const std::string& folder);

/// Returns the jobs of a batch: pages lie in `folder` as results lie in the
/// batch's folder.
std::vector<ViewJob> JobsOf(const BatchResults& batch,
                            const std::string& folder);

/// Throws InputError if two results have one page, as `index` and `index_log`
/// have.
void RefuseSamePages(const std::vector<ViewJob>& jobs);

/// Removes a page of an earlier run, which would no longer be true. A file of
/// that name that finray has not written stays.
void RemoveOldPage(const std::string& page);

/// Writes the page of each log and, last, `index`, the page of all of them.
/// `jobs` holds the jobs of each batch. `progress` is called behind each log.
/// All throw InputError for a result that cannot be read and a page that cannot
/// be written.
void WriteBatchPages(const std::vector<BatchResults>& batches,
                     const std::vector<std::vector<ViewJob>>& jobs,
                     const std::string& index, const Finger* finger,
                     const Discretization& discretization,
                     const std::function<void()>& progress);

}  // namespace finray

#endif  // FINRAY_VIEW_VIEW_FILES_H_
