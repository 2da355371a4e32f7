#ifndef FINRAY_IO_LOG_LINES_H_
#define FINRAY_IO_LOG_LINES_H_

#include <cstddef>
#include <string>

#include "finray/io/column_mapping.h"
#include "finray/io/frame_parser.h"
#include "finray/io/line_block.h"
#include "finray/io/line_reader.h"

namespace finray {

/// The rows of a log in a file or a pipe, as lines, behind its header. Lines
/// before the header are skipped. The header is the line that the mapping
/// states, or the first one with all columns of the mapping (without a mapping
/// with any column of the vocabulary), or else the one of the first 100 lines
/// that has the most of these names, the first one if there is no such name.
class LogLines {
 public:
  /// Reads up to the header. `name` is that of the source in messages. Throws
  /// InputError for a source without a header or with a bad one.
  LogLines(LineReader lines, const std::string& name,
           const ColumnMapping& mapping);
  LogLines(const LogLines&) = delete;  // line() refers to what it holds
  LogLines& operator=(const LogLines&) = delete;

  /// Goes to the next row. Units below the header are no row. It reads no line
  /// beyond that row, and learns the decimal mark from row to row if
  /// FindDecimal() was not called. Returns false at the end, and if the source
  /// was told to stop.
  bool Next();
  /// The current row; valid until the next call of Next().
  const CsvLine& line() const { return line_; }

  /// Looks for the decimal mark in the first rows of a file, so that the parser
  /// does not change any more.
  void FindDecimal();

  const FrameParser& parser() const { return parser_; }

 private:
  CsvLine FindHeader(const std::string& name, const ColumnMapping& mapping);
  // Goes to the next line behind the header.
  bool NextLine();
  bool SkipUnits();

  LineReader lines_;
  LineBlock ahead_;             // lines that were read to decide something
  std::size_t next_ahead_ = 0;  // the first one that is not used yet
  CsvLine line_;
  bool looked_for_units_ = false, waits_ = false;
  FrameParser parser_;
};

}  // namespace finray

#endif  // FINRAY_IO_LOG_LINES_H_
