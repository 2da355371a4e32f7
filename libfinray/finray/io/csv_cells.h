#ifndef FINRAY_IO_CSV_CELLS_H_
#define FINRAY_IO_CSV_CELLS_H_

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace finray {

/// Without spaces and tabs at both ends.
inline std::string_view Trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Makes `cells` those of one line of RFC 4180 CSV. Spaces around cells do not
/// count, those inside quotes do. The cells refer to the line, quoted ones to
/// strings that are added to `unquoted`. Returns "" or what is wrong with the
/// last of the cells.
const char* SplitCsvLine(std::string_view line,
                         std::vector<std::string_view>* cells,
                         std::deque<std::string>* unquoted);

/// Appends a cell as it is written: quoted where it would not read back the
/// same.
void AppendCsvText(std::string_view cell, std::string* csv);

}  // namespace finray

#endif  // FINRAY_IO_CSV_CELLS_H_
