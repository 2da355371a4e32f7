// Sets the offsets of a finger's gauges from rows in which it is free.

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "app.h"
#include "finray/estimation/zeroed_finger.h"
#include "finray/io/atomic_file.h"
#include "finray/io/frame_table.h"
#include "finray/io/line_reader.h"
#include "finray/io/log_lines.h"
#include "finray/io/number_text.h"
#include "finray/scene/measurement_columns.h"

DEFINE_string(finger, "", "finger YAML to zero");
DEFINE_string(scene, "", "scene YAML, for its columns and its friction");
DEFINE_string(logs, "", "CSV log with free rows");
DEFINE_string(out, "", "finger YAML to write: all but the offsets stays");
DEFINE_string(zero_rows, "",
              "free rows, first:last, counted from 1; default: the rows whose "
              "force is within noise of zero, live 1:100");
DEFINE_bool(allow_touch, false,
            "zero even if a contact explains the rows, where none is there, or "
            "a gauge does not move, where a converter has coarse steps");
DEFINE_double(force_std_N, 0.02,
              "noise of each axis of the force, to tell free rows");
DEFINE_bool(follow, false,
            "read a live log from standard input, up to the last row needed");

namespace {

using namespace finray;

struct Range {
  std::size_t first = 1, last = 100;
};

Range ZeroRows() {
  Range range;
  if (FLAGS_zero_rows.empty()) return range;
  char rest = 0;
  if (std::sscanf(FLAGS_zero_rows.c_str(), "%zu:%zu%c", &range.first,
                  &range.last, &rest) != 2 ||
      range.first < 1 || range.last < range.first) {
    throw UsageError("--zero_rows: expected first:last, such as 1:100, found " +
                     FLAGS_zero_rows);
  }
  return range;
}

std::vector<Measurements> FreeRows(const std::vector<Measurements>& rows,
                                   const std::string& source) {
  std::vector<Measurements> free;
  if (!FLAGS_zero_rows.empty()) {
    const Range range = ZeroRows();
    if (range.last > rows.size()) {
      throw InputError(source + ": --zero_rows " + FLAGS_zero_rows +
                       ": the log has " + std::to_string(rows.size()) +
                       " rows");
    }
    free.assign(rows.begin() + static_cast<long>(range.first) - 1,
                rows.begin() + static_cast<long>(range.last));
    return free;
  }
  bool any_force = false;
  for (const Measurements& row : rows) {
    const MeasuredForce force = row.Force();
    any_force |= force.IsMeasured();
    if (force.IsWithinNoise(FLAGS_force_std_N)) free.push_back(row);
  }
  if (!any_force) {
    throw InputError(source +
                     ": no force_N tells which rows are free; choose them with "
                     "--zero_rows first:last");
  }
  return free;
}

// Copies standard input up to the last row that is needed to a table.
std::vector<Measurements> LiveRows(const Finger& finger,
                                   const ColumnMapping& mapping) {
  LogLines lines(ReadPipe(STDIN_FILENO, -1, "stdin"), "stdin", mapping);
  const FrameParser& parser = lines.parser();
  const MeasurementColumns columns(finger, parser.names(), "stdin", {});
  const Range range = ZeroRows();
  std::vector<Measurements> rows;
  FrameRows cells;
  for (std::size_t row = 1; row <= range.last && lines.Next(); ++row) {
    cells.Clear();
    parser.Parse(lines.line(), &cells);
    if (row < range.first) continue;
    columns.Read([&](std::size_t column) { return cells.at(0, column).number; },
                 &rows.emplace_back());
  }
  return rows;
}

int Run() {
  const Finger finger = ReadFinger(Required("finger", FLAGS_finger));
  const std::string& out = Required("out", FLAGS_out);
  const Discretization discretization = DiscretizationFlags();
  const Scene scene = FLAGS_scene.empty() ? Scene() : ReadScene(FLAGS_scene);
  const ColumnMapping& mapping = scene.columns;
  std::vector<Measurements> all, free;
  const std::string source =
      FLAGS_follow ? "stdin" : Required("logs", FLAGS_logs);
  if (FLAGS_follow) {
    free = LiveRows(finger, mapping);
  } else {
    all = ReadMeasurements(FrameTable::Read(source, mapping), finger, {});
    free = FreeRows(all, source);
  }
  const ZeroedFinger zeroed =
      ZeroGauges(finger, discretization, free, source,
                 {scene.friction_coefficient, FLAGS_allow_touch, &all});
  WriteFileAtomically(
      out, FingerToYaml(zeroed.finger,
                        "Zeroed by " + source + " from " + FLAGS_finger));
  std::printf("%s\nfree rows      %zu\n", out.c_str(), zeroed.rows);
  for (std::size_t j = 0; j < zeroed.change_V.size(); ++j) {
    std::printf(
        "gauge %-2zu       offset %+.5g V, moved by %+.3g mV, std %.2g "
        "mV\n",
        j + 1, zeroed.finger.gauges[j].offset_V, 1e3 * zeroed.change_V[j],
        1e3 * zeroed.std_V[j]);
  }
  for (std::size_t j = 0; j < zeroed.scatter_V.size(); ++j) {
    const double noise_V = zeroed.finger.gauges[j].noise_V;
    if (zeroed.fewest < kFewZeroRows ||
        zeroed.scatter_V[j] > kStill * noise_V) {
      continue;
    }
    std::fprintf(stderr,
                 "warning: gauge %zu hardly moves, by %.2g mV in %zu rows; its "
                 "noise_V is %.2g mV: look whether it is dead, stuck or in "
                 "another unit\n",
                 j + 1, 1e3 * zeroed.scatter_V[j], zeroed.rows, 1e3 * noise_V);
  }
  if (zeroed.fewest < kFewZeroRows) {
    std::fprintf(stderr,
                 "warning: %zu readings of a gauge are few: the std of offsets "
                 "are no less than noise_V / sqrt(%zu); give %zu rows or "
                 "more\n",
                 zeroed.fewest, zeroed.fewest, kFewZeroRows);
  }
  return kGood;
}

}  // namespace

const finray::App finray::kApp = {
    "Zeroes the gauges of a finger by rows in which it is free.\n"
    "finray_zero --finger F.yaml --logs free.csv --out F2.yaml [--scene "
    "S.yaml] [--zero_rows 1:100]\n"
    "sensor | finray_zero --follow --finger F.yaml --out F2.yaml",
    Run};
