// Contact location and force of every frame of a log, from its gauges.

#include <algorithm>
#include <filesystem>
#include <set>

#include "app.h"
#include "finray/io/atomic_file.h"
#include "finray/sensing/batch_estimation.h"

DEFINE_string(finger, "", "finger YAML, best a calibrated one");
DEFINE_string(scene, "", "scene YAML; without it contacts: auto");
DEFINE_string(logs, "", "CSV logs with gauge_<j>_V, separated by commas");
DEFINE_string(out_dir, "", "folder for <log>.frames.csv and summary.yaml");
DEFINE_int32(threads, 1, "threads over frames");
DEFINE_string(scheme, "taylor", "rigid_chain or taylor");
DEFINE_int32(resolution, 0, "elements over both beams; 0: default");
DEFINE_bool(dump_config, false, "print what is in force, and stop");
DEFINE_bool(strict, false, "fail if any frame is not_converged or bad_input");

namespace {

using finray::EstimationSummary;
using finray::FrameStatus;

constexpr FrameStatus kStatuses[] = {
    FrameStatus::kOk, FrameStatus::kNoContact, FrameStatus::kUnobservable,
    FrameStatus::kNotConverged, FrameStatus::kBadInput};

// a.csv, a.csv.gz -> a
std::string LogName(const std::string& path) {
  std::string name = std::filesystem::path(path).filename().string();
  for (const char* ending : {".gz", ".csv"}) {
    const std::string end = ending;
    if (name.size() > end.size() &&
        name.compare(name.size() - end.size(), end.size(), end) == 0) {
      name.resize(name.size() - end.size());
    }
  }
  return name;
}

void EmitSummary(const EstimationSummary& summary, YAML::Emitter* yaml) {
  *yaml << YAML::Key << "frames" << YAML::Value << summary.frames;
  *yaml << YAML::Key << "status" << YAML::Value << YAML::BeginMap;
  for (const FrameStatus status : kStatuses) {
    *yaml << YAML::Key << StatusName(status) << YAML::Value
          << summary.count(status);
  }
  *yaml << YAML::EndMap;
  if (summary.force_compared > 0) {
    *yaml << YAML::Key << "force_compared_frames" << YAML::Value
          << summary.force_compared;
    *yaml << YAML::Key << "force_rms_error_N" << YAML::Value
          << finray::NumberText(summary.force_rms_N);
    *yaml << YAML::Key << "force_max_error_N" << YAML::Value
          << finray::NumberText(summary.force_max_N);
  }
}

int Run() {
  using namespace finray;
  const Finger finger = ReadFinger(Required("finger", FLAGS_finger));
  const Scene scene = FLAGS_scene.empty() ? Scene() : ReadScene(FLAGS_scene);
  const auto logs = SplitList(Required("logs", FLAGS_logs));
  const std::string& out_dir = Required("out_dir", FLAGS_out_dir);
  const Discretization discretization =
      ParseDiscretization(FLAGS_scheme, FLAGS_resolution);
  if (FLAGS_dump_config) {
    DumpConfig(finger, scene, discretization);
    return kGood;
  }
  std::set<std::string> names;
  for (const std::string& log : logs) {
    if (!names.insert(LogName(log)).second) {
      throw InputError("--logs: two logs are called '" + LogName(log) +
                       "', so their results would have one name");
    }
  }
  // All logs are read before anything is written.
  std::vector<FrameTable> tables;
  for (const std::string& log : logs) {
    tables.push_back(FrameTable::Read(log, scene.columns));
  }

  YAML::Emitter yaml;
  yaml << YAML::BeginMap << YAML::Key << "finger" << YAML::Value << finger.name
       << YAML::Key << "scheme" << YAML::Value << FLAGS_scheme << YAML::Key
       << "version" << YAML::Value << FINRAY_VERSION << YAML::Key << "logs"
       << YAML::Value << YAML::BeginSeq;
  EstimationSummary all;
  double squares = 0;
  for (FrameTable& log : tables) {
    const std::string& path = log.path();
    const EstimationSummary summary =
        EstimateLog(finger, scene, discretization, FLAGS_threads, &log);
    MakeFolder(out_dir);
    const std::string out =
        (std::filesystem::path(out_dir) / (LogName(path) + ".frames.csv"))
            .string();
    log.Write(out);
    yaml << YAML::BeginMap << YAML::Key << "log" << YAML::Value << path
         << YAML::Key << "result" << YAML::Value << out;
    EmitSummary(summary, &yaml);
    yaml << YAML::EndMap;
    all.frames += summary.frames;
    for (std::size_t i = 0; i < all.by_status.size(); ++i) {
      all.by_status[i] += summary.by_status[i];
    }
    const auto n = static_cast<double>(summary.force_compared);
    squares += n * summary.force_rms_N * summary.force_rms_N;
    all.force_compared += summary.force_compared;
    all.force_max_N = std::max(all.force_max_N, summary.force_max_N);
  }
  if (all.force_compared > 0) {
    all.force_rms_N =
        std::sqrt(squares / static_cast<double>(all.force_compared));
  }
  yaml << YAML::EndSeq << YAML::Key << "all" << YAML::Value << YAML::BeginMap;
  EmitSummary(all, &yaml);
  yaml << YAML::EndMap << YAML::EndMap;
  const std::string summary_path =
      (std::filesystem::path(out_dir) / "summary.yaml").string();
  WriteFileAtomically(summary_path, std::string(yaml.c_str()) + "\n");

  std::cout << summary_path << "\n"
            << "frames         " << all.frames << " in " << logs.size()
            << (logs.size() == 1 ? " log\n" : " logs\n") << "ok             "
            << all.count(FrameStatus::kOk) << ", no_contact "
            << all.count(FrameStatus::kNoContact) << "\n"
            << "unobservable   " << all.count(FrameStatus::kUnobservable)
            << "\n"
            << "not solved     " << all.count(FrameStatus::kNotConverged)
            << " not_converged, " << all.count(FrameStatus::kBadInput)
            << " bad_input\n";
  if (all.force_compared > 0) {
    std::cout << "force error    " << all.force_rms_N << " N rms, "
              << all.force_max_N << " N at most, over " << all.force_compared
              << " frames\n";
  } else {
    std::cout << "force error    not known: no force_N in the logs\n";
  }
  const std::size_t unsolved =
      all.count(FrameStatus::kNotConverged) + all.count(FrameStatus::kBadInput);
  return unsolved == all.frames || (FLAGS_strict && unsolved > 0) ? kSolveFailed
                                                                  : kGood;
}

}  // namespace

int main(int argc, char** argv) {
  return finray::RunApp(
      argc, argv,
      "Contact location and force from the gauges of every frame.\n"
      "finray_estimate --finger F.yaml --logs a.csv,b.csv --out_dir D "
      "[--scene S.yaml]",
      Run);
}
