// The paper's chain against the ladder of rigid links at equal resolution (one
// set of equations in two ways of writing them), and against ceres::Solve.

#include "finray/chain/forward.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "chain/chain_fixture.h"
#include "finray/statics/equilibrium.h"
#include "statics/equilibrium_values.h"
#include "statics/special_cases.h"

namespace finray {
namespace {

// Joint angles in the order of the chain: what each segment turns.
Eigen::VectorXd LadderJointAngles(const EquilibriumSolver& solver,
                                  const std::vector<PointContact>& contacts) {
  const auto spans = solver.Spans(contacts);
  const double tip = solver.tip_pose().z();
  const Finger& finger = solver.model().finger();
  std::vector<double> angles;
  std::vector<double> turns[2];
  for (int side = 0; side < 2; ++side) {
    const double end = side == 0 ? tip : tip + finger.back_angle_rad - M_PI / 2;
    for (std::size_t i = 0; i < spans[side].size(); ++i) {
      if (spans[side][i].length_mm < 1e-9) continue;  // cut on a node
      const double after =
          i + 1 < spans[side].size() ? spans[side][i + 1].start.theta_rad : end;
      turns[side].push_back(after - spans[side][i].start.theta_rad);
    }
  }
  angles = turns[0];
  // Down the back beam, a joint turns what lies towards the base.
  for (auto turn = turns[1].rbegin(); turn != turns[1].rend(); ++turn) {
    angles.push_back(-*turn);
  }
  return Eigen::Map<Eigen::VectorXd>(angles.data(), angles.size());
}

struct Differences {
  double joint = 0, rib = 0, gauge = 0;
};

void Compare(const Finger& finger, const PointContact& contact, int resolution,
             Differences* worst) {
  const std::vector<PointContact> contacts = {contact};
  EquilibriumSolver ladder(finger, {Scheme::kRigidChain, resolution});
  ASSERT_TRUE(ladder.Solve(contacts));
  const ChainLayout layout = MakeChainLayout(
      finger, resolution, GaugeRule::kOverlap, {contact.arc_mm});
  ChainState state;
  ASSERT_TRUE(SolveForward(layout, contact, &state));
  const Eigen::VectorXd angles = LadderJointAngles(ladder, contacts);
  ASSERT_EQ(angles.size(), layout.joints());
  const double joint = (angles - state.theta).cwiseAbs().maxCoeff();
  EXPECT_LT(joint, 1e-9);
  // Beside a contact on a clamp or the tip the ribs carry nothing.
  double largest = 1e-3 * contact.normal_N, rib = 0;
  for (std::size_t k = 0; k < finger.ribs.size(); ++k) {
    const int i = static_cast<int>(k);
    largest = std::max(largest, std::abs(ladder.rib_tension(i)));
    rib = std::max(rib, std::abs(ladder.rib_tension(i) - state.rib_tension(i)));
  }
  if (largest > 0) rib /= largest;
  EXPECT_LT(rib, 1e-9);
  const Eigen::VectorXd gauges = layout.gauges * state.theta;
  double gauge = 0;
  for (int j = 0; j < gauges.size(); ++j) {
    gauge = std::max(gauge, std::abs(gauges[j] - ladder.gauge_angle(j)));
  }
  EXPECT_LT(gauge, 1e-9);
  // The reaction at {T} is the clamp's.
  const Eigen::Vector3d reaction = BaseReaction(ladder, Side::kBack);
  const double base = 140 / std::tan(68 * M_PI / 180);
  EXPECT_NEAR(state.loads[1], reaction[1], 1e-8 * (1 + contact.normal_N));
  EXPECT_NEAR(state.loads[2], reaction[2], 1e-8 * (1 + contact.normal_N));
  EXPECT_NEAR(state.loads[0], reaction[0] + base * reaction[2],
              1e-6 * (1 + contact.normal_N));
  worst->joint = std::max(worst->joint, joint);
  worst->rib = std::max(worst->rib, rib);
  worst->gauge = std::max(worst->gauge, gauge);
}

void Print(const char* what, const Differences& worst) {
  std::printf(
      "%s: joint angles %.1e rad, ribs %.1e of the largest, gauges %.1e rad\n",
      what, worst.joint, worst.rib, worst.gauge);
}

TEST(FormulationsTest, PaperFingerOverTheGrid) {
  for (const int resolution : {60, 200}) {
    Differences worst;
    for (const double arc : {8.0, 30.0, 61.0, 72.4, 100.0, 125.0}) {
      for (const double force : {0.05, 1.0, 5.0, 20.0}) {
        SCOPED_TRACE("l_c " + std::to_string(arc) + ", f_c " +
                     std::to_string(force));
        Compare(PaperFinger(), {arc, force, 0}, resolution, &worst);
      }
    }
    Print(resolution == 60 ? "n = 60" : "n = 200", worst);
  }
}

TEST(FormulationsTest, SpecialCases) {
  Differences worst;
  for (const Case& at : SpecialCases()) {
    if (at.contacts.size() > 1) continue;  // the paper has one
    SCOPED_TRACE(at.name);
    Compare(at.finger, at.contacts.empty() ? PointContact() : at.contacts[0],
            60, &worst);
  }
  for (const double arc : {12.5, 61.0, 66.7, 128.0}) {
    for (const double friction : {-0.4, 0.4}) {
      SCOPED_TRACE("rich finger, l_c " + std::to_string(arc));
      Compare(RichFinger(), {arc, 6, friction}, 60, &worst);
      Compare(PrestressedPaperFinger(), {arc, 6, friction}, 60, &worst);
    }
  }
  Print("special cases", worst);
}

TEST(FormulationsTest, StiffnessPieces) {
  Finger finger = RichFinger();
  finger.front_pieces = {{25, 1.8}, {50, 0.6}, {90, 1.0}, {140, 2.2}};
  finger.back_pieces = {{40, 0.7}, {100, 1.6}, {151, 1.1}};
  Differences worst;
  Compare(finger, {72.4, 5, 0.2}, 90, &worst);
  Print("pieces", worst);
  // It is not the finger without pieces.
  EquilibriumSolver pieces(finger, {Scheme::kRigidChain, 90});
  EquilibriumSolver uniform(RichFinger(), {Scheme::kRigidChain, 90});
  ASSERT_TRUE(pieces.Solve({{72.4, 5, 0.2}}));
  ASSERT_TRUE(uniform.Solve({{72.4, 5, 0.2}}));
  EXPECT_GT(std::abs(pieces.rib_tension(2) - uniform.rib_tension(2)), 0.05);
}

TEST(FormulationsTest, RefusesWhatItCannotSolve) {
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), 40, GaugeRule::kOverlap);
  ChainState state;
  for (const PointContact& contact :
       std::vector<PointContact>{{-1, 2, 0},
                                 {140.1, 2, 0},
                                 {std::nan(""), 2, 0},
                                 {70, std::nan(""), 0},
                                 {70, INFINITY, 0},
                                 {70, 1e300, 0},
                                 {70, 1e9, 0},
                                 {70, 2, std::nan("")},
                                 {70, 2, 0, Side::kBack}}) {
    EXPECT_FALSE(SolveForward(layout, contact, &state));
    EXPECT_EQ(state.theta, ChainState::Straight(layout).theta);
    EXPECT_EQ(state.loads, ChainState::Straight(layout).loads);
  }
  EXPECT_TRUE(SolveForward(layout, {70, 2, 0}, &state));
}

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
