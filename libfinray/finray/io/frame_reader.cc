#include "finray/io/frame_reader.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/io/nearest_name.h"
#include "finray/io/parse_number.h"
#include "finray/io/shown_text.h"

namespace finray {
namespace {

// All renames refer to the names in the file, so that two columns can be
// swapped.
std::vector<std::string> Renamed(
    const std::string& path, const std::vector<std::string>& found,
    const std::map<std::string, std::string>& renames) {
  std::vector<std::string> headers = found;
  for (const auto& [key, value] : renames) {
    // {lab's header: our name}, or the other way round.
    const bool reversed = IsFrameColumn(key) && !IsFrameColumn(value);
    const std::string& from = reversed ? value : key;
    const std::string& to = reversed ? key : value;
    if (!IsFrameColumn(to) && to != "status") {
      throw InputError(path + ": column '" + from + "' is to be renamed to '" +
                       to + "', which no tool knows" +
                       DidYouMeanFrameColumn(to));
    }
    const auto at = std::find(found.begin(), found.end(), from);
    if (at == found.end()) {
      throw InputError(path + ": no column '" + from + "' to rename to '" + to +
                       "'" + DidYouMean(from, found));
    }
    headers[static_cast<std::size_t>(at - found.begin())] = to;
  }
  return headers;
}

std::vector<std::string> ReadHeaders(
    CsvReader* reader, const std::string& path,
    const std::map<std::string, std::string>& renames) {
  if (!reader->NextHeader()) {
    throw InputError(path + ": is empty, expected a header and rows");
  }
  const std::size_t nul = reader->FirstNul();
  if (nul < reader->cells().size()) {
    reader->FailAt(nul, "the header holds a NUL byte, expected UTF-8 text");
  }
  const std::vector<std::string> headers =
      Renamed(path, {reader->cells().begin(), reader->cells().end()}, renames);
  if (std::all_of(headers.begin(), headers.end(), ParseNumber)) {
    reader->Fail("expected a header, found numbers only");
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < headers.size(); ++i) {
    if (!seen.insert(headers[i]).second) {
      reader->FailAt(i, "header " + ShownText(headers[i]) + " appears twice");
    }
  }
  return headers;
}

bool IsNan(std::string_view text) {
  // printf writes the sign of a NaN.
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    text.remove_prefix(1);
  }
  return text.size() == 3 && (text[0] | 0x20) == 'n' &&
         (text[1] | 0x20) == 'a' && (text[2] | 0x20) == 'n';
}

// Number of a cell, NaN for one that was not measured.
std::optional<double> CellNumber(std::string_view text) {
  text = Trimmed(text);  // of what quotes have kept
  if (text.empty() || IsNan(text)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return ParseNumber(text);
}

}  // namespace

FrameReader::FrameReader(const std::string& path,
                         const std::map<std::string, std::string>& renames)
    : path_(path),
      reader_(path),
      headers_(ReadHeaders(&reader_, path, renames)) {}

bool FrameReader::Read(std::size_t rows, FrameTable* table) {
  *table = FrameTable();
  table->path_ = path_;
  for (const std::string& name : headers_) {
    if (IsFrameColumn(name)) {
      table->columns_.push_back({name, std::vector<double>()});
    } else {
      table->columns_.push_back({name, std::vector<std::string>()});
    }
  }
  while (table->rows_ < rows && reader_.NextRow()) ReadRow(table);
  position_ += table->rows_;
  if (position_ == 0 && rows > 0) {
    throw InputError(path_ + ": is an empty log: it has a header but no rows");
  }
  return table->rows_ > 0;
}

void FrameReader::ReadRow(FrameTable* table) const {
  const auto& cells = reader_.cells();
  if (cells.size() != headers_.size()) {
    reader_.Fail("expected " + std::to_string(headers_.size()) +
                 " cells as in the header, found " +
                 std::to_string(cells.size()));
  }
  const std::size_t nul = reader_.FirstNul();
  if (nul < cells.size()) {
    reader_.FailAt(
        nul, headers_[nul] + ": the cell holds a NUL byte, expected text");
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    auto& column = table->columns_[i].cells;
    if (auto* texts = std::get_if<std::vector<std::string>>(&column)) {
      texts->emplace_back(cells[i]);
      continue;
    }
    const std::optional<double> number = CellNumber(cells[i]);
    if (!number) {
      reader_.FailAt(
          i, headers_[i] + ": expected a number, found " + ShownText(cells[i]));
    }
    std::get<std::vector<double>>(column).push_back(*number);
  }
  table->lines_.push_back(reader_.line());
  ++table->rows_;
}

std::size_t FrameReader::Skip(std::size_t rows) {
  std::size_t skipped = 0;
  while (skipped < rows && reader_.SkipRow()) ++skipped;
  position_ += skipped;
  return skipped;
}

FrameTable FrameTable::Read(const std::string& path,
                            const std::map<std::string, std::string>& renames) {
  FrameTable table;
  FrameReader(path, renames)
      .Read(std::numeric_limits<std::size_t>::max(), &table);
  return table;
}

}  // namespace finray
