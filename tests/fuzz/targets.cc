#include "fuzz/targets.h"

#include <filesystem>
#include <string>
#include <vector>

#include "finray/calib/analysis/calibration_file.h"
#include "finray/calib/problem/plan.h"
#include "finray/control/experiment.h"
#include "finray/io/frame_table.h"
#include "fuzz/feeding.h"

namespace finray {
namespace {

void ReadBack(const FrameTable& table) {
  const std::string csv = table.ToCsv();
  const MemoryFile file(csv);
  const FrameTable again = FrameTable::Read(file.path());
  Check(again.rows() == table.rows(), "rows are lost by writing");
  Check(again.headers() == table.headers(), "headers change by writing");
  Check(again.ToCsv() == csv, "cells change by writing");
}

}  // namespace

void ReadFrameTable(std::string_view bytes) {
  const MemoryFile file(bytes);
  Tolerate([&] {
    const FrameTable table = FrameTable::Read(file.path());
    try {
      ReadBack(table);
    } catch (const InputError& error) {
      Check(false, error.what());
    }
  });
}

void ReadFingerYaml(std::string_view bytes) {
  const MemoryFile file(bytes);
  Tolerate([&] {
    const std::string written = FingerToYaml(ReadFinger(file.path()));
    const MemoryFile copy(written);
    try {
      Check(FingerToYaml(ReadFinger(copy.path())) == written,
            "a finger changes by writing");
    } catch (const InputError& error) {
      Check(false, error.what());
    }
  });
}

void ReadSceneYaml(std::string_view bytes) {
  const MemoryFile file(bytes);
  Tolerate([&] {
    const Scene scene = ReadScene(file.path());
    if (scene.object) ObjectToYaml(*scene.object);
    ContactBeamsToYaml(scene);
  });
}

void ReadPlanYaml(std::string_view bytes) {
  const MemoryFile file(bytes);
  Tolerate([&] { ReadPlan(file.path()); });
}

void ReadExperimentYaml(std::string_view bytes) {
  const MemoryFile file(bytes);
  Tolerate([&] { ReadExperiment(file.path(), Paper()); });
}

void ReadCalibrationYaml(std::string_view bytes) {
  // The finger lies in the same folder, so that this one is of its own.
  static const std::string folder = [] {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "finray_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) std::abort();
    std::filesystem::copy(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml",
                          pattern + "/finger.yaml");
    static const std::string made = pattern;
    std::atexit([] { std::filesystem::remove_all(made); });
    return pattern;
  }();
  const MemoryFile file(bytes);
  const std::string path = folder + "/calibration.yaml";
  std::filesystem::remove(path);
  std::filesystem::create_symlink(file.path(), path);
  Tolerate([&] {
    const CalibrationFile calibration = ReadCalibration(path);
    std::vector<std::string> names;
    for (const auto& parameter : calibration.parameters) {
      if (names.size() < 20) names.push_back(parameter.name);
    }
    calibration.Covariance(names);
  });
}

}  // namespace finray
