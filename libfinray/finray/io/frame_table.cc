#include "finray/io/frame_table.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "finray/io/atomic_file.h"
#include "finray/io/csv_cells.h"
#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/io/message_text.h"
#include "finray/io/nan.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// Returns the gzipped content.
std::string Gzipped(const std::string& content) {
  z_stream stream = {};
  // 15 + 16: the largest window, with a gzip header.
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15 + 16, 8,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::runtime_error("zlib cannot be started");
  }
  std::string zipped;
  std::string chunk(1 << 18, '\0');
  std::size_t done = 0;
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    // zlib counts in 32 bits, and tables may be longer than that.
    constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
    const std::size_t piece = std::min(content.size() - done, kMost);
    stream.next_in =
        reinterpret_cast<Bytef*>(const_cast<char*>(content.data() + done));
    stream.avail_in = static_cast<uInt>(piece);
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    state = deflate(&stream,
                    done + piece == content.size() ? Z_FINISH : Z_NO_FLUSH);
    done += piece - stream.avail_in;
    zipped.append(chunk, 0, chunk.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  return zipped;
}

using Numeric = std::vector<double>;
using Texts = std::vector<std::string>;

}  // namespace

std::vector<std::string> FrameTable::headers() const {
  std::vector<std::string> names;
  for (const Column& column : columns_) names.push_back(column.name);
  return names;
}

const FrameTable::Column* FrameTable::Find(const std::string& name) const {
  const auto at = std::find_if(
      columns_.begin(), columns_.end(),
      [&name](const Column& column) { return column.name == name; });
  return at == columns_.end() ? nullptr : &*at;
}

template <typename Cells>
const Cells& FrameTable::CellsAs(const Column& column) const {
  const auto* cells = std::get_if<Cells>(&column.cells);
  if (cells != nullptr) return *cells;
  const bool numeric = std::is_same_v<Cells, Numeric>;
  throw InputError(
      Name() + ": column " + ShownText(column.name) + " holds " +
      (numeric ? "text, expected numbers" : "numbers, expected text"));
}

template <typename Cells>
Cells& FrameTable::MutableCells(const std::string& name,
                                const typename Cells::value_type& missing) {
  if (const Column* column = Find(name)) {
    return const_cast<Cells&>(CellsAs<Cells>(*column));
  }
  columns_.push_back({name, Cells(rows_, missing)});
  return std::get<Cells>(columns_.back().cells);
}

bool FrameTable::Has(const std::string& name) const {
  return Find(name) != nullptr;
}

const std::vector<double>& FrameTable::Numbers(const std::string& name) const {
  if (const Column* column = Find(name)) return CellsAs<Numeric>(*column);
  throw InputError(Name() + ": " + NoColumn(name, headers()));
}

std::vector<double> FrameTable::NumbersOrNan(const std::string& name) const {
  if (Has(name)) return Numbers(name);
  return std::vector<double>(rows_, kNaN);
}

bool FrameTable::IsText(const std::string& name) const {
  const Column* column = Find(name);
  return column != nullptr && std::holds_alternative<Texts>(column->cells);
}

const std::vector<std::string>& FrameTable::Text(
    const std::string& name) const {
  if (const Column* column = Find(name)) return CellsAs<Texts>(*column);
  throw InputError(Name() + ": " + NoColumn(name, headers()));
}

std::vector<double>& FrameTable::MutableNumbers(const std::string& name) {
  return MutableCells<Numeric>(name, kNaN);
}

std::vector<std::string>& FrameTable::MutableText(const std::string& name) {
  return MutableCells<Texts>(name, "");
}

void FrameTable::Truncate(std::size_t rows) {
  rows_ = std::min(rows_, rows);
  lines_.resize(std::min(lines_.size(), rows_));
  for (Column& column : columns_) {
    std::visit([this](auto& cells) { cells.resize(rows_); }, column.cells);
  }
}

std::string FrameTable::HeaderCsv() const {
  std::string csv;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (i > 0) csv += ',';
    AppendCsvText(columns_[i].name, &csv);
  }
  return csv + '\n';
}

std::string FrameTable::RowsCsv() const {
  std::string csv;
  // A blank line would be skipped when the table is read.
  const bool alone = columns_.size() == 1;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (i > 0) csv += ',';
      if (const auto* numbers = std::get_if<Numeric>(&columns_[i].cells)) {
        const double value = (*numbers)[row];
        if (std::isfinite(value) ||
            (std::isinf(value) && MayBeInfinite(columns_[i].name))) {
          csv += NumberText(value);
        } else if (alone) {
          csv += "nan";
        }
      } else {
        const std::string& text = std::get<Texts>(columns_[i].cells)[row];
        if (alone && text.empty()) {
          csv += "\"\"";
        } else {
          AppendCsvText(text, &csv);
        }
      }
    }
    csv += '\n';
  }
  return csv;
}

void FrameTable::Write(const std::string& path) const {
  const bool gzip =
      path.size() >= 3 && path.compare(path.size() - 3, 3, ".gz") == 0;
  WriteFileAtomically(path, gzip ? Gzipped(ToCsv()) : ToCsv());
}

}  // namespace finray
