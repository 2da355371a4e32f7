#include "finray/ladder/ladder_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "finray/ladder/ladder_newton.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kFriction = 0.15;
template <class T>
using Numbers = std::array<double, kFrameLanes<T>>;

// The first four lanes have `four`, the others the same once more.
template <class T>
Numbers<T> Repeated(const std::array<double, 4>& four) {
  Numbers<T> numbers;
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = four[i % 4];
  return numbers;
}
template <class T>
LaneSet Repeated(LaneSet four) {
  return kFrameLanes<T> == 8 ? four | four << 4 : four;
}

template <class T>
class LadderLanesTest : public testing::Test {
 protected:
  void SetUp() override {
    if (FindFramesKernel<T>(Scheme::kTaylor, false) == nullptr) {
      GTEST_SKIP() << "this machine has no registers for so many lanes";
    }
  }
};
using FramesOfLanes = testing::Types<FourFrames, EightFrames>;
TYPED_TEST_SUITE(LadderLanesTest, FramesOfLanes);

// Near the equilibrium of a contact, but off it.
LadderState Disturbed(const Finger& finger, const Discretization& mesh,
                      const PointContact& contact, int seed) {
  EquilibriumSolver solver(finger, mesh);
  EXPECT_TRUE(solver.Solve({contact}));
  LadderState state = solver.state();
  for (auto& nodes : state.nodes) {
    for (Eigen::Index k = 1; k < nodes.cols(); ++k) {
      nodes.col(k).tail<4>() +=
          1e-3 * std::sin(3.0 * k + seed) * Eigen::Vector4d(1, -1, 0.01, 50);
    }
  }
  return state;
}

// One linearisation and step of all frames against those of each alone:
// largest difference of the states, relative to the largest entry.
template <class T>
double WorstLane(const Finger& finger, const Discretization& mesh,
                 const std::array<double, 4>& arcs_mm,
                 const std::array<double, 4>& normals_N) {
  const Numbers<T> arc_mm = Repeated<T>(arcs_mm),
                   normal_N = Repeated<T>(normals_N);
  LadderLanes<T> lanes(finger, mesh, kFriction);
  std::vector<std::vector<double>> alone;
  const double change[2] = {0.01, 0.05};
  for (int lane = 0; lane < kFrameLanes<T>; ++lane) {
    const PointContact contact = {arc_mm[lane], normal_N[lane], kFriction};
    const LadderState state = Disturbed(finger, mesh, contact, lane);
    EXPECT_TRUE(lanes.Load(state, lane));
    LadderNewton newton(finger, mesh);
    newton.Load(state);
    EXPECT_TRUE(newton.Linearize({contact}, 1, SweepColumns::kContacts));
    newton.StepWithContacts(1, change);
    newton.Move(1, 0);
    const LadderFrame<double>& f = newton.frame();
    alone.emplace_back(f.state.q, f.state.q + lanes.frame().state_size());
  }
  EXPECT_EQ(lanes.Place(arc_mm, normal_N, kAllFrameLanes<T>, 0),
            kAllFrameLanes<T>);
  EXPECT_TRUE(lanes.Linearize());
  T newton{}, changes[2] = {};
  for (int lane = 0; lane < kFrameLanes<T>; ++lane) {
    newton[lane] = 1;
    for (int k = 0; k < 2; ++k) changes[k][lane] = change[k];
  }
  lanes.Step(newton, changes);
  double worst = 0;
  for (int lane = 0; lane < kFrameLanes<T>; ++lane) {
    double largest = 0, difference = 0;
    for (int i = 0; i < lanes.frame().state_size(); ++i) {
      const double value = lanes.frame().state.q[i][lane];
      largest = std::max(largest, std::abs(value));
      difference = std::max(difference, std::abs(value - alone[lane][i]));
    }
    worst = std::max(worst, difference / largest);
  }
  return worst;
}

TYPED_TEST(LadderLanesTest, EveryLaneIsAFrameAlone) {
  Finger elastic = PaperFinger();
  elastic.ribs[1].axial_stiffness_N = 500;
  elastic.back_stiffness_N_mm2 = 7000;
  Finger stretching = PaperFinger();
  stretching.front_axial_stiffness_N = 1e4;
  Finger ribless = PaperFinger();
  ribless.ribs.clear();
  Finger bending = PaperFinger();
  for (Rib& rib : bending.ribs) {
    rib.bending_stiffness_N_mm2 = 2000;
    rib.front_hinge_N_mm_per_rad = std::numeric_limits<double>::infinity();
    rib.back_hinge_N_mm_per_rad = 200;
  }
  Finger soft = PaperFinger();  // whose parameters are exchanged on the way
  soft.front_stiffness_N_mm2 = soft.back_stiffness_N_mm2 = 12.5;
  // In one element; in two; on a rib's hinge and at an end.
  const std::array<double, 4> near = {66, 67, 68, 69},
                              astride = {55, 63, 58, 70},
                              edge = {140, 139, 138, 140};
  const Discretization one{Scheme::kTaylor8, 12}, two{Scheme::kTaylor12, 24},
      links{Scheme::kRigidChain, 60}, many{Scheme::kTaylor, 240};
  const std::array<double, 4> force = {3, 1, 5, 0.1},
                              light = {0.01, 0.02, 0.03, 0.01};
  EXPECT_LT(WorstLane<TypeParam>(PaperFinger(), one, near, force), 1e-11);
  EXPECT_LT(WorstLane<TypeParam>(PaperFinger(), one, astride, force), 1e-11);
  EXPECT_LT(WorstLane<TypeParam>(PaperFinger(), one, edge, light), 1e-11);
  EXPECT_LT(WorstLane<TypeParam>(elastic, two, near, force), 1e-11);
  EXPECT_LT(WorstLane<TypeParam>(elastic, one, astride, force), 1e-11);
  EXPECT_LT(WorstLane<TypeParam>(stretching, one, astride, force), 1e-11);
  EXPECT_LT(WorstLane<TypeParam>(ribless, one, near, light), 1e-11);
  EXPECT_LT(WorstLane<TypeParam>(bending, one, near, force), 1e-11);
  EXPECT_LT(WorstLane<TypeParam>(bending, two, astride, force), 1e-11);
  EXPECT_LT(WorstLane<TypeParam>(PaperFinger(), links, {66.1, 66.2, 66.3, 66.4},
                                 force),
            1e-11);
  EXPECT_LT(WorstLane<TypeParam>(soft, many, {69.9, 70, 70.1, 70.2}, light),
            1e-8);
}

TYPED_TEST(LadderLanesTest, ContactsInTwoElementsGoTogether) {
  LadderLanes<TypeParam> lanes(PaperFinger(), {Scheme::kTaylor8, 12}, 0);
  const std::vector<double>& nodes = lanes.model().mesh(Side::kFront).nodes_mm;
  const auto force = Repeated<TypeParam>({1, 1, 1, 1});
  const auto middle = [&](int e) { return (nodes[e] + nodes[e + 1]) / 2; };
  const auto arc =
      Repeated<TypeParam>({middle(3), middle(1), middle(3), middle(2)});
  // The last of four is in a third element.
  EXPECT_EQ(lanes.Place(arc, force, kAllFrameLanes<TypeParam>, 0),
            Repeated<TypeParam>(0b0111u));
  EXPECT_EQ(lanes.frame().contacts[0].element, 1);
  EXPECT_EQ(lanes.contact_of(1), 0);
  EXPECT_EQ(lanes.contact_of(2), 1);
  // Unless it comes first.
  EXPECT_EQ(lanes.Place(arc, force, kAllFrameLanes<TypeParam>,
                        Repeated<TypeParam>(0b1100u)),
            Repeated<TypeParam>(0b1101u));
  EXPECT_EQ(lanes.Place(arc, force, Repeated<TypeParam>(0b1000u), 0),
            Repeated<TypeParam>(0b1000u));
  EXPECT_EQ(lanes.frame().contact_count, 1);
}

// Lanes take a gauge's end from one and the same piece of an element.
TYPED_TEST(LadderLanesTest, ContactsOnBothSidesOfAGaugesEndDoNot) {
  Finger finger = PaperFinger();
  finger.gauges[0].beam = Side::kFront;
  finger.gauges[0].start_mm = 60;
  LadderLanes<TypeParam> lanes(finger, {Scheme::kTaylor8, 12}, 0);
  const auto force = Repeated<TypeParam>({1, 1, 1, 1});
  EXPECT_EQ(lanes.Place(Repeated<TypeParam>({59, 59.5, 60.5, 58}), force,
                        kAllFrameLanes<TypeParam>, 0),
            Repeated<TypeParam>(0b1011u));
  EXPECT_EQ(lanes.Place(Repeated<TypeParam>({61, 62, 60.5, 60.2}), force,
                        kAllFrameLanes<TypeParam>, 0),
            kAllFrameLanes<TypeParam>);
}

TYPED_TEST(LadderLanesTest, AStateOfAnotherMeshIsRefused) {
  LadderLanes<TypeParam> lanes(PaperFinger(), {Scheme::kTaylor8, 12}, 0);
  EquilibriumSolver other(PaperFinger(), {Scheme::kTaylor8, 24});
  ASSERT_TRUE(other.Solve({}));
  EXPECT_FALSE(lanes.Load(other.state(), 0));
}

TYPED_TEST(LadderLanesTest, ALaneThatIsNotFiniteIsReported) {
  LadderLanes<TypeParam> lanes(PaperFinger(), {Scheme::kTaylor8, 12}, 0);
  const auto normal_N = Repeated<TypeParam>({1, 1, 1, 1});
  lanes.Place(Repeated<TypeParam>({60, 60, 60, 60}), normal_N,
              kAllFrameLanes<TypeParam>, 0);
  EXPECT_TRUE(lanes.Linearize());
  for (int lane = 0; lane < kFrameLanes<TypeParam>; ++lane) {
    double& force = LaneOf(lanes.frame().state.q[4], lane);
    const double was = force;
    force = std::nan("");
    EXPECT_FALSE(lanes.Linearize()) << lane;
    force = was;
  }
}

}  // namespace
}  // namespace finray
