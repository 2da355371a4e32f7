// Warm fits and live frames take no memory.

#include <gtest/gtest.h>

#include <utility>

#include "count_allocations.h"
#include "estimation/gauge_log.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/gauge_table.h"
#include "finray/estimation/row_fit.h"

namespace finray {
namespace {

#ifdef FINRAY_COUNTS_ALLOCATIONS

TEST(EstimationAllocationTest, WarmFitsTakeNone) {
  GaugeLog log(600);
  // Some frames jump.
  for (std::size_t i = 100; i < log.rows.size(); i += 97) {
    for (double& volts : log.rows[i].gauges_V) volts *= 1.5;
  }
  const double most_N = GaugeTable::HeaviestForce_N(log.finger);
  for (const Scheme scheme : {Scheme::kTaylor8, Scheme::kTaylor}) {
    const Discretization discretization{scheme, 12};
    const ModelSurface surface =
        RowFit::SurfaceFor(log.finger, Scene(), discretization, most_N);
    RowFit fit(log.finger, Scene(), discretization, &surface, most_N);
    const LadderState first = log.StateAt(discretization, 0);
    LadderState near;
    ContactStart start;
    start.count = 1;
    start.state = &near;
    ContactSolution found;
    for (const RowFit::Model model :
         {RowFit::Model::kSurface, RowFit::Model::kEquilibria}) {
      long before = 0;
      // The first round takes what is needed, the cells of the surface too.
      for (int round = 0; round < 2; ++round) {
        before = allocations;
        start.contacts[0] = log.truth[0];
        near = first;
        for (const Measurements& row : log.rows) {
          fit.set_row(row);
          ASSERT_TRUE(fit.Fit(start, model, RowFit::kMostEvaluations, &found));
          start.contacts[0] = found.contacts[0];
          if (model == RowFit::Model::kEquilibria) {
            std::swap(near, found.state);
          }
        }
      }
      EXPECT_EQ(allocations - before, 0)
          << (model == RowFit::Model::kSurface ? "surface" : "equilibria");
    }
  }
}

// Neither the right finger nor one whose gauges are off by 3 std. Readings that
// are as good as without noise solve equilibria, whose mesh may be refined.
TEST(EstimationAllocationTest, LiveFramesTakeNone) {
  for (const double off_std : {0.0, 3.0}) {
    GaugeLog log(600);
    for (Measurements& row : log.rows) {
      row.gauges_V[0] += off_std * GaugeLog::kNoise_rad;
      row.gauges_V[2] -= off_std * GaugeLog::kNoise_rad;
    }
    FrameEstimator estimator(log.finger, Scene());
    estimator.Prepare();
    long taken = 0;
    int counted = 0;
    for (int round = 0; round < 2; ++round) {
      taken = counted = 0;
      for (const Measurements& row : log.rows) {
        const long before = allocations;
        const FrameEstimate& estimate = estimator.Next(row);
        if (estimate.chi2 < ContactSearch::kNoiseless) continue;
        taken += allocations - before;
        ++counted;
      }
    }
    EXPECT_EQ(taken, 0) << off_std;
    EXPECT_GT(counted, 590);
  }
}

#else

TEST(EstimationAllocationTest, WarmFitsTakeNone) {
  GTEST_SKIP() << "malloc cannot be replaced here";
}

#endif

}  // namespace
}  // namespace finray
