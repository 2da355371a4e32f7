#include "finray/io/column_conversion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "finray/io/csv_cells.h"
#include "finray/io/iso_time.h"
#include "finray/io/message_text.h"
#include "finray/io/nan.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// Epoch times lie between these years, so that a wrong unit is noticed.
constexpr double kYear1980_s = 315532800, kYear2100_s = 4102444800;

}  // namespace

ColumnConversion::ColumnConversion(const ColumnRule& rule,
                                   const std::string& declared,
                                   std::string* error)
    : format_(rule.format),
      scale_(rule.scale.value_or(1)),
      offset_(rule.offset) {
  const Unit target = UnitOfColumn(rule.to);
  std::optional<Unit> unit = rule.unit;
  const bool speaks =
      rule.scale || rule.counts || format_ != TimeFormat::kNumber;
  if (!declared.empty() && (unit || !speaks)) {
    const Unit found = *FindUnit(declared);
    if (unit && unit->name != found.name) {
      *error = "the log gives it in " + declared + ", its name or mapping in " +
               unit->name;
    } else if (found.dimension != target.dimension) {
      *error =
          "the log gives it in " + declared +
          (target.dimension == Dimension::kNone
               ? ", but the column has no unit"
               : ", expected one of " + Joined(UnitNames(target.dimension)));
    }
    if (!error->empty()) return;
    unit = found;
  }
  if (unit) SetUnit(*unit, target);
  if (rule.counts) SetCounts(*rule.counts);
  if (format_ == TimeFormat::kEpoch) {
    least_ = kYear1980_s * divide_ / multiply_;
    most_ = kYear2100_s * divide_ / multiply_;
    bounds_ = "a time since 1970 in " + (unit ? unit->name : "s");
  }
  identity_ = format_ == TimeFormat::kNumber && multiply_ == divide_ &&
              shift_ == 0 && scale_ == 1 && offset_ == 0 && bounds_.empty();
}

void ColumnConversion::SetUnit(const Unit& unit, const Unit& target) {
  if (unit.name == target.name) return;
  multiply_ = unit.multiply * target.divide;
  divide_ = unit.divide * target.multiply;
  shift_ = unit.shift;
}

void ColumnConversion::SetCounts(const AdcCounts& counts) {
  const double codes = std::ldexp(1, counts.bits);
  const double span_V = counts.to_V - counts.from_V;
  multiply_ = span_V;
  divide_ = codes;
  shift_ = counts.is_signed ? counts.from_V + span_V / 2 : counts.from_V;
  least_ = counts.is_signed ? -codes / 2 : 0;
  most_ = least_ + codes - 1;
  bounds_ = FormatText("counts of %d bits", counts.bits);
}

double ColumnConversion::Value(std::string_view cell, char decimal,
                               std::string* error) const {
  std::optional<double> number;
  if (format_ == TimeFormat::kIso8601) {
    number = IsoTime(cell);
    if (!number) {
      *error = "expected a time such as 2026-11-24T10:30:15.250+01:00, found " +
               ShownText(cell);
      return kNaN;
    }
  } else {
    number = NumberInCell(cell, decimal);
    if (!number) {
      *error = "expected a number" +
               std::string(decimal == ',' ? " with a decimal comma" : "") +
               ", found " + ShownText(cell);
      return kNaN;
    }
  }
  if (!bounds_.empty() && !(*number >= least_ && *number <= most_)) {
    *error = "expected " + bounds_ +
             FormatText(", %.10g to %.10g, found ", least_, most_) +
             ShownText(cell);
    return kNaN;
  }
  if (identity_) return *number;
  const double value =
      scale_ * (*number * multiply_ / divide_ + shift_) + offset_;
  if (!std::isfinite(value)) {
    *error = "is too large when converted: " + ShownText(cell);
    return kNaN;
  }
  return value;
}

}  // namespace finray
