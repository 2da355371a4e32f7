#include <gtest/gtest.h>

#include "chain/chain_fixture.h"
#include "finray/chain/forward.h"
#include "finray/chain/sensing.h"

namespace finray {
namespace {

TEST(CeresChainTest, ForwardAgreesWithNewton) {
  const ChainLayout layout =
      MakeChainLayout(RichFinger(), 40, GaugeRule::kOverlap);
  for (const ceres::LinearSolverType type :
       {ceres::DENSE_QR, ceres::DENSE_NORMAL_CHOLESKY,
        ceres::SPARSE_NORMAL_CHOLESKY}) {
    SCOPED_TRACE(ceres::LinearSolverTypeToString(type));
    ChainState newton, state;
    ASSERT_TRUE(SolveForward(layout, {70, 2, 0.3}, &state));
    const PointContact load = {72.4, 2.5, 0.3};
    ASSERT_TRUE(SolveForward(layout, load, &newton));
    int iterations = 0;
    ASSERT_TRUE(
        ContinueForwardWithCeres(layout, load, type, &state, &iterations));
    EXPECT_GE(iterations, 2);
    EXPECT_LT((state.theta - newton.theta).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LT((state.loads - newton.loads).cwiseAbs().maxCoeff(),
              1e-7 * newton.loads.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace finray
