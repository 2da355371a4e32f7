#include <deque>
#include <string>
#include <vector>

#include "finray/io/csv_cells.h"
#include "finray/io/frame_reader.h"
#include "finray/io/pipe_lines.h"
#include "finray/sensing/live_rows.h"
#include "finray/sensing/result_rows.h"
#include "fuzz/feeding.h"
#include "fuzz/targets.h"

namespace finray {

void ReadEstimateInputs(std::string_view bytes) {
  const MemoryFile finger_file(TakeFile(&bytes));
  const MemoryFile scene_file(TakeFile(&bytes));
  const MemoryFile log(bytes);
  Tolerate([&] {
    const Finger finger = ReadFinger(finger_file.path());
    const Scene scene = ReadScene(scene_file.path());
    RefuseBackContacts(scene);
    FrameReader reader(log.path(), scene.columns);
    const ResultLayout layout(finger, scene, reader.parser());
    layout.HeaderCsv();
    LineBlock lines;
    FrameRows rows;
    FrameReadings readings;
    while (reader.ReadLines(64, &lines)) {
      rows.Clear();
      for (std::size_t i = 0; i < lines.size(); ++i) {
        reader.parser().Parse(lines.at(i), &rows);
      }
      for (std::size_t i = 0; i < rows.rows(); ++i) {
        layout.Read(rows, i, &readings);
        layout.ReferenceForce(rows, i);
      }
      if (!lines.error.empty()) throw InputError(lines.error);
    }
  });
}

void FollowRows(std::string_view bytes) {
  const MemoryFile file(bytes);
  Tolerate([&] {
    PipeLines lines(file.descriptor(), -1, "stdin");
    CsvLine header;
    do {
      if (!lines.Next()) return;
      header = lines.line();
    } while (!IsHeaderLine(&header));
    LiveRows rows(Paper(), Scene(), {}, "stdin", header);
    const std::string names = rows.HeaderCsv();
    std::vector<std::string_view> cells;
    std::deque<std::string> unquoted;
    SplitCsvLine(names.substr(0, names.size() - 1), &cells, &unquoted);
    const std::size_t columns = cells.size();
    for (int i = 0; i < kFollowedRows && lines.Next(); ++i) {
      const std::string& row = rows.Next(lines.line());
      Check(!row.empty() && row.back() == '\n', "a row has no line end");
      SplitCsvLine(std::string_view(row).substr(0, row.size() - 1), &cells,
                   &unquoted);
      Check(cells.size() == columns, "a row has not all cells");
    }
    while (lines.Next()) {
    }
  });
}

}  // namespace finray
