#ifndef FINRAY_IO_FRAME_PARSER_H_
#define FINRAY_IO_FRAME_PARSER_H_

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "finray/io/column_conversion.h"
#include "finray/io/column_mapping.h"
#include "finray/io/line_reader.h"
#include "finray/io/nan.h"

namespace finray {

/// Rows of a frame table, cell by cell. Clear() keeps the memory.
class FrameRows {
 public:
  struct Cell {
    /// The number is NaN for text and for a cell that was not measured.
    double number = kNaN;
    /// The text has no quotes. It refers to the line that was parsed. It is
    /// empty if the number was converted.
    std::string_view text;
  };

  void Clear() {
    rows_ = 0;
    cells_.clear();
    unquoted_.clear();
  }
  std::size_t rows() const { return rows_; }
  const Cell& at(std::size_t row, std::size_t column) const {
    return cells_[row * columns_ + column];
  }

  /// Removes the last row.
  void DropRow() {
    --rows_;
    cells_.resize(rows_ * columns_);
  }

 private:
  friend class FrameParser;

  // Appends an empty row and returns its first cell.
  Cell* AddRow(std::size_t columns) {
    columns_ = columns;
    ++rows_;
    cells_.resize(rows_ * columns);
    return &cells_[(rows_ - 1) * columns];
  }

  std::size_t rows_ = 0, columns_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::string_view> split_;  // the line that is being read
  std::deque<std::string> unquoted_;     // a deque does not move its strings
};

/// Parses the rows of a log by its header. Several threads may use one, once
/// its first row is known not to hold units and the decimal mark is settled.
/// Names, path, delimiter and which columns are numeric never change, so they
/// can be asked for before that too.
class FrameParser {
 public:
  /// Throws InputError (path:line:column) for a header that is bad or does not
  /// have the columns of the mapping.
  FrameParser(const std::string& path, const CsvLine& header,
              const ColumnMapping& mapping);

  const std::string& path() const { return path_; }
  const std::vector<std::string>& names() const { return names_; }
  char delimiter() const { return delimiter_; }
  /// Says whether a column holds numbers. Other columns hold text.
  bool IsNumeric(std::size_t column) const { return columns_[column].numeric; }

  /// Takes the line below the header if it holds the units of the columns, and
  /// says whether it does: the mapping says so, or each cell of a numeric
  /// column is a unit or stands for none, and at least one is a unit. Throws
  /// InputError for a unit that does not fit its column.
  bool TakeUnits(const CsvLine& line);
  /// Learns the decimal mark from a row: a point, or a comma that can be no
  /// separator of thousands. Does nothing if the mark is settled: it is stated,
  /// it was found, or cells are delimited by commas.
  void LearnDecimal(const CsvLine& line);
  /// Without a mark in the rows so far, it is the point.
  void SettleDecimal() { decimal_settled_ = true; }
  bool decimal_settled() const { return decimal_settled_; }

  /// Appends a line as a row. Throws InputError (path:line:column) for a wrong
  /// number of cells or a cell that is no number. The row then holds the cells
  /// before it.
  void Parse(const CsvLine& line, FrameRows* rows) const;

 private:
  struct Column {
    bool numeric = false;
    bool plain = false;  // the number as it is written, with a point
    ColumnRule rule;
    std::string declared;  // unit in the log
    ColumnConversion conversion;
    bool may_be_infinite = false;
    double largest = std::numeric_limits<double>::infinity();
  };

  void TakeNames(const CsvLine& header, const std::vector<std::string>& found,
                 const ColumnMapping& mapping);
  // Fails at a cell of the header's or the units' line.
  void MakeConversion(const CsvLine& line, std::size_t column);
  void UseDecimal(char decimal);
  FrameRows::Cell ReadCell(int line, std::size_t column,
                           std::string_view text) const;
  // Fails if the number of a cell is larger than those of its column.
  void CheckSize(int line, std::size_t column, double number,
                 std::string_view text) const;
  bool IsMissing(std::string_view text) const;
  // Tells a user how to state a dialect that the parser does not understand.
  std::string Advice(const std::string& how) const;
  [[noreturn]] void Fail(int line, const std::string& message) const;
  [[noreturn]] void FailAt(int line, std::size_t cell,
                           const std::string& message) const;

  std::string path_;
  std::vector<std::string> names_;
  std::vector<Column> columns_;
  std::vector<std::string> not_measured_;
  std::optional<bool> units_row_;
  bool is_result_;
  char delimiter_ = ',', decimal_ = '.';
  bool decimal_settled_ = true;
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_PARSER_H_
