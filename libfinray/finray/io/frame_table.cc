#include "finray/io/frame_table.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <string_view>

#define CSV_IO_NO_THREAD
// The library cuts long file names short on purpose.
#pragma GCC diagnostic ignored "-Wstringop-truncation"
#include <libfccp/csv.h>

#include "finray/io/atomic_file.h"
#include "finray/io/error.h"
#include "finray/io/nearest_name.h"

namespace finray {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The bytes of a file, unzipped if need be (gzread passes plain files through).
class GzipSource : public io::ByteSourceBase {
 public:
  explicit GzipSource(const std::string& path) : path_(path) {
    if (std::filesystem::is_directory(path)) {
      throw InputError(path + ": is a folder, expected a CSV file");
    }
    file_ = gzopen(path.c_str(), "rb");
    if (file_ == nullptr) {
      throw InputError(path + ": cannot be read: " + std::strerror(errno));
    }
    gzbuffer(file_, 1 << 17);
  }
  ~GzipSource() override { gzclose(file_); }

  int read(char* buffer, int size) override {
    const int n = gzread(file_, buffer, static_cast<unsigned>(size));
    int error = Z_OK;
    const char* message = gzerror(file_, &error);
    if (n < 0 || (error != Z_OK && error != Z_STREAM_END)) {
      throw InputError(path_ + ": cannot be read to its end: " + message);
    }
    // The line reader takes NUL for the end of a line.
    if (std::memchr(buffer, 0, static_cast<std::size_t>(n)) != nullptr) {
      throw InputError(path_ + ": holds NUL bytes, expected CSV text");
    }
    return n;
  }

 private:
  std::string path_;
  gzFile file_;
};

std::string_view Trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Cells of one line; quoted ones (RFC 4180) are unquoted into `unquoted`, whose
// strings keep their place.
bool SplitCells(std::string_view line,
                std::vector<std::unique_ptr<std::string>>* unquoted,
                std::vector<std::string_view>* cells) {
  cells->clear();
  unquoted->clear();
  for (;;) {
    const auto start = line.find_first_not_of(" \t");
    if (start != std::string_view::npos && line[start] == '"') {
      auto text = std::make_unique<std::string>();
      std::size_t i = start + 1;
      for (;; ++i) {
        if (i >= line.size()) return false;  // no closing quote
        if (line[i] != '"') {
          *text += line[i];
        } else if (i + 1 < line.size() && line[i + 1] == '"') {
          *text += line[i++];
        } else {
          break;
        }
      }
      cells->push_back(*text);
      unquoted->push_back(std::move(text));
      const auto comma = line.find(',', i);
      if (comma == std::string_view::npos) return true;
      line.remove_prefix(comma + 1);
      continue;
    }
    const auto comma = line.find(',');
    cells->push_back(Trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return true;
    line.remove_prefix(comma + 1);
  }
}

// Number of a cell; empty and nan are NaN. False if it is no finite number.
bool ParseCell(std::string_view text, double* value) {
  if (text.empty()) {
    *value = kNaN;
    return true;
  }
  if (text.front() == '+') text.remove_prefix(1);
  const auto result =
      std::from_chars(text.data(), text.data() + text.size(), *value);
  return result.ec == std::errc() && result.ptr == text.data() + text.size() &&
         !std::isinf(*value);
}

std::string Shown(std::string_view text) {
  std::string shown(text.substr(0, 40));
  if (text.size() > 40) shown += "...";
  return "'" + shown + "'";
}

// A pattern of the vocabulary with '#' for an index that starts from 1.
bool Matches(std::string_view name, std::string_view pattern) {
  const auto hash = pattern.find('#');
  if (hash == std::string_view::npos) return name == pattern;
  const std::string_view before = pattern.substr(0, hash);
  const std::string_view after = pattern.substr(hash + 1);
  if (name.size() <= before.size() + after.size() ||
      name.substr(0, before.size()) != before ||
      name.substr(name.size() - after.size()) != after) {
    return false;
  }
  const std::string_view index =
      name.substr(before.size(), name.size() - before.size() - after.size());
  return index.front() != '0' && index.size() <= 4 &&
         std::all_of(index.begin(), index.end(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

std::string NeedsQuotes(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos &&
      Trimmed(text) == text) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

void RenameHeaders(const std::string& path,
                   const std::map<std::string, std::string>& renames,
                   std::vector<std::string>* headers) {
  for (const auto& [key, value] : renames) {
    // {lab's header: our name}, or the other way round.
    const bool reversed =
        FrameTable::IsVocabulary(key) && !FrameTable::IsVocabulary(value);
    const std::string& from = reversed ? value : key;
    const std::string& to = reversed ? key : value;
    const auto at = std::find(headers->begin(), headers->end(), from);
    if (at == headers->end()) {
      throw InputError(path + ": no column '" + from + "' to rename to '" + to +
                       "'" + DidYouMean(from, *headers));
    }
    *at = to;
  }
}

}  // namespace

bool FrameTable::IsVocabulary(const std::string& name) {
  static constexpr std::string_view kPatterns[] = {"time_s",
                                                   "gauge_#_V",
                                                   "gauge_#_rad",
                                                   "contact_#_mm",
                                                   "contact_#_std_mm",
                                                   "normal_#_N",
                                                   "normal_#_std_N",
                                                   "friction_#",
                                                   "contact_#_x_mm",
                                                   "contact_#_y_mm",
                                                   "contact_#_angle_rad",
                                                   "object_x_mm",
                                                   "object_y_mm",
                                                   "object_angle_deg",
                                                   "force_N",
                                                   "force_x_N",
                                                   "force_y_N",
                                                   "rib_#_N",
                                                   "tip_x_mm",
                                                   "tip_y_mm",
                                                   "tip_angle_rad",
                                                   "chi2",
                                                   "iterations",
                                                   "temperature_C"};
  return std::any_of(
      std::begin(kPatterns), std::end(kPatterns),
      [&name](std::string_view pattern) { return Matches(name, pattern); });
}

FrameTable FrameTable::Read(const std::string& path,
                            const std::map<std::string, std::string>& renames) {
  FrameTable table;
  table.path_ = path;
  int line_number = 0;
  const auto fail = [&](const std::string& message, std::size_t cell = 0) {
    throw InputError(path + ":" + std::to_string(line_number) + ":" +
                     (cell > 0 ? std::to_string(cell) + ":" : "") + " " +
                     message);
  };
  std::vector<std::unique_ptr<std::string>> unquoted;
  std::vector<std::string_view> cells;
  try {
    io::LineReader reader(path, std::make_unique<GzipSource>(path));
    while (const char* text = reader.next_line()) {
      line_number = static_cast<int>(reader.get_file_line());
      std::string_view line(text);
      if (line_number == 1 && line.substr(0, 3) == "\xEF\xBB\xBF") {
        line.remove_prefix(3);
      }
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      if (Trimmed(line).empty()) continue;
      const bool header = table.columns_.empty();
      if (header && line.front() == '#') continue;
      if (!SplitCells(line, &unquoted, &cells)) {
        fail("a quoted cell does not end on its line");
      }
      if (header) {
        std::vector<std::string> names(cells.begin(), cells.end());
        RenameHeaders(path, renames, &names);
        std::set<std::string> seen;
        for (std::size_t i = 0; i < names.size(); ++i) {
          if (!seen.insert(names[i]).second) {
            fail("header " + Shown(names[i]) + " appears twice", i + 1);
          }
          if (IsVocabulary(names[i])) {
            table.columns_.push_back({names[i], std::vector<double>()});
          } else {
            table.columns_.push_back({names[i], std::vector<std::string>()});
          }
        }
        continue;
      }
      if (cells.size() != table.columns_.size()) {
        fail("expected " + std::to_string(table.columns_.size()) +
             " cells as in the header, found " + std::to_string(cells.size()));
      }
      for (std::size_t i = 0; i < cells.size(); ++i) {
        Column& column = table.columns_[i];
        if (auto* texts =
                std::get_if<std::vector<std::string>>(&column.cells)) {
          texts->emplace_back(cells[i]);
          continue;
        }
        double value;
        if (!ParseCell(cells[i], &value)) {
          fail(column.name + ": expected a number, found " + Shown(cells[i]),
               i + 1);
        }
        std::get<std::vector<double>>(column.cells).push_back(value);
      }
      table.lines_.push_back(line_number);
      ++table.rows_;
    }
  } catch (const io::error::base& error) {
    throw InputError(path + ":" + std::to_string(line_number + 1) +
                     ": a line is too long for a CSV of numbers");
  }
  if (table.columns_.empty()) {
    throw InputError(path + ": is empty, expected a header and rows");
  }
  if (table.rows_ == 0) {
    throw InputError(path + ": has a header but no rows");
  }
  return table;
}

std::vector<std::string> FrameTable::headers() const {
  std::vector<std::string> names;
  for (const Column& column : columns_) names.push_back(column.name);
  return names;
}

bool FrameTable::Has(const std::string& name) const {
  return std::any_of(
      columns_.begin(), columns_.end(),
      [&name](const Column& column) { return column.name == name; });
}

const std::vector<double>& FrameTable::Numbers(const std::string& name) const {
  for (const Column& column : columns_) {
    if (column.name == name) {
      return std::get<std::vector<double>>(column.cells);
    }
  }
  std::string hint = DidYouMean(name, headers());
  if (hint.empty()) {
    hint = "; it has";
    for (const Column& column : columns_) hint += " " + column.name;
  }
  throw InputError(path_ + ": no column '" + name + "'" + hint);
}

std::vector<double> FrameTable::NumbersOrNan(const std::string& name) const {
  if (Has(name)) return Numbers(name);
  return std::vector<double>(rows_, kNaN);
}

std::vector<double>& FrameTable::MutableNumbers(const std::string& name) {
  for (Column& column : columns_) {
    if (column.name == name) {
      return std::get<std::vector<double>>(column.cells);
    }
  }
  columns_.push_back({name, std::vector<double>(rows_, kNaN)});
  return std::get<std::vector<double>>(columns_.back().cells);
}

std::vector<std::string>& FrameTable::MutableText(const std::string& name) {
  for (Column& column : columns_) {
    if (column.name == name) {
      return std::get<std::vector<std::string>>(column.cells);
    }
  }
  columns_.push_back({name, std::vector<std::string>(rows_)});
  return std::get<std::vector<std::string>>(columns_.back().cells);
}

void FrameTable::Truncate(std::size_t rows) {
  rows_ = std::min(rows_, rows);
  for (Column& column : columns_) {
    std::visit([this](auto& cells) { cells.resize(rows_); }, column.cells);
  }
}

std::string FrameTable::ToCsv() const {
  std::string csv;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (i > 0) csv += ',';
    csv += NeedsQuotes(columns_[i].name);
  }
  csv += '\n';
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (i > 0) csv += ',';
      if (const auto* numbers =
              std::get_if<std::vector<double>>(&columns_[i].cells)) {
        const double value = (*numbers)[row];
        if (std::isfinite(value)) csv += NumberText(value);
      } else {
        csv += NeedsQuotes(
            std::get<std::vector<std::string>>(columns_[i].cells)[row]);
      }
    }
    csv += '\n';
  }
  return csv;
}

void FrameTable::Write(const std::string& path) const {
  const std::string csv = ToCsv();
  if (path.size() < 3 || path.substr(path.size() - 3) != ".gz") {
    WriteFileAtomically(path, csv);
    return;
  }
  z_stream stream = {};
  // 15 + 16: the largest window, with a gzip header.
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15 + 16, 8,
               Z_DEFAULT_STRATEGY);
  std::string zipped(deflateBound(&stream, csv.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(csv.data()));
  stream.avail_in = static_cast<uInt>(csv.size());
  stream.next_out = reinterpret_cast<Bytef*>(zipped.data());
  stream.avail_out = static_cast<uInt>(zipped.size());
  deflate(&stream, Z_FINISH);
  zipped.resize(stream.total_out);
  deflateEnd(&stream);
  WriteFileAtomically(path, zipped);
}

}  // namespace finray
