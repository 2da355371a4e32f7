#include "finray/estimation/gauge_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "finray/objects/circle_centre.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kRadius_mm = 15, kNoise_rad = 3e-4, kObject_mm = 0.05;

// Angles and the circle's centre under a contact, with noise.
class GaugeTableTest : public testing::Test {
 protected:
  GaugeTableTest()
      : solver_(PaperFinger(), {}), table_(&solver_, 0, kRadius_mm) {
    weights_.setConstant(6, 1 / kNoise_rad);
    weights_.tail<2>().setConstant(1 / kObject_mm);
  }

  // Returns noisy measurements of a contact that lies between nodes, where the
  // finger senses it well.
  Eigen::VectorXd Measured(double arc_mm, double normal_N) {
    EXPECT_TRUE(solver_.Solve({{arc_mm, normal_N}}));
    Eigen::VectorXd values(6);
    values.head<4>() = solver_.outputs().head<4>();
    values.tail<2>() = CircleCentre(solver_.contact_pose(0), kRadius_mm);
    for (Eigen::Index j = 0; j < 6; ++j) {
      values[j] += normal_(generator_) / weights_[j];
    }
    return values;
  }

  EquilibriumSolver solver_;
  GaugeTable table_;
  Eigen::VectorXd weights_;
  std::mt19937 generator_{1};
  std::normal_distribution<double> normal_;
};

TEST_F(GaugeTableTest, BestStartIsTheBestOfAll) {
  std::vector<ContactStart> profile, starts;
  for (double arc_mm = 30; arc_mm < 110; arc_mm += 2.3) {
    for (const double normal_N : {0.9, 2.0, 4.1, 7.3}) {
      const Eigen::VectorXd values = Measured(arc_mm, normal_N);
      table_.Profile(values, weights_, GaugeTable::kAnyChi2, &profile);
      GaugeTable::FindStarts(profile, &starts);
      ASSERT_FALSE(starts.empty());
      const ContactStart best = table_.BestStart(values, weights_);
      ASSERT_NE(best.state, nullptr);
      EXPECT_LE(
          std::abs(best.contacts[0].arc_mm - starts[0].contacts[0].arc_mm),
          1.01 * table_.row_spacing_mm());
      EXPECT_LE(std::abs(best.contacts[0].arc_mm - arc_mm),
                1.01 * table_.row_spacing_mm());
      EXPECT_NEAR(best.contacts[0].normal_N, normal_N, 0.25 * normal_N);
    }
  }
}

// Against the equilibria of a grid finer than the table.
TEST(GaugeTableLimitTest, NoContactNearALeftOutRowIsBelowTheLimit) {
  EquilibriumSolver solver(PaperFinger(), {});
  const GaugeTable table(&solver, 0, {});
  std::vector<Eigen::VectorXd> grid;
  std::vector<std::size_t> row_of;
  const double spacing_mm = table.row_spacing_mm();
  for (double arc_mm = 0.2; arc_mm < 140; arc_mm += 0.61) {
    solver.Reset();  // the last force was heavy
    for (double normal_N = 0.01; normal_N < 25; normal_N *= 1.17) {
      ASSERT_TRUE(solver.Solve({{arc_mm, normal_N}}));
      grid.emplace_back(solver.outputs().head<4>());
      row_of.push_back(static_cast<std::size_t>(arc_mm / spacing_mm));
    }
  }
  std::mt19937 generator(2);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<std::size_t> any(0, grid.size() - 1);
  int left_out = 0, below = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const double noise_rad = trial % 2 == 0 ? 1e-4 : 1e-3;
    const Eigen::VectorXd weights = Eigen::VectorXd::Constant(4, 1 / noise_rad);
    Eigen::VectorXd values = grid[any(generator)];
    for (double& value : values) value += noise_rad * normal(generator);
    const double most_chi2 = trial % 3 == 0 ? 400 : 50;
    std::vector<ContactStart> all, some;
    table.Profile(values, weights, GaugeTable::kAnyChi2, &all);
    table.Profile(values, weights, most_chi2, &some);
    for (std::size_t i = 0; i < all.size(); ++i) {
      left_out += some[i].count == 0;
      if (all[i].chi2 < most_chi2) {
        EXPECT_NEAR(some[i].chi2, all[i].chi2, 1e-6);
        EXPECT_EQ(some[i].state, all[i].state);
      } else {
        EXPECT_GE(some[i].chi2, most_chi2);
      }
    }
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const double chi2 = ((grid[i] - values) / noise_rad).squaredNorm();
      if (chi2 >= most_chi2) continue;
      ++below;
      EXPECT_GT(some[row_of[i]].count, 0) << row_of[i];
    }
  }
  EXPECT_GT(left_out, 4000);
  EXPECT_GT(below, 1000);
}

void ExpectSameNodes(const GaugeTable::Row& one, const GaugeTable::Row& other) {
  ASSERT_EQ(one.nodes.size(), other.nodes.size());
  for (std::size_t k = 0; k < one.nodes.size(); ++k) {
    EXPECT_EQ(one.nodes[k].values, other.nodes[k].values);
  }
}

TEST_F(GaugeTableTest, ThreadsDoNotChangeIt) {
  const GaugeTable other(&solver_, 0, kRadius_mm, {}, 3);
  ASSERT_EQ(other.rows().size(), table_.rows().size());
  for (std::size_t i = 0; i < other.rows().size(); ++i) {
    EXPECT_EQ(other.rows()[i].arc_mm, table_.rows()[i].arc_mm);
    ExpectSameNodes(other.rows()[i], table_.rows()[i]);
  }
}

// Calibrations use this coarser table.
TEST_F(GaugeTableTest, HalfTheRowsLessExact) {
  EquilibriumSolver rough = solver_;
  rough.set_tolerance(1e-6);
  constexpr int kRows = GaugeTable::kMostRows / 2;
  const GaugeTable one(&rough, 0, kRadius_mm, {}, 1, kRows);
  const GaugeTable three(&rough, 0, kRadius_mm, {}, 3, kRows);
  ASSERT_EQ(one.rows().size(), kRows);
  EXPECT_DOUBLE_EQ(one.row_spacing_mm(), 2 * table_.row_spacing_mm());
  for (int i = 0; i < kRows; ++i) {
    const GaugeTable::Row& row = one.rows()[i];
    ExpectSameNodes(three.rows()[i], row);
    for (std::size_t k = 0; k < row.nodes.size(); ++k) {
      EXPECT_TRUE(solver_.Solve({{row.arc_mm, row.nodes[k].normal_N}}));
      EXPECT_LT((row.nodes[k].values.head<4>() - solver_.outputs().head<4>())
                    .lpNorm<Eigen::Infinity>(),
                1e-2 * kNoise_rad);
    }
  }
}

}  // namespace
}  // namespace finray
