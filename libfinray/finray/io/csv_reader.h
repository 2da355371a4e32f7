#ifndef FINRAY_IO_CSV_READER_H_
#define FINRAY_IO_CSV_READER_H_

#include <memory>
#include <string>

#include "finray/io/csv_line.h"

namespace finray {

/// Goes through a CSV file, plain or gzipped, line by line. Blank lines are
/// passed over; either kind of line end does no harm. Throws InputError for a
/// file that cannot be read or is no CSV.
class CsvReader {
 public:
  explicit CsvReader(const std::string& path);
  ~CsvReader();

  /// Goes to the next line; false at the end of the file.
  bool Next();
  /// The current one; its text lives until the next.
  const CsvLine& line() const { return line_; }

 private:
  struct Lines;

  std::string path_;
  std::unique_ptr<Lines> lines_;
  CsvLine line_;
};

}  // namespace finray

#endif  // FINRAY_IO_CSV_READER_H_
