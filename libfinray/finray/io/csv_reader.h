#ifndef FINRAY_IO_CSV_READER_H_
#define FINRAY_IO_CSV_READER_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "finray/io/csv_cells.h"

namespace finray {

/// Goes through a CSV file, plain or gzipped, line by line. Blank lines are
/// skipped; a byte order mark and either kind of line end do no harm. Throws
/// InputError for a file that cannot be read or is no CSV.
class CsvReader {
 public:
  explicit CsvReader(const std::string& path);
  ~CsvReader();

  /// The next line that is no '#' comment; false at the end of the file.
  bool NextHeader();
  /// The next line, whatever it starts with; false at the end of the file.
  bool NextRow();
  /// Passes over that line, whatever it holds; false at the end of the file.
  bool SkipRow() { return NextLine(); }

  /// Cells of the current line.
  const std::vector<std::string_view>& cells() const { return cells_.cells(); }
  /// Its number in the file, from 1.
  int line() const { return line_number_; }
  /// Index of its first cell that holds a NUL byte; the number of cells if
  /// none does.
  std::size_t FirstNul() const;

  /// Throws InputError "path:line: message".
  [[noreturn]] void Fail(const std::string& message) const;
  /// Throws InputError "path:line:cell: message", cells counted from 1.
  [[noreturn]] void FailAt(std::size_t index, const std::string& message) const;

 private:
  struct Lines;

  // False at the end of the file; the line is not split yet.
  bool NextLine();
  void Split();

  std::string path_;
  std::unique_ptr<Lines> lines_;
  std::string_view line_;
  int line_number_ = 0;
  CsvCells cells_;
};

}  // namespace finray

#endif  // FINRAY_IO_CSV_READER_H_
