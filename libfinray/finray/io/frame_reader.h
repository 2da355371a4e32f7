#ifndef FINRAY_IO_FRAME_READER_H_
#define FINRAY_IO_FRAME_READER_H_

#include <cstddef>
#include <string>

#include "finray/io/column_mapping.h"
#include "finray/io/frame_parser.h"
#include "finray/io/frame_table.h"
#include "finray/io/line_block.h"
#include "finray/io/log_lines.h"

namespace finray {

/// Reads a frame table piece by piece, so that its memory does not grow with
/// the length of the file.
class FrameReader {
 public:
  /// Opens .csv or .csv.gz and reads the header. `mapping` and errors are those
  /// of FrameTable::Read. A file without rows is an error.
  explicit FrameReader(const std::string& path,
                       const ColumnMapping& mapping = {});

  /// Reads the next rows as lines, which parser() parses. It does not throw:
  /// the block holds the good lines and then the error. Returns false if the
  /// block holds neither.
  bool ReadLines(std::size_t rows, LineBlock* block);

  /// Skips rows without parsing them. Returns their number, which is less than
  /// `rows` only at the end of the file.
  std::size_t Skip(std::size_t rows);

  const FrameParser& parser() const { return lines_.parser(); }
  /// The number of rows that were read or skipped so far.
  std::size_t position() const { return position_; }

 private:
  friend class FrameTable;  // its Read() needs no copies of the lines

  bool NextRow();

  LogLines lines_;
  std::size_t position_ = 0;
  bool looked_ahead_ = false;  // the current row is not returned yet
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_READER_H_
