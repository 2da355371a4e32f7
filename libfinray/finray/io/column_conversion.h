#ifndef FINRAY_IO_COLUMN_CONVERSION_H_
#define FINRAY_IO_COLUMN_CONVERSION_H_

#include <string>
#include <string_view>

#include "finray/io/column_mapping.h"

namespace finray {

/// Turns the cells of a lab's column into numbers of a frame column:
/// value = scale * (number * multiply / divide + shift) + offset.
class ColumnConversion {
 public:
  /// Takes cells as they are.
  ColumnConversion() = default;
  /// `declared` is a unit that the log itself names for the column, or "". It
  /// is converted unless the rule has a unit, a scale or a format, which speak
  /// of the cell as it is written. Sets `error` if unit and column do not fit.
  ColumnConversion(const ColumnRule& rule, const std::string& declared,
                   std::string* error);

  /// Says whether the value is the number in the cell.
  bool IsIdentity() const { return identity_; }

  /// Returns the value of a cell that is measured, whose decimal mark is
  /// `decimal`. Sets `error` to what is expected if there is none.
  double Value(std::string_view cell, char decimal, std::string* error) const;

 private:
  void SetUnit(const Unit& unit, const Unit& target);
  void SetCounts(const AdcCounts& counts);

  TimeFormat format_ = TimeFormat::kNumber;
  double multiply_ = 1, divide_ = 1, shift_ = 0, scale_ = 1, offset_ = 0;
  bool identity_ = true;
  // The numbers that a cell may hold, if `bounds_` has words for them.
  double least_ = 0, most_ = 0;
  std::string bounds_;
};

}  // namespace finray

#endif  // FINRAY_IO_COLUMN_CONVERSION_H_
