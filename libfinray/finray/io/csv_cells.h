#ifndef FINRAY_IO_CSV_CELLS_H_
#define FINRAY_IO_CSV_CELLS_H_

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace finray {

/// Returns the text without spaces and tabs at both ends.
inline std::string_view Trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Splits one line of RFC 4180 CSV into `cells`, which are delimited by a
/// comma, a semicolon or a tab. Spaces around a cell, and tabs that do not
/// delimit, are removed; they are kept inside quotes. Cells refer to the line.
/// A quoted cell refers to a string that is added to `unquoted`. Returns "" or
/// the error in the last cell.
const char* SplitCsvLine(std::string_view line, char delimiter,
                         std::vector<std::string_view>* cells,
                         std::deque<std::string>* unquoted);

/// Returns the finite number in a cell whose decimal mark is a point or a
/// comma, or nothing. There are no separators of thousands.
std::optional<double> NumberInCell(std::string_view cell, char decimal);

/// Appends a cell to a line of cells with commas between them, in quotes if it
/// would not read back the same without them.
void AppendCsvText(std::string_view cell, std::string* csv);

}  // namespace finray

#endif  // FINRAY_IO_CSV_CELLS_H_
