// A warm fit takes no memory.

#include <gtest/gtest.h>

#include "count_allocations.h"
#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/gauge_surface.h"
#include "finray/sensing/gauge_table.h"
#include "sensing/gauge_log.h"

namespace finray {
namespace {

#ifdef FINRAY_COUNTS_ALLOCATIONS

TEST(SensingAllocationTest, WarmFitsTakeNone) {
  GaugeLog log(600);
  // Some frames jump.
  for (int i = 100; i < 600; i += 97) log.angles.col(i) *= 1.5;
  for (const Scheme scheme : {Scheme::kTaylor8, Scheme::kTaylor}) {
    const Discretization discretization{scheme, 12};
    ContactFit fit(PaperFinger(), discretization);
    fit.set_tolerance(1e-5);
    fit.set_state(log.StateAt(discretization, 0));
    std::vector<PointContact> contacts = {log.truth[0]};
    Eigen::VectorXd angles(4), weights(4);
    long before = 0;
    for (int i = 0; i < 600; ++i) {
      if (i == 100) before = allocations;
      angles = log.angles.col(i);
      weights = log.weights.col(i);
      ASSERT_TRUE(fit.Follow(angles, weights, &contacts));
    }
    EXPECT_EQ(allocations - before, 0);

    const double most_N = GaugeTable::HeaviestForce_N(PaperFinger());
    const GaugeSurface surface(EquilibriumSolver(PaperFinger(), discretization),
                               0, {}, most_N);
    ContactSolution solution;
    // The first round makes the cells of the surface.
    for (int round = 0; round < 2; ++round) {
      before = allocations;
      PointContact last = log.truth[0];
      for (int i = 0; i < 600; ++i) {
        ASSERT_TRUE(surface.Fit(log.angles.col(i), log.weights.col(i), most_N,
                                last, &solution));
        last = solution.contacts[0];
      }
    }
    EXPECT_EQ(allocations - before, 0);
  }
}

#else

TEST(SensingAllocationTest, WarmFitsTakeNone) {
  GTEST_SKIP() << "malloc cannot be replaced here";
}

#endif

}  // namespace
}  // namespace finray
