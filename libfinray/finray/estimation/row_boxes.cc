#include "finray/estimation/row_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace finray {
namespace {

// A value between two rows leaves the hull of three rows by no more than this
// part of their second difference, even with a kink half way.
constexpr double kBulge = 0.5;
// Half a row beyond the last one, it leaves a straight line by no more than
// this part.
constexpr double kBeyondLast = 0.5;

struct Box {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  // Nothing changes with a NaN, the value of a node that is missing.
  void Add(double value) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
};

}  // namespace

RowBoxes::RowBoxes(const RowCurves& curves)
    : chords(RowCurves::Padded(curves.forces - 1)) {
  const int groups = curves.rows / kRows;
  const auto size = static_cast<std::size_t>(groups * curves.values * chords);
  low.assign(size, Box().low);
  high.assign(size, Box().high);
  const auto at = [&](const double* of, int k, int j, int row) {
    return row < 0 || row >= curves.rows
               ? std::nan("")
               : of[(k * curves.values + j) * curves.rows + row];
  };
  // The values of a row, from one force to the next or one node of it.
  const auto add_cubic = [&](int k, int j, int row, Box* box) {
    const double third = (curves.force_N[k + 1] - curves.force_N[k]) / 3;
    const double from = at(curves.value, k, j, row);
    const double to = at(curves.value, k + 1, j, row);
    if (std::isnan(from) || std::isnan(to)) return;
    box->Add(from);
    box->Add(from + third * at(curves.by_force, k, j, row));
    box->Add(to - third * at(curves.by_force, k + 1, j, row));
    box->Add(to);
  };
  // The values at a node and between rows beside it.
  const auto add_bulge = [&](int k, int j, int row, Box* box) {
    const auto value = [&](int i) { return at(curves.value, k, j, i); };
    const auto bend = [&](int i) {
      return std::abs(value(i - 1) - 2 * value(i) + value(i + 1));
    };
    const double here = value(row);
    box->Add(here - kBulge * bend(row));
    box->Add(here + kBulge * bend(row));
    // Values go on half a row beyond the last ones.
    for (const int inward : {-1, 1}) {
      if (!std::isnan(value(row - inward))) continue;
      const double end = here + 0.5 * (here - value(row + inward));
      box->Add(end - kBeyondLast * bend(row + inward));
      box->Add(end + kBeyondLast * bend(row + inward));
    }
  };
  for (int group = 0; group < groups; ++group) {
    for (int j = 0; j < curves.values; ++j) {
      for (int k = 0; k + 1 < curves.forces; ++k) {
        Box box;
        for (int row = group * kRows - 1; row <= (group + 1) * kRows; ++row) {
          add_cubic(k, j, row, &box);
          if (std::isnan(at(curves.value, k + 1, j, row))) continue;
          for (const int end : {k, k + 1}) add_bulge(end, j, row, &box);
        }
        const int i = (group * curves.values + j) * chords + k;
        low[i] = box.low;
        high[i] = box.high;
      }
    }
  }
}

}  // namespace finray
