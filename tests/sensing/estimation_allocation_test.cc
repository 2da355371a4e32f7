// A warm fit takes no memory.

#include <gtest/gtest.h>

#include "count_allocations.h"
#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/fast/frame_group_fit.h"
#include "finray/sensing/gauge_surface.h"
#include "sensing/gauge_log.h"

namespace finray {
namespace {

#ifdef FINRAY_COUNTS_ALLOCATIONS

TEST(SensingAllocationTest, WarmFitsTakeNone) {
  GaugeLog log(1280);
  // Frames that lanes leave to a fit alone are among them.
  for (int i = 100; i < 1280; i += 97) log.angles.col(i) *= 1.5;
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

    // A search finishes its fits so.
    EquilibriumSolver solver(PaperFinger(), {});
    const GaugeSurface surface(GaugeTable(&solver, 0, {}), PaperFinger());
    const LadderState start = log.StateAt(discretization, 0);
    for (int i = 0; i < 40; ++i) {
      if (i == 20) before = allocations;
      fit.set_state(start);
      contacts[0] = log.truth[0];
      angles = log.angles.col(0);
      weights = log.weights.col(0);
      ASSERT_TRUE(fit.Finish(angles, weights, surface, &contacts));
    }
    EXPECT_EQ(allocations - before, 0);

    const auto lanes = FrameGroupFit::Make(PaperFinger(), discretization);
    lanes->set_tolerance(1e-5);
    lanes->Start(log.StateAt(discretization, 0), log.truth[0]);
    std::vector<FrameFit> fits(64);
    int alone = 0;
    for (int i = 0; i < 1280; i += 64) {
      // The first frame that is fitted alone takes memory.
      if (i == 640) before = allocations;
      lanes->Fit(log.angles.middleCols(i, 64), log.weights.middleCols(i, 64),
                 fits.data());
      for (const FrameFit& one : fits) {
        EXPECT_TRUE(one.converged);
        alone += !one.in_lanes;
      }
    }
    EXPECT_EQ(allocations - before, 0);
    EXPECT_GT(alone, 0);
  }
}

#else

TEST(SensingAllocationTest, WarmFitsTakeNone) {
  GTEST_SKIP() << "malloc cannot be replaced here";
}

#endif

}  // namespace
}  // namespace finray
