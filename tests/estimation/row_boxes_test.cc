#include "finray/estimation/row_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace finray {
namespace {

// Values s_j = a_j sin(b f + c row + j) with a kink half way between two rows,
// as a rib makes one.
constexpr int kBoxRows = 24, kBoxUsed = 19, kBoxValues = 3;
constexpr double kKinkRow = 10.5;
constexpr int kShortBoxRow = 5, kShortBoxForces = 3;

double SheetValue(int j, double row, double force) {
  const double kink = 0.1 * std::abs(row - kKinkRow) * force;
  return (1 + j) * std::sin(0.2 * force + 0.15 * row + j) + (j == 1 ? kink : 0);
}

// The cubic of a row between two nodes.
double CubicValue(const RowCurves& curves, int k, int j, int row, double t) {
  const auto at = [&](const double* of, int node) {
    return of[(node * curves.values + j) * curves.rows + row];
  };
  const double width = curves.force_N[k + 1] - curves.force_N[k];
  return (1 + 2 * t) * (1 - t) * (1 - t) * at(curves.value, k) +
         t * t * (3 - 2 * t) * at(curves.value, k + 1) +
         width * t * (1 - t) *
             ((1 - t) * at(curves.by_force, k) -
              t * at(curves.by_force, k + 1));
}

class RowBoxesTest : public testing::Test {
 protected:
  RowBoxesTest()
      : value_(kBoxRows * kBoxValues * forces_.size(), std::nan("")),
        by_force_(value_) {
    for (int row = 0; row < kBoxUsed; ++row) {
      const int forces = row == kShortBoxRow ? kShortBoxForces : Forces();
      for (int k = 0; k < forces; ++k) {
        for (int j = 0; j < kBoxValues; ++j) {
          const int at = (k * kBoxValues + j) * kBoxRows + row;
          constexpr double kStep = 1e-4;
          value_[at] = SheetValue(j, row, forces_[k]);
          by_force_[at] = (SheetValue(j, row, forces_[k] + kStep) -
                           SheetValue(j, row, forces_[k] - kStep)) /
                          (2 * kStep);
        }
      }
    }
  }

  int Forces() const { return static_cast<int>(forces_.size()); }
  RowCurves Curves() const {
    return {kBoxRows,       Forces(),      kBoxValues,
            forces_.data(), value_.data(), by_force_.data()};
  }

  const std::vector<double> forces_ = {0, 0.5, 1, 2, 3};
  std::vector<double> value_, by_force_;
};

TEST_F(RowBoxesTest, HoldRowsAndWhatLiesBetweenThem) {
  const RowCurves curves = Curves();
  const RowBoxes boxes(curves);
  ASSERT_EQ(boxes.chords, RowCurves::Padded(Forces() - 1));
  const auto expect_inside = [&](int group, int j, int k, double value) {
    const int i = (group * kBoxValues + j) * boxes.chords + k;
    EXPECT_GE(value, boxes.low[i]) << group << " " << j << " " << k;
    EXPECT_LE(value, boxes.high[i]) << group << " " << j << " " << k;
  };
  for (int group = 0; group < kBoxRows / RowBoxes::kRows; ++group) {
    const double from = std::max(-0.5, group * RowBoxes::kRows - 1.0);
    const double to = std::min(kBoxUsed - 0.5, (group + 1.0) * RowBoxes::kRows);
    for (int j = 0; j < kBoxValues; ++j) {
      for (int k = 0; k + 1 < Forces(); ++k) {
        for (double row = from; row <= to; row += 0.125) {
          const bool beside_short =
              std::abs(row - kShortBoxRow) < 2 && k + 1 >= kShortBoxForces;
          for (double t = 0; t <= 1; t += 0.125) {
            if (beside_short) continue;
            const double force = forces_[k] + t * (forces_[k + 1] - forces_[k]);
            expect_inside(group, j, k, SheetValue(j, row, force));
            if (row != std::floor(row)) continue;
            expect_inside(group, j, k,
                          CubicValue(curves, k, j, static_cast<int>(row), t));
          }
        }
      }
    }
  }
}

TEST_F(RowBoxesTest, AreSmall) {
  const RowBoxes boxes(Curves());
  for (int j = 0; j < kBoxValues; ++j) {
    double least = 1e9, most = -1e9;
    for (double row = 7; row <= 16; ++row) {
      for (double force = 1; force <= 2; force += 0.125) {
        least = std::min(least, SheetValue(j, row, force));
        most = std::max(most, SheetValue(j, row, force));
      }
    }
    const int i = (1 * kBoxValues + j) * boxes.chords + 2;
    EXPECT_LT(boxes.high[i] - boxes.low[i], 1.2 * (most - least)) << j;
  }
}

TEST_F(RowBoxesTest, NoRowNoBox) {
  const RowBoxes boxes(Curves());
  const int padding = Forces() - 1;  // the first chord that no row has
  EXPECT_GT(boxes.low[padding], boxes.high[padding]);
}

}  // namespace
}  // namespace finray
