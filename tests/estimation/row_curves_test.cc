#include "finray/estimation/row_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "finray/estimation/row_boxes.h"
#include "finray/ladder/instruction_set.h"

namespace finray {
namespace {

// Smooth curves s_j(f) = a_j sin(b_j f + c) of some rows. The last rows are
// padding, and one row ends early.
class RowCurvesTest : public testing::TestWithParam<int> {
 protected:
  static constexpr int kRows = 16, kUsed = 11, kShort = 4, kShortForces = 4;

  RowCurvesTest()
      : values_(GetParam()),
        value_(kRows * values_ * forces_.size(), std::nan("")),
        by_force_(value_) {
    for (int row = 0; row < kUsed; ++row) {
      const int forces = row == kShort ? kShortForces : Forces();
      for (int k = 0; k < forces; ++k) {
        for (int j = 0; j < values_; ++j) {
          value_[At(k, j, row)] = std::sin(Phase(j, row, forces_[k]));
          by_force_[At(k, j, row)] =
              Rate(j) * std::cos(Phase(j, row, forces_[k]));
        }
      }
    }
  }

  int Forces() const { return static_cast<int>(forces_.size()); }
  int At(int force, int value, int row) const {
    return (force * values_ + value) * kRows + row;
  }
  static double Rate(int j) { return 0.1 + 0.05 * (j % 4); }
  static double Phase(int j, int row, double force) {
    return Rate(j) * force + 0.1 * j + 0.05 * row;
  }

  // chi2 at a share of the way to node `to` of a row, by Hermite's basis.
  double Chi2(int row, int to, double t) const {
    double chi2 = 0;
    const double width = forces_[to] - forces_[to - 1];
    for (int j = 0; j < values_; ++j) {
      const double at =
          (1 + 2 * t) * (1 - t) * (1 - t) * value_[At(to - 1, j, row)] +
          t * t * (3 - 2 * t) * value_[At(to, j, row)] +
          width * t * (1 - t) *
              ((1 - t) * by_force_[At(to - 1, j, row)] -
               t * by_force_[At(to, j, row)]);
      const double off = weights_[j] * (at - measured_[j]);
      chi2 += off * off;
    }
    return chi2;
  }

  // Readings at a force and a place between rows.
  void Measure(double force, double at_row, bool all, double noise_std) {
    std::normal_distribution<double> noise(0, noise_std);
    measured_.clear();
    weights_.clear();
    for (int j = 0; j < values_; ++j) {
      measured_.push_back(std::sin(Rate(j) * force + 0.1 * j + 0.05 * at_row) +
                          noise(generator_));
      weights_.push_back(j == 2 && !all ? 0 : 300);
    }
  }

  RowCurves Curves() const {
    return {kRows,          Forces(),      values_,
            forces_.data(), value_.data(), by_force_.data()};
  }

  const std::vector<double> forces_ = {0, 0.5, 1, 2, 4, 7, 9};
  const int values_;
  std::vector<double> value_, by_force_, measured_, weights_;
  std::mt19937_64 generator_{3};
};

constexpr double kAnyChi2 = std::numeric_limits<double>::infinity();

// Every instruction set finds the least point of each cubic, against dense
// samples of the row. Readings that no row explains may have two minima.
TEST_P(RowCurvesTest, AreTheNearestPoints) {
  std::uniform_real_distribution<double> force(0, 9), row_of(0, kUsed - 1);
  std::vector<double> chi2(kRows), to(kRows), share(kRows);
  int checked = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const double f = force(generator_), at_row = row_of(generator_);
    Measure(f, at_row, trial % 3 != 0, 0.003);
    const RowCurves curves = Curves();
    const RowBoxes boxes(curves);
    for (int set = 0; set < InstructionSets(); ++set) {
      FindRowMinima(curves, boxes, measured_.data(), weights_.data(), kAnyChi2,
                    {chi2.data(), to.data(), share.data()}, set);
      for (int row = 0; row < kRows; ++row) {
        if (row >= kUsed) {
          EXPECT_EQ(to[row], 0) << "padding";
          continue;
        }
        const int end = static_cast<int>(to[row]);
        ASSERT_GE(end, 1);
        ASSERT_LT(end, row == kShort ? kShortForces : Forces());
        // The last step is expected, not evaluated.
        EXPECT_NEAR(chi2[row], Chi2(row, end, share[row]),
                    1e-6 * (1 + chi2[row]));
        if (std::abs(row - at_row) > 1) continue;
        double least = std::numeric_limits<double>::infinity();
        for (int k = 1; k < (row == kShort ? kShortForces : Forces()); ++k) {
          for (int i = 0; i <= 400; ++i) {
            least = std::min(least, Chi2(row, k, i / 400.0));
          }
        }
        EXPECT_LT(chi2[row], least + 0.1 * std::sqrt(least) + 0.2)
            << InstructionSetName(set) << ", row " << row;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 150);
}

// Rows that a limit leaves out are those beyond it.
TEST_P(RowCurvesTest, ALimitLeavesOutOnlyFartherRows) {
  std::uniform_real_distribution<double> force(0, 9), row_of(0, kUsed - 1);
  std::vector<double> all_chi2(kRows), all_to(kRows), all_share(kRows);
  std::vector<double> chi2(kRows), to(kRows), share(kRows);
  const RowCurves curves = Curves();
  const RowBoxes boxes(curves);
  int below = 0, left_out = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Measure(force(generator_), row_of(generator_), trial % 3 != 0, 0.003);
    const double most_chi2 = trial % 2 == 0 ? 50 : 500;
    for (int set = 0; set < InstructionSets(); ++set) {
      FindRowMinima(curves, boxes, measured_.data(), weights_.data(), kAnyChi2,
                    {all_chi2.data(), all_to.data(), all_share.data()}, set);
      FindRowMinima(curves, boxes, measured_.data(), weights_.data(), most_chi2,
                    {chi2.data(), to.data(), share.data()}, set);
      for (int row = 0; row < kRows; ++row) {
        if (all_chi2[row] < most_chi2) {
          ++below;
          EXPECT_NEAR(chi2[row], all_chi2[row], 1e-6 * (1 + chi2[row]));
          EXPECT_NEAR(to[row] + share[row], all_to[row] + all_share[row], 1e-5);
        } else {
          EXPECT_GE(chi2[row], most_chi2);
          left_out += row < kUsed && to[row] == 0;
        }
      }
    }
  }
  EXPECT_GT(below, 500);
  EXPECT_GT(left_out, 200);
}

// Also more values than a kernel keeps the cubics of.
INSTANTIATE_TEST_SUITE_P(Values, RowCurvesTest, testing::Values(3, 4, 19));

}  // namespace
}  // namespace finray
