#include "finray/io/log_lines.h"

#include <filesystem>
#include <utility>

#include "finray/io/csv_cells.h"
#include "finray/io/error.h"
#include "finray/io/log_header.h"

namespace finray {
namespace {

// How far the header and the decimal mark are looked for.
constexpr std::size_t kHeaderLines = 100, kDecimalLines = 1000;
constexpr std::size_t kMostAheadBytes = 1 << 20;

// A finger or a plan in place of a log would be a table of one column.
bool IsYamlName(const std::string& name) {
  const auto extension = std::filesystem::path(name).extension();
  return extension == ".yaml" || extension == ".yml";
}

}  // namespace

LogLines::LogLines(LineReader lines, const std::string& name,
                   const ColumnMapping& mapping)
    : lines_(std::move(lines)),
      parser_(name, FindHeader(name, mapping), mapping) {
  lines_.KeepTabs(parser_.delimiter() == '\t');
}

CsvLine LogLines::FindHeader(const std::string& name,
                             const ColumnMapping& mapping) {
  CsvLine line;
  std::size_t best = 0, most = 0;
  // Tabs that delimit empty cells make no blank line.
  lines_.KeepTabs(true);
  while (ahead_.size() < kHeaderLines && ahead_.bytes() < kMostAheadBytes &&
         lines_.Next()) {
    line = lines_.line();
    const bool stated = mapping.header_line == line.number;
    if (mapping.header_line && !stated) {
      if (line.number < *mapping.header_line) continue;
      break;
    }
    const bool may_be = MayBeHeader(&line);
    if (stated) return line;
    if (!may_be && ahead_.size() == 0) continue;
    const KnownNames names =
        may_be ? FindKnownNames(line.text, mapping) : KnownNames();
    if (names.suffice) {
      ahead_.Clear();
      return line;
    }
    if (names.count > most) {
      most = names.count;
      best = ahead_.size();
    }
    ahead_.Add(line);
  }
  if (mapping.header_line) {
    throw InputError(name + ":" + std::to_string(*mapping.header_line) +
                     ": expected the header, as header_line says, found no "
                     "such line, or a blank one");
  }
  if (ahead_.size() == 0) {
    throw InputError(name + ": is empty, expected a header and rows");
  }
  if (most == 0 && IsYamlName(name)) {
    throw InputError(name +
                     ": is a YAML file, expected a log: a CSV table with a "
                     "header and rows");
  }
  next_ahead_ = best + 1;
  return ahead_.at(best);
}

bool LogLines::NextLine() {
  while (next_ahead_ < ahead_.size()) {
    line_ = ahead_.at(next_ahead_++);
    if (parser_.delimiter() == '\t' || !Trimmed(line_.text).empty())
      return true;
  }
  if (!lines_.Next()) return false;
  line_ = lines_.line();
  return true;
}

bool LogLines::SkipUnits() {
  looked_for_units_ = true;
  return !parser_.TakeUnits(line_) || NextLine();
}

bool LogLines::Next() {
  if (waits_) {
    waits_ = false;
    return true;
  }
  if (!NextLine()) return false;
  if (!looked_for_units_ && !SkipUnits()) return false;
  if (!parser_.decimal_settled()) parser_.LearnDecimal(line_);
  return true;
}

void LogLines::FindDecimal() {
  const bool any = Next();
  if (parser_.decimal_settled() || !any) {
    waits_ = any;
    return;
  }
  // The row that waits and those behind it.
  LineBlock rows;
  do {
    rows.Add(line_);
    parser_.LearnDecimal(line_);
  } while (!parser_.decimal_settled() && rows.size() < kDecimalLines &&
           rows.bytes() < kMostAheadBytes && NextLine());
  while (next_ahead_ < ahead_.size()) rows.Add(ahead_.at(next_ahead_++));
  ahead_ = std::move(rows);
  next_ahead_ = 0;
  parser_.SettleDecimal();
  waits_ = Next();
}

}  // namespace finray
