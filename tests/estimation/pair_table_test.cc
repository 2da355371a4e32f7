#include "finray/estimation/pair_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimation/gauge_volts.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr std::size_t kMostPairs = 12;

// Says whether both contacts of a start lie within 2 mm and 5 % of the true
// ones. The nodes are 11.7 mm and a factor of three apart.
bool IsNearBoth(const ContactStart& start, const PointContact* contacts) {
  for (int c = 0; c < 2; ++c) {
    if (std::abs(start.contacts[c].arc_mm - contacts[c].arc_mm) > 2 ||
        std::abs(start.contacts[c].normal_N / contacts[c].normal_N - 1) >
            0.05) {
      return false;
    }
  }
  return true;
}

// The readings of random pairs lead to one of few starts. Most starts of the
// grid end at that one, so that a frame need not be fitted from all of them.
TEST(PairTableTest, StartsDescendToTheContacts) {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 1e-4;
  EquilibriumSolver solver(finger, {});
  const PairTable table(&solver, 0);
  const Eigen::VectorXd weights = Weights(finger);
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform;
  std::vector<ContactStart> starts;
  int near = 0, all = 0;
  std::size_t count = 0;
  while (all < 200) {
    const double first = 20 + 60 * uniform(generator);
    const PointContact contacts[] = {
        {first, 1 + 6 * uniform(generator), 0},
        {first + 25 + 20 * uniform(generator), 1 + 6 * uniform(generator), 0}};
    if (contacts[1].arc_mm > 115) continue;
    ASSERT_TRUE(solver.Solve({contacts[0], contacts[1]}));
    ++all;
    table.FindStarts(solver.outputs().head(4), weights, kMostPairs, &starts);
    count += starts.size();
    bool found = false;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      found |= IsNearBoth(starts[i], contacts);
      ASSERT_NE(starts[i].state, nullptr);
      EXPECT_LE(starts[i].contacts[0].arc_mm, starts[i].contacts[1].arc_mm);
      EXPECT_GE(starts[i].chi2, starts[i == 0 ? 0 : i - 1].chi2);
    }
    near += found;
  }
  EXPECT_GE(near, 180);
  EXPECT_LT(static_cast<double>(count) / all, 4);
}

// A gauge without a reading has no part in it.
TEST(PairTableTest, LeavesOutAGauge) {
  const Finger finger = PaperFinger();
  EquilibriumSolver solver(finger, {});
  const PairTable table(&solver, 0);
  Eigen::VectorXd weights = Weights(finger);
  ASSERT_TRUE(solver.Solve({{45, 2, 0}, {95, 3, 0}}));
  Eigen::VectorXd angles = solver.outputs().head(4);
  weights[2] = 0;
  std::vector<ContactStart> with, without;
  table.FindStarts(angles, weights, kMostPairs, &with);
  angles[2] = 7;
  table.FindStarts(angles, weights, kMostPairs, &without);
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with[i].chi2, without[i].chi2);
    EXPECT_EQ(with[i].contacts[1].arc_mm, without[i].contacts[1].arc_mm);
  }
}

}  // namespace
}  // namespace finray
