#include "finray/reconstruction.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "finray/io/csv_cells.h"
#include "finray/perception/perception_files.h"
#include "inside.h"

namespace finray::v1 {
namespace {

// The numbers of a CSV text whose columns are no columns of the frame table.
Table NumbersOfCsv(const std::string& csv, const std::string& name) {
  std::istringstream lines(csv);
  std::deque<std::string> unquoted;
  std::vector<std::string_view> cells;
  std::string header, line;
  std::getline(lines, header);
  SplitCsvLine(header, ',', &cells, &unquoted);
  const std::vector<std::string> names(cells.begin(), cells.end());
  std::vector<std::vector<double>> columns(names.size());
  while (std::getline(lines, line)) {
    SplitCsvLine(line, ',', &cells, &unquoted);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string cell(cells[i]);
      columns[i].push_back(cell.empty() ? std::nan("")
                                        : std::strtod(cell.c_str(), nullptr));
    }
  }
  Table table(columns.empty() ? 0 : columns[0].size(), name);
  for (std::size_t i = 0; i < names.size(); ++i) {
    table.Set(names[i], std::move(columns[i]));
  }
  return table;
}

}  // namespace

Reconstruction Reconstruct(const Finger& finger, const Table& touches,
                           const Scene& scene, double stage_std_mm,
                           const Discretization& discretization) {
  return Guarded([&] {
    if (!(stage_std_mm > 0) || !std::isfinite(stage_std_mm)) {
      throw InputError("stage_std_mm: expected a number above 0");
    }
    const finray::Reconstruction found = finray::Reconstruct(
        ToFrameTable(touches), finger.inside().finger, scene.inside().scene,
        ToInternal(discretization), stage_std_mm);
    return Reconstruction{NumbersOfCsv(OutlineCsv(found, {}), "outline"),
                          NumbersOfCsv(TouchCsv(found), "touches"),
                          found.centroid_mm.x(),
                          found.centroid_mm.y(),
                          found.fit.curve.perimeter_mm(),
                          found.fit.noise_scale,
                          found.supported_share,
                          found.touches.usable.size(),
                          found.touches.all_rows()};
  });
}

}  // namespace finray::v1
