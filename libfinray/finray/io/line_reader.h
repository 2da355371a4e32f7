#ifndef FINRAY_IO_LINE_READER_H_
#define FINRAY_IO_LINE_READER_H_

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace finray {

/// A line of a CSV file, without its end.
struct CsvLine {
  std::string_view text;
  int number = 0;    ///< In the file, from 1.
  bool nul = false;  ///< Whether the text holds a NUL byte.
};

/// Where a LineReader gets its bytes. It fills `buffer` with at most `size`
/// bytes and returns their number: 0 at the end, -1 if it was told to stop.
/// Throws InputError if it cannot read.
using ByteSource = std::function<int(char* buffer, int size)>;

/// Reads a CSV file or a pipe line by line. It skips blank lines, accepts LF
/// and CR LF as line ends, and the last line need not have one.
class LineReader {
 public:
  /// `name` is the name of the source in messages.
  LineReader(ByteSource bytes, const std::string& name);

  /// Goes to the next line. Returns false at the end, and as soon as the source
  /// was told to stop. Throws InputError if the source cannot be read or a line
  /// is longer than 16 MiB.
  bool Next();
  /// Whether a line of nothing but blanks with tabs counts as a line.
  void KeepTabs(bool keep) { keep_tabs_ = keep; }
  /// The current line. Its text is valid until the next call of Next().
  const CsvLine& line() const { return line_; }

 private:
  // Reads more bytes. Returns false if there will be none.
  bool Fill();
  // Moves the next line to line_. Returns false if its end has not been read
  // yet.
  bool Take();
  bool IsBlank() const;

  ByteSource bytes_;
  std::string name_;
  std::vector<char> buffer_;
  // The bytes from begin_ to end_ are not used yet. There is no line end
  // between begin_ and searched_.
  std::size_t begin_ = 0, searched_ = 0, end_ = 0;
  bool ended_ = false, keep_tabs_ = false;
  CsvLine line_;
};

/// Reads the lines of a file, which may be gzipped. Throws InputError if the
/// file cannot be read, is a folder or pipe, is damaged or cut short, or
/// unpacks to far more than a log of its size.
LineReader ReadFile(const std::string& path);

/// The bytes that arrive at `file`, an open descriptor, which the caller keeps
/// and closes. They stop as soon as the descriptor `wake` (-1: none) can be
/// read. `name` is the name of the pipe in messages.
ByteSource PipeBytes(int file, int wake, const std::string& name);
/// Reads their lines as soon as they arrive.
LineReader ReadPipe(int file, int wake, const std::string& name);

}  // namespace finray

#endif  // FINRAY_IO_LINE_READER_H_
