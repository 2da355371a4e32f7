#include "finray/io/frame_parser.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include "finray/io/csv_cells.h"
#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/io/log_header.h"
#include "finray/io/message_text.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// Says whether a character is a control character other than a tab.
bool IsControl(char c) {
  return c != '\t' && (static_cast<unsigned char>(c) < 0x20 || c == '\x7f');
}

// Returns the index of the first cell of a line that holds a NUL byte, or the
// number of cells if there is none.
std::size_t FirstNul(const CsvLine& line,
                     const std::vector<std::string_view>& cells) {
  if (!line.nul) return cells.size();
  const auto at =
      std::find_if(cells.begin(), cells.end(), [](std::string_view cell) {
        return cell.find('\0') != std::string_view::npos;
      });
  return static_cast<std::size_t>(at - cells.begin());
}

// Says whether a comma in a number may separate thousands: "1,234".
bool MayBeThousands(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    text.remove_prefix(1);
  }
  const std::size_t comma = text.find(',');
  return comma >= 1 && comma <= 3 && text[0] != '0' &&
         text.size() == comma + 4 &&
         text.find_first_not_of("0123456789,") == text.npos;
}

// Returns the infinity that a text stands for: "inf", "-Infinity", or a number
// that is too large for a double.
std::optional<double> InfinityIn(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  const char* end = text.data() + text.size();
  double value = 0;
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ptr != end || result.ec == std::errc::invalid_argument) return {};
  if (result.ec == std::errc::result_out_of_range) {
    const ClassicNumbers classic;
    value = std::strtod(std::string(text).c_str(), nullptr);
  }
  return std::isinf(value) ? std::optional<double>(value) : std::nullopt;
}

// Returns the unit in a cell of a units row, also in brackets, or nothing.
std::optional<Unit> UnitInCell(std::string_view cell) {
  if (cell.size() > 2 && ((cell.front() == '[' && cell.back() == ']') ||
                          (cell.front() == '(' && cell.back() == ')'))) {
    cell = Trimmed(cell.substr(1, cell.size() - 2));
  }
  return FindUnitInFile(cell);
}

}  // namespace

FrameParser::FrameParser(const std::string& path, const CsvLine& header,
                         const ColumnMapping& mapping)
    : path_(path),
      not_measured_(mapping.not_measured),
      units_row_(mapping.units_row),
      is_result_(mapping.is_result) {
  delimiter_ = DelimiterOf(header.text, mapping);
  if (delimiter_ == '\0') {
    Fail(header.number,
         "the header " + ShownText(header.text) +
             " holds more than one of comma, semicolon and tab" +
             Advice("state which one stands between cells with delimiter:"));
  }
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  const std::string error =
      SplitCsvLine(header.text, delimiter_, &cells, &unquoted);
  if (!error.empty()) FailAt(header.number, cells.size() - 1, error);
  const std::size_t nul = FirstNul(header, cells);
  if (nul < cells.size()) {
    FailAt(header.number, nul,
           "the header holds a NUL byte, expected UTF-8 text");
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // Names hold no control characters, but unrecognised zip files do.
    const auto bad = std::find_if(cells[i].begin(), cells[i].end(), IsControl);
    if (bad == cells[i].end()) continue;
    FailAt(header.number, i,
           "the header " + ShownText(cells[i]) +
               (*bad == '\r' ? " holds a carriage return, expected lines that "
                               "end with a line feed"
                             : " holds a control character, expected text"));
  }
  TakeNames(header, {cells.begin(), cells.end()}, mapping);
  // Cells with decimal commas between commas have quotes, so they are rare.
  if (mapping.decimal) {
    UseDecimal(*mapping.decimal);
  } else {
    decimal_settled_ = delimiter_ == ',';
  }
}

void FrameParser::TakeNames(const CsvLine& header,
                            const std::vector<std::string>& found,
                            const ColumnMapping& mapping) {
  // Rules refer to the names in the file, so that two columns can be swapped.
  names_ = found;
  columns_.resize(found.size());
  std::vector<char> mapped(found.size());
  for (const ColumnRule& rule : mapping.rules) {
    const auto at = std::find(found.begin(), found.end(), rule.from);
    if (at == found.end()) {
      throw InputError(path_ + ": no column " + ShownText(rule.from) +
                       " to rename to " + ShownText(rule.to) +
                       DidYouMean(rule.from, found));
    }
    const auto i = static_cast<std::size_t>(at - found.begin());
    names_[i] = rule.to;
    mapped[i] = true;
    columns_[i].rule = rule;
    columns_[i].declared = UnitInBrackets(rule.from);
  }
  if (std::all_of(names_.begin(), names_.end(), ParseNumber)) {
    Fail(header.number, "expected a header, found numbers only");
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!seen.insert(names_[i]).second) {
      FailAt(header.number, i,
             "header " + ShownText(names_[i]) + " appears twice");
    }
    if (!IsFrameColumn(names_[i])) continue;
    Column& column = columns_[i];
    if (!mapped[i]) {
      // The name says the unit already.
      column.rule.from = column.rule.to = names_[i];
      const Unit unit = UnitOfColumn(names_[i]);
      if (unit.dimension != Dimension::kNone) column.rule.unit = unit;
    }
    column.numeric = true;
    column.may_be_infinite = MayBeInfinite(names_[i]);
    column.largest = LargestIn(names_[i]);
    MakeConversion(header, i);
  }
}

void FrameParser::MakeConversion(const CsvLine& line, std::size_t i) {
  Column& column = columns_[i];
  std::string error;
  column.conversion = ColumnConversion(column.rule, column.declared, &error);
  if (!error.empty()) FailAt(line.number, i, names_[i] + ": " + error);
  column.plain = column.conversion.IsIdentity() && decimal_ == '.' &&
                 not_measured_.empty();
}

void FrameParser::UseDecimal(char decimal) {
  decimal_ = decimal;
  decimal_settled_ = true;
  if (decimal == '.') return;
  for (Column& column : columns_) column.plain = false;
}

bool FrameParser::TakeUnits(const CsvLine& line) {
  if (units_row_ == false) return false;
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  const std::string error =
      SplitCsvLine(line.text, delimiter_, &cells, &unquoted);
  if (!error.empty() || cells.size() != names_.size()) {
    if (units_row_ != true) return false;  // Parse() says what is wrong
    Fail(line.number, "expected a unit for each of the " +
                          std::to_string(names_.size()) +
                          " columns of the header, as units_row says");
  }
  bool any = false;
  std::size_t unknown = cells.size();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Column& column = columns_[i];
    if (!column.numeric) continue;
    if (UnitInCell(cells[i])) {
      any = true;
    } else if (IsNotMeasured(cells[i]) || cells[i] == "1") {
      continue;  // no unit
    } else if (ParseNumber(cells[i]) || NumberInCell(cells[i], ',')) {
      if (units_row_ != true) return false;
      FailAt(line.number, i,
             names_[i] + ": expected a unit, found " + ShownText(cells[i]));
    } else if (!column.rule.scale && !column.rule.counts &&
               column.rule.format != TimeFormat::kIso8601) {
      unknown = std::min(unknown, i);
    }
  }
  if (!any && units_row_ != true) return false;
  if (unknown < cells.size()) {
    FailAt(line.number, unknown,
           names_[unknown] +
               ": expected a unit as in the other columns, one of " +
               Joined(UnitNames(UnitOfColumn(names_[unknown]).dimension)) +
               ", found " + ShownText(cells[unknown]) +
               "; a scale in the column's mapping speaks for it too");
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto unit = UnitInCell(cells[i]);
    if (!columns_[i].numeric || !unit) continue;
    columns_[i].declared = unit->name;
    MakeConversion(line, i);
  }
  return true;
}

void FrameParser::LearnDecimal(const CsvLine& line) {
  if (decimal_settled_) return;
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  SplitCsvLine(line.text, delimiter_, &cells, &unquoted);
  bool comma = false;
  for (std::size_t i = 0; i < std::min(cells.size(), columns_.size()); ++i) {
    if (!columns_[i].numeric ||
        columns_[i].rule.format == TimeFormat::kIso8601) {
      continue;
    }
    const bool point = cells[i].find('.') != cells[i].npos;
    if (point && ParseNumber(cells[i])) return UseDecimal('.');
    comma |= !point && cells[i].find(',') != cells[i].npos &&
             NumberInCell(cells[i], ',') && !MayBeThousands(cells[i]);
  }
  if (comma) UseDecimal(',');
}

bool FrameParser::IsMissing(std::string_view text) const {
  return IsNotMeasured(text) ||
         std::find(not_measured_.begin(), not_measured_.end(), text) !=
             not_measured_.end();
}

std::string FrameParser::Advice(const std::string& how) const {
  return is_result_ ? "; finray_estimate has not written this: make the result "
                      "again"
                    : "; " + how + " in the scene or plan";
}

// Reads what is no plain number.
FrameRows::Cell FrameParser::ReadCell(int line, std::size_t i,
                                      std::string_view text) const {
  if (IsMissing(text)) return {};
  const Column& column = columns_[i];
  if (column.may_be_infinite) {
    const std::optional<double> infinity = InfinityIn(text);
    if (infinity) return {*infinity, text};
  }
  std::string error;
  const double value = column.conversion.Value(text, decimal_, &error);
  if (error.empty()) {
    CheckSize(line, i, value, text);
    return {value, {}};
  }
  if (decimal_ == '.' && NumberInCell(text, ',')) {
    error += MayBeThousands(text) ? ", which may stand for two numbers" : "";
    error += Advice("a decimal comma is stated by decimal: \",\"");
  }
  FailAt(line, i, names_[i] + ": " + error);
}

void FrameParser::CheckSize(int line, std::size_t i, double number,
                            std::string_view text) const {
  const double largest = columns_[i].largest;
  if (!(std::abs(number) > largest)) return;
  FailAt(
      line, i,
      names_[i] +
          FormatText(": expected a magnitude of at most %g, found ", largest) +
          ShownText(text) +
          Advice("a number that stands for none is stated by not_measured:"));
}

void FrameParser::Parse(const CsvLine& line, FrameRows* rows) const {
  std::vector<std::string_view>& split = rows->split_;
  FrameRows::Cell* cells = rows->AddRow(names_.size());
  const char* error =
      SplitCsvLine(line.text, delimiter_, &split, &rows->unquoted_);
  if (*error != '\0') FailAt(line.number, split.size() - 1, error);
  if (split.size() != names_.size()) {
    // Decimal commas between commas make too many cells.
    const bool commas = delimiter_ == ',' && split.size() > names_.size();
    Fail(line.number,
         "expected " + std::to_string(names_.size()) +
             " cells as in the header, found " + std::to_string(split.size()) +
             (commas ? Advice("another delimiter than the comma is stated by "
                              "delimiter:")
                     : ""));
  }
  const std::size_t nul = FirstNul(line, split);
  if (nul < split.size()) {
    FailAt(
        line.number, nul,
        ShownLine(names_[nul]) + ": the cell holds a NUL byte, expected text");
  }
  for (std::size_t i = 0; i < split.size(); ++i) {
    const Column& column = columns_[i];
    if (!column.numeric) {
      cells[i].text = split[i];
      continue;
    }
    const std::string_view text = Trimmed(split[i]);  // quotes keep spaces
    if (column.plain) {
      if (const std::optional<double> number = ParseNumber(text)) {
        CheckSize(line.number, i, *number, text);
        cells[i] = {*number, text};
        continue;
      }
    }
    cells[i] = ReadCell(line.number, i, text);
  }
}

void FrameParser::Fail(int line, const std::string& message) const {
  throw InputError(path_ + ":" + std::to_string(line) + ": " + message);
}

void FrameParser::FailAt(int line, std::size_t cell,
                         const std::string& message) const {
  throw InputError(path_ + ":" + std::to_string(line) + ":" +
                   std::to_string(cell + 1) + ": " + message);
}

}  // namespace finray
