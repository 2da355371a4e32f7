#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "finray/statics/equilibrium.h"
#include "statics/special_cases.h"
#include "statics/variational_finger.h"

namespace finray {
namespace {

using Eigen::Vector3d;

// The same equilibria from virtual work with curvature series and multipliers.
TEST(VariationalTest, VirtualWorkFindsTheSameEquilibria) {
  std::vector<Case> cases = SpecialCases();
  for (const double arc : {10.0, 50.0, 100.0, 130.0}) {
    for (const double force : {1.0, 8.0}) {
      cases.push_back(
          {"l_c " + std::to_string(arc), PaperFinger(), {{arc, force, 0}}});
    }
  }
  Finger springs = SpecialCases()[0].finger;
  for (std::size_t i = 0; i < springs.ribs.size(); ++i) {
    springs.ribs[i].front_hinge_N_mm_per_rad = 20.0 + 30.0 * i;
    springs.ribs[i].back_hinge_N_mm_per_rad = 150.0 - 30.0 * i;
  }
  springs.ribs[2].length_mm += 0.2;
  cases.push_back({"springs at hinges", springs, {{52.3, 5, 0.2}}});
  cases.push_back({"springs, tip", springs, {{125, 3, 0}}});
  double worst_mm = 0, worst_rad = 0, worst_N = 0;
  for (const Case& at : cases) {
    SCOPED_TRACE(at.name);
    VariationalFinger reference(at.finger, at.contacts);
    ASSERT_TRUE(reference.Solve());
    EquilibriumSolver solver(at.finger, {});
    ASSERT_TRUE(solver.Solve(at.contacts));
    Vector3d difference = (solver.tip_pose() - reference.tip()).cwiseAbs();
    for (std::size_t i = 0; i < at.contacts.size(); ++i) {
      const int contact = static_cast<int>(i);
      difference = difference.cwiseMax(
          (solver.contact_pose(contact) - reference.contact(contact))
              .cwiseAbs());
    }
    double angle = difference.z();
    for (int j = 0; j < solver.model().gauges(); ++j) {
      angle =
          std::max(angle, std::abs(solver.gauge_angle(j) - reference.gauge(j)));
    }
    double tension = 0;
    for (int i = 0; i < solver.model().ribs(); ++i) {
      tension = std::max(
          tension, std::abs(solver.rib_tension(i) - reference.tension(i)));
    }
    EXPECT_LT(difference.head<2>().maxCoeff(), 1e-8);
    EXPECT_LT(angle, 1e-10);
    EXPECT_LT(tension, 1e-7);
    worst_mm = std::max(worst_mm, difference.head<2>().maxCoeff());
    worst_rad = std::max(worst_rad, angle);
    worst_N = std::max(worst_N, tension);
  }
  std::printf("against virtual work: %.1e mm, %.1e rad, %.1e N\n", worst_mm,
              worst_rad, worst_N);
}

}  // namespace
}  // namespace finray
