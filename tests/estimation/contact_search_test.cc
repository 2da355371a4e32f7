#include "finray/estimation/contact_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "test_finger.h"

namespace finray {
namespace {

// A search finds what fits from every node of the table find.
class ContactSearchTest : public testing::Test {
 protected:
  ContactSearchTest() : finger_(PaperFinger()), search_(finger_, {}, {}) {}

  Measurements RowOf(double arc_mm, double normal_N, double noise_std) {
    EXPECT_TRUE(solver_.Solve({{arc_mm, normal_N}}));
    Measurements row;
    for (std::size_t j = 0; j < finger_.gauges.size(); ++j) {
      const Gauge& gauge = finger_.gauges[j];
      row.gauges_V.push_back(
          gauge.Volts(solver_.outputs()[static_cast<Eigen::Index>(j)]) +
          noise_std * gauge.noise_V * normal_(generator_));
    }
    return row;
  }

  std::vector<ContactSolution> FromAllNodes(const Measurements& readings) {
    RowFit fit(finger_, {}, {}, &search_.tables()->surface(),
               search_.most_force_N());
    fit.set_row(readings);
    std::vector<ContactSolution> found;
    for (const GaugeTable::Row& row : search_.table().rows()) {
      for (std::size_t k = 1; k < row.nodes.size(); ++k) {
        ContactStart start;
        start.count = 1;
        start.contacts[0] = {row.arc_mm, row.nodes[k].normal_N};
        start.state = &row.nodes[k].state;
        ContactSolution end;
        if (fit.Fit(start, RowFit::Model::kSurface, 60, &end) &&
            end.contacts[0].normal_N > 1e-6 &&
            fit.evaluations() < RowFit::kMostEvaluations) {
          found.push_back(end);
        }
      }
    }
    return found;
  }

  bool IsOnBound(const ContactSolution& of) const {
    return search_.OnBound(of.contacts[0].arc_mm, of.contacts[0].normal_N);
  }

  Finger finger_;
  EquilibriumSolver solver_{finger_, {}};
  ContactSearch search_;
  std::mt19937 generator_{4};
  std::normal_distribution<double> normal_;
};

TEST_F(ContactSearchTest, MissesNoMinimumThatExplainsTheFrame) {
  std::uniform_real_distribution<double> arc_mm(5, 138), log_force(-3, 2.3);
  int rivals = 0;
  for (int trial = 0; trial < 150; ++trial) {
    // Noise that the finger does not declare, too.
    const double noise_std = trial % 10 == 0 ? 5 : 1;
    const Measurements row =
        RowOf(arc_mm(generator_), std::exp(log_force(generator_)), noise_std);
    PackedReadings packed;
    Pack(finger_, {}, row, &packed);
    search_.Begin(row);
    ASSERT_TRUE(search_.Search(1, packed));
    const ContactSolution& best = search_.best();
    for (const ContactSolution& other : FromAllNodes(row)) {
      // A minimum on a bound yields to others.
      if (IsOnBound(other)) continue;
      EXPECT_GE(other.chi2, best.chi2 - 1e-6);
      const Eigen::Vector2d apart(
          other.contacts[0].arc_mm - best.contacts[0].arc_mm,
          other.contacts[0].normal_N - best.contacts[0].normal_N);
      const bool rival =
          other.chi2 < best.chi2 + ContactSearch::kWithinNoise &&
          apart.dot(best.information * apart) > ContactSearch::kWithinNoise;
      if (!rival) continue;
      ++rivals;
      EXPECT_TRUE(search_.rival() != nullptr || IsOnBound(best))
          << trial << ": " << other.contacts[0].arc_mm << " mm, "
          << other.contacts[0].normal_N << " N beside "
          << best.contacts[0].arc_mm << " mm, " << best.contacts[0].normal_N
          << " N";
    }
  }
  EXPECT_GT(rivals, 100);
}

}  // namespace
}  // namespace finray
