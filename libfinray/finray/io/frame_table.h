#ifndef FINRAY_IO_FRAME_TABLE_H_
#define FINRAY_IO_FRAME_TABLE_H_

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace finray {

/// The one table format of all tools: a CSV whose columns come from a fixed
/// vocabulary (gauge_<j>_V, contact_<c>_mm, force_N, ...). Vocabulary columns
/// are numbers, NaN where a cell is empty or "nan" (not measured); `status` and
/// columns outside the vocabulary are kept as text, unchanged.
class FrameTable {
 public:
  FrameTable() = default;
  explicit FrameTable(std::size_t rows) : rows_(rows) {}

  /// Reads .csv or .csv.gz. `renames` maps a lab's own headers to vocabulary
  /// names (or the other way round where only that makes sense). Throws
  /// InputError (file:line:column, column being the cell's number) for an
  /// unreadable or empty file, a duplicate header, a row with the wrong number
  /// of cells or a cell that is no number.
  static FrameTable Read(
      const std::string& path,
      const std::map<std::string, std::string>& renames = {});

  /// Whether a name belongs to the numeric vocabulary.
  static bool IsVocabulary(const std::string& name);

  std::size_t rows() const { return rows_; }
  const std::string& path() const { return path_; }
  /// Line of the file a row came from (1-based), for messages; 0 in a table
  /// that was not read.
  int line(std::size_t row) const {
    return row < lines_.size() ? lines_[row] : 0;
  }

  std::vector<std::string> headers() const;
  bool Has(const std::string& name) const;
  /// A numeric column; InputError naming the nearest header if it is missing,
  /// or saying so if it holds text.
  const std::vector<double>& Numbers(const std::string& name) const;
  /// As above, all NaN when the column is missing.
  std::vector<double> NumbersOrNan(const std::string& name) const;
  /// A numeric column to write to: existing values, or NaN when new. InputError
  /// if it exists and holds text.
  std::vector<double>& MutableNumbers(const std::string& name);
  /// A text column to write to: existing cells, or empty when new. InputError
  /// if it exists and holds numbers.
  std::vector<std::string>& MutableText(const std::string& name);
  /// Keeps the first rows only.
  void Truncate(std::size_t rows);

  /// CSV text; doubles read back identical; what is not finite is an empty cell
  /// ("nan" where the line would be blank).
  std::string ToCsv() const { return HeaderCsv() + RowsCsv(); }
  /// Its first line, and the others, each with its line end.
  std::string HeaderCsv() const;
  std::string RowsCsv() const;
  /// Writes ToCsv() (gzipped if the name ends in .gz) under a temporary name,
  /// then renames.
  void Write(const std::string& path) const;

 private:
  friend class FrameReader;

  struct Column {
    std::string name;
    std::variant<std::vector<double>, std::vector<std::string>> cells;
  };

  const Column* Find(const std::string& name) const;
  // The cells of a column as the given type, or an InputError.
  template <typename Cells>
  const Cells& CellsAs(const Column& column) const;
  // The cells of a column to write to; a new one is filled with `missing`.
  template <typename Cells>
  Cells& MutableCells(const std::string& name,
                      const typename Cells::value_type& missing);
  // What messages call this table.
  std::string Name() const { return path_.empty() ? "the table" : path_; }

  std::size_t rows_ = 0;
  std::string path_;
  std::vector<int> lines_;
  std::deque<Column> columns_;  // references survive new columns
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_TABLE_H_
