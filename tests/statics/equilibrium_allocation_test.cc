// A warm solve takes no memory: malloc of this executable counts.

#include <gtest/gtest.h>

#include <cmath>

#include "count_allocations.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

#ifdef FINRAY_COUNTS_ALLOCATIONS

void Move(int i, std::vector<PointContact>* contacts) {
  for (std::size_t c = 0; c < contacts->size(); ++c) {
    PointContact& contact = (*contacts)[c];
    contact.arc_mm = 70 - 35.0 * c + 30 * std::sin(0.02 * i + c);
    contact.normal_N = 3 + 2 * std::cos(0.03 * i + c);
    contact.friction = 0.1;
  }
}

long AllocationsOfWarmSolves(const Finger& finger, Scheme scheme, int contacts,
                             bool sensitivities) {
  EquilibriumSolver solver(finger, {scheme, 0});
  std::vector<PointContact> load(contacts);
  long before = 0;
  for (int i = 0; i < 200; ++i) {
    // The first solves take what is needed.
    if (i == 3) before = allocations;
    Move(i, &load);
    const bool solved = sensitivities ? solver.SolveWithSensitivities(load)
                                      : solver.Solve(load);
    if (!solved) return -1;
  }
  return allocations - before;
}

TEST(AllocationTest, TheCounterCounts) {
  const long before = allocations;
  const std::vector<double> some(100);
  const Eigen::VectorXd more = Eigen::VectorXd::Zero(100);
  EXPECT_GE(allocations - before, 2);
  EXPECT_EQ(more.size() + static_cast<Eigen::Index>(some.size()), 200);
}

TEST(AllocationTest, WarmSolvesTakeNone) {
  Finger stretching = PaperFinger();
  stretching.front_axial_stiffness_N = 1e5;
  for (const Scheme scheme :
       {Scheme::kRigidChain, Scheme::kTaylor8, Scheme::kTaylor}) {
    for (const int contacts : {0, 1, 2}) {
      EXPECT_EQ(AllocationsOfWarmSolves(PaperFinger(), scheme, contacts, false),
                0);
      EXPECT_EQ(AllocationsOfWarmSolves(PaperFinger(), scheme, contacts, true),
                0);
    }
  }
  EXPECT_EQ(AllocationsOfWarmSolves(stretching, Scheme::kTaylor, 1, true), 0);
}

#else

TEST(AllocationTest, WarmSolvesTakeNone) {
  GTEST_SKIP() << "malloc cannot be replaced here";
}

#endif

}  // namespace
}  // namespace finray
