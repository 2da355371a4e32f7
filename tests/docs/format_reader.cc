// Reads files as the executables do and says what they are told, for
// scripts/site/format_tables.py, which makes the tables of
// docs/reference/formats.md of these answers.
//
//   format_reader finger|scene|plan|experiment    reads the file whose path is
//     on a line of stdin; each answer is a line: empty, or the error
//   format_reader columns     column and unit of each column of a log
//   format_reader estimates   the columns that an estimate may have
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "finray/batch/result_rows.h"
#include "finray/calib/problem/plan.h"
#include "finray/control/experiment.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/io/units.h"
#include "finray/scene/scene.h"

namespace finray {
namespace {

constexpr const char* kFinger =
    FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml";

int AnswerFiles(const std::function<void(const std::string&)>& read) {
  for (std::string path; std::getline(std::cin, path);) {
    std::string answer;
    try {
      read(path);
    } catch (const InputError& error) {
      answer = error.what();
    }
    std::cout << answer << std::endl;
  }
  return 0;
}

int ListColumns() {
  for (const std::string& pattern : FrameColumnPatterns()) {
    std::string column = pattern;
    const auto hash = column.find('#');
    if (hash != std::string::npos) column[hash] = '1';
    std::cout << pattern << "\t" << UnitOfColumn(column).name << "\n";
  }
  return 0;
}

// The finger and the scene leave out nothing.
int ListEstimates() {
  Scene scene;
  scene.contacts = 2;
  scene.friction_coefficient = 0.3;
  scene.search_iteration_limit = 50;
  scene.gauge_offset_walk = {0.05, 0.001};
  const ResultColumns columns(ReadFinger(std::string(kFinger)), scene);
  for (const std::string& name : columns.names()) std::cout << name << "\n";
  std::cout << "status\n";
  return 0;
}

int Main(const std::string& what) {
  if (what == "columns") return ListColumns();
  if (what == "estimates") return ListEstimates();
  const Finger finger = ReadFinger(std::string(kFinger));
  const std::map<std::string, std::function<void(const std::string&)>> readers =
      {{"finger", [](const std::string& path) { ReadFinger(path); }},
       {"scene", [](const std::string& path) { ReadScene(path); }},
       {"plan", [](const std::string& path) { ReadPlan(path); }},
       {"experiment",
        [&finger](const std::string& path) { ReadExperiment(path, finger); }}};
  const auto reader = readers.find(what);
  if (reader == readers.end()) {
    std::cerr << "expected finger, scene, plan, experiment, columns or "
                 "estimates\n";
    return 1;
  }
  return AnswerFiles(reader->second);
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  return finray::Main(argc == 2 ? argv[1] : "");
}
