#ifndef FINRAY_IO_FRAME_TABLE_H_
#define FINRAY_IO_FRAME_TABLE_H_

#include <cstddef>
#include <deque>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "finray/io/column_mapping.h"

namespace finray {

/// A table of frames, the format that all tools share: a CSV whose columns come
/// from a fixed vocabulary (frame_vocabulary.h: gauge_<j>_V, contact_<c>_mm,
/// force_N, ...). Vocabulary columns hold numbers; an empty cell and "nan" are
/// NaN, which means not measured. `status` and all other columns hold text.
class FrameTable {
 public:
  FrameTable() = default;
  /// `name` stands for the path in messages.
  explicit FrameTable(std::size_t rows, std::string name = "")
      : rows_(rows), path_(std::move(name)) {}

  /// Reads .csv or .csv.gz as `mapping` says. Throws InputError
  /// (file:line:column, column being the cell's number) for an unreadable or
  /// empty file, a duplicate header, a row with the wrong number of cells or a
  /// cell that is no number.
  static FrameTable Read(const std::string& path,
                         const ColumnMapping& mapping = {});

  std::size_t rows() const { return rows_; }
  const std::string& path() const { return path_; }
  /// Returns the line of the file that a row came from, counted from 1. In a
  /// table that was not read it is the row, counted from 1.
  int line(std::size_t row) const {
    return row < lines_.size() ? lines_[row] : static_cast<int>(row) + 1;
  }

  std::vector<std::string> headers() const;
  bool Has(const std::string& name) const;
  /// Returns a numeric column. Throws InputError if it is missing (with the
  /// nearest name) or holds text.
  const std::vector<double>& Numbers(const std::string& name) const;
  /// Returns a numeric column like Numbers, but all NaN if it is missing.
  std::vector<double> NumbersOrNan(const std::string& name) const;
  bool IsText(const std::string& name) const;
  /// Returns a text column. Throws InputError if it is missing or holds
  /// numbers.
  const std::vector<std::string>& Text(const std::string& name) const;
  /// Returns a numeric column to write to, filled with NaN if it is new. Throws
  /// InputError if it exists and holds text.
  std::vector<double>& MutableNumbers(const std::string& name);
  /// Returns a text column to write to, filled with "" if it is new. Throws
  /// InputError if it exists and holds numbers.
  std::vector<std::string>& MutableText(const std::string& name);
  /// Keeps the first rows only.
  void Truncate(std::size_t rows);

  /// Returns CSV text that reads back as the same doubles. NaN and infinity are
  /// empty ("nan" on a line that would be blank); inf stays if MayBeInfinite().
  std::string ToCsv() const { return HeaderCsv() + RowsCsv(); }
  /// Return the first line of ToCsv(), and its other lines.
  std::string HeaderCsv() const;
  std::string RowsCsv() const;
  /// Writes ToCsv() by WriteFileAtomically. The file is gzipped if its name
  /// ends in .gz.
  void Write(const std::string& path) const;

 private:
  struct Column {
    std::string name;
    std::variant<std::vector<double>, std::vector<std::string>> cells;
  };

  const Column* Find(const std::string& name) const;
  // Returns the cells of a column. Throws InputError if they have another type.
  template <typename Cells>
  const Cells& CellsAs(const Column& column) const;
  // Returns the cells of a column to write to. A new column is filled with
  // `missing`.
  template <typename Cells>
  Cells& MutableCells(const std::string& name,
                      const typename Cells::value_type& missing);
  // The name of this table in messages.
  std::string Name() const { return path_.empty() ? "the table" : path_; }

  std::size_t rows_ = 0;
  std::string path_;
  std::vector<int> lines_;
  std::deque<Column> columns_;  // a deque does not move its columns
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_TABLE_H_
