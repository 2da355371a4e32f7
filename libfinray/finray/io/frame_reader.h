#ifndef FINRAY_IO_FRAME_READER_H_
#define FINRAY_IO_FRAME_READER_H_

#include <cstddef>
#include <map>
#include <string>

#include "finray/io/csv_reader.h"
#include "finray/io/frame_parser.h"
#include "finray/io/frame_table.h"
#include "finray/io/line_block.h"

namespace finray {

/// Reads a frame table piece by piece, so that the memory it takes does not
/// grow with the length of the file.
class FrameReader {
 public:
  /// Opens .csv or .csv.gz and reads the header. `renames` and errors are those
  /// of FrameTable::Read, a file without any row among them.
  explicit FrameReader(const std::string& path,
                       const std::map<std::string, std::string>& renames = {});

  /// Makes `table` the next rows of the file, at most `rows` of them; false if
  /// there is none left, the table being empty then. InputError (file:line:
  /// column) for a bad row.
  bool Read(std::size_t rows, FrameTable* table);

  /// The same as lines, to be parsed by parser(). Nothing is thrown: what is
  /// wrong stands in the block, behind the lines that were good. False if it
  /// holds neither.
  bool ReadLines(std::size_t rows, LineBlock* block);

  /// Passes over rows without looking into them; fewer only at the end of the
  /// file. Returns how many.
  std::size_t Skip(std::size_t rows);

  const FrameParser& parser() const { return parser_; }
  /// Rows read or skipped so far.
  std::size_t position() const { return position_; }

 private:
  bool NextRow();

  CsvReader reader_;
  FrameParser parser_;
  std::size_t position_ = 0;
  bool looked_ahead_ = false;  // the reader is at a row that is not read yet
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_READER_H_
