#ifndef FINRAY_IO_FRAME_READER_H_
#define FINRAY_IO_FRAME_READER_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "finray/io/csv_reader.h"
#include "finray/io/frame_table.h"

namespace finray {

/// Reads a frame table piece by piece, so that the memory it takes does not
/// grow with the length of the file.
class FrameReader {
 public:
  /// Opens .csv or .csv.gz and reads the header. `renames` and errors are those
  /// of FrameTable::Read.
  explicit FrameReader(const std::string& path,
                       const std::map<std::string, std::string>& renames = {});

  /// Makes `table` the next rows of the file, at most `rows` of them; false if
  /// there is none left, the table being empty then. InputError (file:line:
  /// column) for a bad row, and for a file without any.
  bool Read(std::size_t rows, FrameTable* table);

  /// Passes over rows without looking into them; fewer only at the end of the
  /// file. Returns how many.
  std::size_t Skip(std::size_t rows);

  /// Rows read or skipped so far.
  std::size_t position() const { return position_; }

 private:
  // Appends the current line to the table.
  void ReadRow(FrameTable* table) const;

  std::string path_;
  CsvReader reader_;
  std::vector<std::string> headers_;
  std::size_t position_ = 0;
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_READER_H_
