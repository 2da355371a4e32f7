#ifndef FINRAY_TESTS_FUZZ_TARGETS_H_
#define FINRAY_TESTS_FUZZ_TARGETS_H_

#include <cstddef>
#include <string_view>
#include <utility>

namespace finray {

// What tools do with a file before they solve anything, on bytes that may be
// anything. Each takes InputError for an answer, as it says what is wrong with
// the bytes; whatever else is thrown, crashes or hangs is a mistake. What is
// read well is written and read again, which has to work too.

/// A log, plain or gzipped.
void ReadFrameTable(std::string_view bytes);
/// A scene and a log whose headers it renames, between them a line kNextFile.
void ReadRenamedTable(std::string_view bytes);
void ReadFingerYaml(std::string_view bytes);
void ReadSceneYaml(std::string_view bytes);
/// Scenes that a plan or an experiment refers to are not there.
void ReadPlanYaml(std::string_view bytes);
/// For the paper's finger.
void ReadExperimentYaml(std::string_view bytes);
/// calibration.yaml, with the paper's finger beside it.
void ReadCalibrationYaml(std::string_view bytes);
/// Finger, scene and log as finray_estimate checks them, between them lines
/// kNextFile. Frames are read, not solved.
void ReadEstimateInputs(std::string_view bytes);
/// A log as `finray_estimate --follow` takes it. The first kFollowedRows rows
/// are estimated, with the paper's finger and one contact.
void FollowRows(std::string_view bytes);

constexpr std::string_view kNextFile = "\n=====\n";
constexpr int kFollowedRows = 8;

/// All of them; their seeds are in corpus/<name>.
struct Target {
  const char* name;
  void (*run)(std::string_view bytes);
};
constexpr Target kTargets[] = {
    {"frame_table", ReadFrameTable},
    {"renamed_table", ReadRenamedTable},
    {"finger", ReadFingerYaml},
    {"scene", ReadSceneYaml},
    {"plan", ReadPlanYaml},
    {"experiment", ReadExperimentYaml},
    {"calibration", ReadCalibrationYaml},
    {"estimate_inputs", ReadEstimateInputs},
    {"follow", FollowRows},
};

}  // namespace finray

#endif  // FINRAY_TESTS_FUZZ_TARGETS_H_
