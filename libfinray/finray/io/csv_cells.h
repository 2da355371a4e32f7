#ifndef FINRAY_IO_CSV_CELLS_H_
#define FINRAY_IO_CSV_CELLS_H_

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace finray {

/// Without spaces and tabs at both ends.
std::string_view Trimmed(std::string_view text);

/// The cells of one line of RFC 4180 CSV. Spaces around cells do not count,
/// those inside quotes do.
class CsvCells {
 public:
  /// Splits a line; the cells refer to it and live until the next Split.
  /// Returns "" or what is wrong with the last of cells().
  std::string Split(std::string_view line);

  const std::vector<std::string_view>& cells() const { return cells_; }

 private:
  std::vector<std::string_view> cells_;
  std::deque<std::string> unquoted_;  // strings keep their place
};

/// A cell as it is written: quoted where it would not read back the same.
std::string CsvText(const std::string& cell);

}  // namespace finray

#endif  // FINRAY_IO_CSV_CELLS_H_
