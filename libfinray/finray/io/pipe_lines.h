#ifndef FINRAY_IO_PIPE_LINES_H_
#define FINRAY_IO_PIPE_LINES_H_

#include <cstddef>
#include <string>
#include <vector>

#include "finray/io/csv_line.h"

namespace finray {

/// Lines of a pipe as soon as they are there. Blank ones are passed over;
/// either kind of line end does no harm, nor does a last line without one.
class PipeLines {
 public:
  /// Reads from `file`, an open descriptor that stays its owner's. `source`
  /// names it in messages. As soon as `wake` (-1: none) can be read, that is
  /// the end.
  PipeLines(int file, int wake, const std::string& source);

  /// Goes to the next line, waiting for it; false at the end. Throws InputError
  /// if the pipe cannot be read or a line is too long.
  bool Next();
  /// The current one; its text lives until the next.
  const CsvLine& line() const { return line_; }

 private:
  // Waits for more bytes; false if there will be none.
  bool Fill();
  // Moves the next line to line_; false if it is not there as a whole.
  bool Take();

  int file_, wake_;
  std::string source_;
  std::vector<char> buffer_;
  // Bytes from begin_ to end_ are to be used; those before searched_ hold no
  // line end.
  std::size_t begin_ = 0, searched_ = 0, end_ = 0;
  bool ended_ = false;
  CsvLine line_;
};

}  // namespace finray

#endif  // FINRAY_IO_PIPE_LINES_H_
