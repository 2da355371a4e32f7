#ifndef FINRAY_IO_FRAME_PARSER_H_
#define FINRAY_IO_FRAME_PARSER_H_

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "finray/io/csv_line.h"
#include "finray/io/frame_rows.h"

namespace finray {

/// Whether a line is the header of a frame table and no '#' comment or blank.
/// Takes byte order marks off its front: files put together from others have
/// them behind their comments too.
bool IsHeaderLine(CsvLine* line);

/// What a frame table's header says, and with it rows from lines. Any number of
/// threads may use one.
class FrameParser {
 public:
  /// `renames` maps a lab's own headers to vocabulary names, or the other way
  /// round where only that makes sense. InputError (path:line:column) for a bad
  /// header.
  FrameParser(const std::string& path, const CsvLine& header,
              const std::map<std::string, std::string>& renames);

  const std::string& path() const { return path_; }
  const std::vector<std::string>& names() const { return names_; }
  /// Whether a column holds numbers; others are kept as text.
  bool IsNumeric(std::size_t column) const { return numeric_[column]; }
  std::optional<std::size_t> Find(const std::string& name) const;
  /// InputError naming the nearest column if there is none of that name.
  std::size_t Require(const std::string& name) const;

  /// Appends a line as a row. InputError (path:line:column) for one with the
  /// wrong number of cells or a cell that is no number; the row then holds the
  /// cells before that.
  void Parse(const CsvLine& line, FrameRows* rows) const;

 private:
  [[noreturn]] void Fail(int line, const std::string& message) const;
  [[noreturn]] void FailAt(int line, std::size_t cell,
                           const std::string& message) const;
  // Index of the first cell that holds a NUL byte, their number if none does.
  static std::size_t FirstNul(const std::vector<std::string_view>& cells);

  std::string path_;
  std::vector<std::string> names_;
  std::vector<char> numeric_;
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_PARSER_H_
