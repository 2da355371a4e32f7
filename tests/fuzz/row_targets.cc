#include <deque>
#include <string>
#include <vector>

#include "finray/batch/live_rows.h"
#include "finray/batch/result_rows.h"
#include "finray/io/csv_cells.h"
#include "finray/io/log_lines.h"
#include "fuzz/feeding.h"
#include "fuzz/targets.h"

namespace finray {

void ReadRenamedTable(std::string_view bytes) {
  const MemoryFile scene(TakeFile(&bytes)), log(bytes);
  Tolerate([&] {
    const auto columns = ReadScene(scene.path()).columns;
    LogLines lines(ReadPipe(log.descriptor(), -1, "log"), "log", columns);
    const FrameParser& parser = lines.parser();
    FrameRows rows;
    while (lines.Next()) {
      rows.Clear();
      parser.Parse(lines.line(), &rows);
    }
  });
}

void ReadEstimateInputs(std::string_view bytes) {
  const MemoryFile finger_file(TakeFile(&bytes));
  const MemoryFile scene_file(TakeFile(&bytes));
  const MemoryFile log(bytes);
  Tolerate([&] {
    const Finger finger = ReadFinger(finger_file.path());
    const Scene scene = ReadScene(scene_file.path());
    RefuseBackContacts(scene);
    LogLines lines(ReadPipe(log.descriptor(), -1, "log"), "log", scene.columns);
    const FrameParser& parser = lines.parser();
    const ResultLayout layout(finger, scene, parser);
    layout.HeaderCsv();
    FrameRows rows;
    Measurements readings;
    while (lines.Next()) {
      rows.Clear();
      parser.Parse(lines.line(), &rows);
      layout.Read(rows, 0, &readings);
    }
  });
}

// One contact: to look for two takes ten times as long.
void FollowRows(std::string_view bytes) {
  static const Scene scene = [] {
    Scene one;
    one.contacts = 1;
    return one;
  }();
  static FrameEstimator estimator(Paper(), scene);
  const MemoryFile file(bytes);
  Tolerate([&] {
    LogLines lines(ReadPipe(file.descriptor(), -1, "stdin"), "stdin", {});
    LiveRows rows(Paper(), scene, lines.parser(), &estimator);
    const std::string names = rows.HeaderCsv();
    std::vector<std::string_view> cells;
    std::deque<std::string> unquoted;
    SplitCsvLine(names.substr(0, names.size() - 1), ',', &cells, &unquoted);
    const std::size_t columns = cells.size();
    for (int i = 0; i < kFollowedRows && lines.Next(); ++i) {
      const std::string& row = rows.Next(lines.line());
      Check(!row.empty() && row.back() == '\n', "a row has no line end");
      SplitCsvLine(std::string_view(row).substr(0, row.size() - 1), ',', &cells,
                   &unquoted);
      Check(cells.size() == columns, "a row has not all cells");
    }
    while (lines.Next()) {
    }
  });
}

}  // namespace finray
