#ifndef FINRAY_IO_FRAME_ROWS_H_
#define FINRAY_IO_FRAME_ROWS_H_

#include <cstddef>
#include <deque>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace finray {

/// Rows of a frame table, cell by cell. Clear() keeps the memory.
class FrameRows {
 public:
  struct Cell {
    /// The number is NaN for text and for a cell that was not measured.
    double number = std::numeric_limits<double>::quiet_NaN();
    /// The text has no quotes. It refers to the line that was parsed.
    std::string_view text;
  };

  void Clear() {
    rows_ = 0;
    cells_.clear();
    unquoted_.clear();
  }
  std::size_t rows() const { return rows_; }
  const Cell& at(std::size_t row, std::size_t column) const {
    return cells_[row * columns_ + column];
  }

 private:
  friend class FrameParser;

  // Appends an empty row and returns its first cell.
  Cell* AddRow(std::size_t columns) {
    columns_ = columns;
    ++rows_;
    cells_.resize(rows_ * columns);
    return &cells_[(rows_ - 1) * columns];
  }

  std::size_t rows_ = 0, columns_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::string_view> split_;  // the line that is being read
  std::deque<std::string> unquoted_;     // a deque does not move its strings
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_ROWS_H_
