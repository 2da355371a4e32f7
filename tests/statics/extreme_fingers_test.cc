// Fingers of odd shape and size, contacts in odd places, ribs that cannot be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/statics/equilibrium.h"
#include "statics/equilibrium_check.h"
#include "statics/special_cases.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Finger MakeFinger(double angle_deg, int ribs) {
  Finger finger;
  finger.front_length_mm = 140;
  finger.back_angle_rad = angle_deg * M_PI / 180;
  finger.front_stiffness_N_mm2 = finger.back_stiffness_N_mm2 = 12500;
  const double back = BeamLength(finger, Side::kBack);
  for (int i = 1; i <= ribs; ++i) {
    const double share = static_cast<double>(i) / (ribs + 1);
    Rib rib{140 * share, back * std::min(1.05 * share, (share + 1) / 2), 0};
    rib.length_mm = NominalRibLength(finger, rib);
    finger.ribs.push_back(rib);
  }
  finger.gauges = {{Side::kBack, 0.2 * back, 18},
                   {Side::kFront, 30, 18},
                   {Side::kBack, back - 18, 18}};
  finger.front_pieces = {{50, 0.8}, {90.5, 1.3}, {140, 1}};
  return finger;
}

TEST(ExtremeFingersTest, FromFlatToWideInOddPlaces) {
  int solved = 0, folded = 0;
  double worst = 0;
  for (const double angle : {90.5, 91.0, 95.0, 112.0, 150.0, 175.0}) {
    for (const int ribs : {0, 1, 5, 20}) {
      const Finger finger = MakeFinger(angle, ribs);
      // Base, tip, gauge ends, ends of stiffness pieces, a rib and its sides.
      std::vector<double> arcs = {0, 140, 30, 48, 50, 90.5, 1e-9, 140 - 1e-9};
      if (ribs > 0) {
        const double hinge = finger.ribs[ribs / 2].front_mm;
        arcs.insert(arcs.end(), {hinge, std::nextafter(hinge, 0),
                                 std::nextafter(hinge, 140)});
      }
      EquilibriumSolver solver(finger, {});
      for (const double arc : arcs) {
        for (const double force : {0.01, 0.5, 3.0}) {
          const std::vector<PointContact> contacts = {{arc, force, 0.1}};
          SCOPED_TRACE(testing::Message()
                       << angle << " deg, " << ribs << " ribs, " << force
                       << " N at " << arc << " mm");
          solver.Reset();
          if (!solver.Solve(contacts)) {
            ++folded;
            EXPECT_EQ(solver.status(), SolveStatus::kLimitPoint)
                << solver.Why();
            continue;
          }
          ++solved;
          const EquilibriumCheck check(solver, contacts);
          EXPECT_LT(check.worst(), 1e-8) << check.what();
          worst = std::max(worst, check.worst());
        }
      }
    }
  }
  std::printf("%d solved, %d with a limit point; worst violation %.1e\n",
              solved, folded, worst);
  EXPECT_GT(solved, 20 * folded);
}

// At the tip the back beam pushes as the front beam does.
TEST(ExtremeFingersTest, ContactsOfBothBeamsMeetAtTheTip) {
  const Finger finger = PaperFinger();
  const double back = BeamLength(finger, Side::kBack);
  EquilibriumSolver front_pushed(finger, {}), back_pushed(finger, {});
  ASSERT_TRUE(front_pushed.Solve({{140, 2, 0}}));
  // The normal of the back beam, turned by the angle of the tip cap.
  const double turn = finger.back_angle_rad - M_PI / 2;
  const double normal = -2 * std::cos(turn);
  const double friction = -2 * std::sin(turn) / normal;
  ASSERT_TRUE(back_pushed.Solve({{back, normal, -friction, Side::kBack}}));
  for (int j = 0; j < 4 && j < front_pushed.model().gauges(); ++j) {
    EXPECT_NEAR(front_pushed.gauge_angle(j), back_pushed.gauge_angle(j), 1e-12);
  }
  EXPECT_LT((front_pushed.tip_pose() - back_pushed.tip_pose()).norm(), 1e-9);
}

TEST(ExtremeFingersTest, UnitsDoNotMatter) {
  double worst = 0;
  for (const Case& at : SpecialCases()) {
    SCOPED_TRACE(at.name);
    EquilibriumSolver solver(at.finger, {});
    ASSERT_TRUE(solver.Solve(at.contacts));
    for (const double length : {1e-3, 1e3}) {
      for (const double force : {1e-6, 1.0, 1e6}) {
        Case other = at;
        const double stiffness = force * length * length;
        other.finger.front_length_mm *= length;
        other.finger.front_stiffness_N_mm2 *= stiffness;
        other.finger.back_stiffness_N_mm2 *= stiffness;
        for (Rib& rib : other.finger.ribs) {
          rib.front_mm *= length;
          rib.back_mm *= length;
          rib.length_mm *= length;
          rib.axial_stiffness_N *= force;
        }
        for (Gauge& gauge : other.finger.gauges) {
          gauge.start_mm *= length;
          gauge.length_mm *= length;
        }
        for (PointContact& contact : other.contacts) {
          contact.arc_mm =
              std::min(contact.arc_mm * length, other.finger.front_length_mm);
          contact.normal_N *= force;
        }
        EquilibriumSolver scaled(other.finger, {});
        ASSERT_TRUE(scaled.Solve(other.contacts));
        double error = 0;
        for (int j = 0; j < solver.model().gauges(); ++j) {
          error = std::max(
              error, std::abs(scaled.gauge_angle(j) - solver.gauge_angle(j)));
        }
        const Eigen::Vector2d tip = solver.tip_pose().head<2>();
        error = std::max(
            error, (scaled.tip_pose().head<2>() / length - tip).norm() / 140);
        const Eigen::VectorXd q = solver.state().q, p = scaled.state().q;
        const int ribs = solver.model().ribs();
        error = std::max(
            error, (p.tail(ribs) / force - q.tail(ribs)).norm() / q.norm());
        EXPECT_LT(error, 1e-10);
        worst = std::max(worst, error);
      }
    }
  }
  std::printf("units changed: results within %.1e\n", worst);
}

TEST(ExtremeFingersTest, RibsThatCannotBeAreRefused) {
  const auto expect_refused = [](const Finger& finger,
                                 const std::string& message) {
    for (const Scheme scheme : {Scheme::kTaylor, Scheme::kRigidChain}) {
      EXPECT_THAT(
          [&] {
            EquilibriumSolver(finger, {scheme, 0});
          },
          ThrowsMessage<InputError>(HasSubstr(message)));
    }
  };
  const Finger paper = PaperFinger();
  const double back = BeamLength(paper, Side::kBack);
  Finger tip = paper;
  tip.ribs.push_back({140, back, 1e-3});
  expect_refused(tip, "rib 6 does not join the beams between base and tip");
  Finger tip_in_front = paper;
  tip_in_front.ribs[4].front_mm = 140;
  expect_refused(tip_in_front, "rib 5 does not join");
  Finger base = paper;
  base.ribs[0].back_mm = 0;
  expect_refused(base, "rib 1 does not join");
  Finger nowhere = paper;
  nowhere.ribs[2].back_mm = std::nan("");
  expect_refused(nowhere, "rib 3 does not join");
  Finger crossing = paper;
  std::swap(crossing.ribs[1].back_mm, crossing.ribs[2].back_mm);
  expect_refused(crossing, "ribs 2 and 3 cross");
  Finger twice = paper;
  twice.ribs[3] = twice.ribs[2];
  expect_refused(twice, "ribs 3 and 4 cross");
  Finger none = paper;
  none.ribs[1].length_mm = 0;
  expect_refused(none, "rib 2 has no length");
  Finger slack = paper;
  slack.ribs[1].axial_stiffness_N = 0;
  expect_refused(slack, "rib 2 has no axial stiffness");
}

}  // namespace
}  // namespace finray
