// Solves that follow the tangent of the one before, and derivatives by the
// contacts alone, against cold solves with all derivatives.

#include <gtest/gtest.h>

#include <vector>

#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

using ContactLoads = std::vector<PointContact>;

// Both solvers under the same load. `warm` has come from somewhere else.
void ExpectSame(const ContactLoads& contacts, EquilibriumSolver* warm) {
  EquilibriumSolver cold(warm->model().finger(), {});
  ASSERT_TRUE(cold.SolveWithSensitivities(contacts));
  ASSERT_TRUE(warm->SolveByContacts(contacts));
  const auto columns = static_cast<Eigen::Index>(2 * contacts.size());
  ASSERT_EQ(warm->d_outputs().cols(), columns);
  EXPECT_LT((warm->outputs() - cold.outputs()).cwiseAbs().maxCoeff(), 1e-9);
  const Eigen::MatrixXd expected = cold.d_outputs().leftCols(columns);
  EXPECT_LT((warm->d_outputs() - expected).norm(), 1e-7 * expected.norm());
}

TEST(SolveByContactsTest, EqualsAColdSolveWhereverItComesFrom) {
  EquilibriumSolver solver(PaperFinger(), {});
  // Short and long ways, over the nodes of the mesh, one contact and two, and
  // to a load that refines the mesh.
  const std::vector<ContactLoads> loads = {{{40, 2}, {95, 3}},
                                           {{40.1, 2.01}, {95, 2.9}},
                                           {{47, 4}, {88, 1}},
                                           {{47, 4}, {88, 1}},
                                           {{70, 3}},
                                           {{71, 3.2}},
                                           {{20, 9}},
                                           {{60, 20}, {100, 12}},
                                           {{59, 21}, {99, 12}},
                                           {{60, 0.1}, {100, 0.2}},
                                           {{72, 3, 0.3}},
                                           {{72, 3, -0.3}},
                                           {{45, 2, 0, Side::kBack}}};
  for (const ContactLoads& load : loads) ExpectSame(load, &solver);
}

TEST(SolveByContactsTest, TheTangentIsThatOfTheLastSolveOnly) {
  EquilibriumSolver solver(PaperFinger(), {});
  const ContactLoads here = {{70, 3}}, there = {{74, 4}};
  const auto disturb = [&](int how) {
    LadderShot shot;
    switch (how) {
      case 0:
        solver.Spans({{30, 1}});
        break;
      case 1:
        EXPECT_FALSE(solver.Solve({{1e4, 1}}));  // off the beam
        break;
      case 2:
        solver.Shoot(solver.state().q, {{30, 1}}, &shot);
        break;
      case 3:
        EXPECT_TRUE(solver.Solve({{30, 1}, {100, 2}}));
        break;
      case 4:
        solver.Reset();
        break;
    }
  };
  for (int how = 0; how < 5; ++how) {
    SCOPED_TRACE(how);
    ExpectSame(here, &solver);
    disturb(how);
    ExpectSame(there, &solver);
  }
  // Another finger at the next solve.
  ExpectSame(here, &solver);
  solver.model().set_stiffness(20000, 9000);
  Finger finger = PaperFinger();
  finger.front_stiffness_N_mm2 = 20000;
  finger.back_stiffness_N_mm2 = 9000;
  EquilibriumSolver other(finger, {});
  ASSERT_TRUE(other.SolveWithSensitivities(there));
  ASSERT_TRUE(solver.SolveByContacts(there));
  EXPECT_LT((solver.outputs() - other.outputs()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SolveByContactsTest, IsForTwoContactsAtMost) {
  EquilibriumSolver solver(PaperFinger(), {});
  EXPECT_FALSE(solver.SolveByContacts({{30, 1}, {60, 1}, {90, 1}}));
  EXPECT_EQ(solver.status(), SolveStatus::kBadLoad);
  EXPECT_TRUE(solver.SolveByContacts({}));
  EXPECT_EQ(solver.d_outputs().cols(), 0);
}

}  // namespace
}  // namespace finray
