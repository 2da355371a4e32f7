// Pages that show the results of finray_estimate.

#include <cstdio>
#include <filesystem>
#include <optional>

#include "app.h"
#include "finray/view/log_channels.h"
#include "finray/view/view_files.h"
#include "progress_bar.h"

DEFINE_string(results, "",
              "results of finray_estimate, separated by commas: folders with a "
              "summary.yaml, or <log>.frames.csv");
DEFINE_string(finger, "",
              "finger YAML of the results; without it pages have neither the "
              "finger's shape nor the residuals of its gauges");
DEFINE_string(out_dir, "", "folder for <log>.html and, of folders, index.html");
DEFINE_bool(compare, false, "one page with both of two <log>.frames.csv");

namespace {

using namespace finray;
namespace fs = std::filesystem;

int ViewFolders(const std::vector<std::string>& folders, const Finger* finger) {
  std::vector<BatchResults> batches;
  std::vector<std::vector<ViewJob>> jobs;
  std::vector<ViewJob> all;
  for (const std::string& folder : folders) {
    batches.push_back(ReadBatchResults(folder));
    if (finger != nullptr && batches.back().finger != finger->name) {
      Warn("the results in " + folder + " are of the finger " +
               batches.back().finger + ", --finger is " + finger->name,
           "shapes and residuals are those of --finger");
    }
    // The logs of several batches may have equal names.
    fs::path pages = FLAGS_out_dir;
    if (folders.size() > 1) {
      pages /= (fs::path(folder) / "").parent_path().filename();
    }
    jobs.push_back(JobsOf(batches.back(), pages.string()));
    all.insert(all.end(), jobs.back().begin(), jobs.back().end());
  }
  RefuseSamePages(all);
  const std::string index = OutPath("index.html");
  ProgressBar bar(all.size());
  WriteBatchPages(batches, jobs, index, finger, DiscretizationFlags(),
                  [&] { bar.Add(1, false); });
  bar.Clear();
  std::printf("%s\nlogs           %zu\n", index.c_str(), all.size());
  return kGood;
}

int ViewTables(const std::vector<std::string>& tables, const Finger* finger) {
  std::vector<ViewJob> jobs;
  for (const std::string& table : tables) {
    jobs.push_back({table, PagePath(table, FLAGS_out_dir)});
  }
  RefuseSamePages(jobs);
  for (const ViewJob& job : jobs) {
    WriteLogPage(job, {}, finger, DiscretizationFlags());
    std::printf("%s\n", job.page.c_str());
  }
  return kGood;
}

int Run() {
  const std::vector<std::string> results =
      SplitList(Required("results", FLAGS_results));
  Required("out_dir", FLAGS_out_dir);
  std::optional<Finger> finger;
  if (!FLAGS_finger.empty()) finger = ReadFinger(FLAGS_finger);
  const Finger* known = finger ? &*finger : nullptr;
  std::size_t folders = 0;
  for (const std::string& result : results) {
    folders += fs::is_directory(result);
  }
  if (FLAGS_compare) {
    if (results.size() != 2 || folders > 0 || results[0] == results[1]) {
      throw UsageError(
          "--compare: expected two different <log>.frames.csv in --results");
    }
    const std::string page = OutPath(ResultName(results[0]) + "_and_" +
                                     ResultName(results[1]) + ".html");
    WriteComparison(results[0], results[1], page, known, DiscretizationFlags());
    std::printf("%s\n", page.c_str());
    return kGood;
  }
  if (folders == 0) return ViewTables(results, known);
  if (folders < results.size()) {
    throw UsageError(
        "--results: expected only folders or only <log>.frames.csv");
  }
  return ViewFolders(results, known);
}

}  // namespace

const finray::App finray::kApp = {
    "Pages that show results: the finger, forces, places, residuals.\n"
    "finray_view --results D --out_dir V [--finger F.yaml]\n"
    "finray_view --results a.frames.csv,b.frames.csv --compare --out_dir V "
    "[--finger F.yaml]",
    Run};
