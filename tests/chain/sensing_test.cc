#include "finray/chain/sensing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "chain/chain_fixture.h"
#include "finray/chain/forward.h"
#include "finray/chain/sensing.h"

namespace finray {
namespace {

Eigen::VectorXd GaugesOf(const ChainLayout& layout,
                         const PointContact& contact) {
  ChainState state;
  EXPECT_TRUE(SolveForward(layout, contact, &state));
  return layout.gauges * state.theta;
}

PointContact Near(const PointContact& truth, double sign) {
  return {truth.arc_mm + 5 * sign, truth.normal_N * (1 - 0.2 * sign),
          truth.friction};
}

const double kArcs[] = {20.3, 35.1, 47.7, 61.4, 72.4, 86.2, 97.9, 109.6};
const double kForces[] = {0.3, 1, 3, 8};

TEST(ChainSensingTest, RoundTrip) {
  for (const int resolution : {40, 80}) {
    const ChainLayout layout =
        MakeChainLayout(PaperFinger(), resolution, GaugeRule::kOverlap);
    double worst_arc = 0, worst_force = 0;
    int runs = 0, most = 0, missed = 0;
    for (const double arc : kArcs) {
      for (const double force : kForces) {
        for (const double sign : {-1.0, 1.0}) {
          const PointContact truth = {arc, force, 0};
          const ChainSensing sensed =
              SenseContact(layout, GaugesOf(layout, truth), Near(truth, sign));
          ++runs;
          if (!sensed.converged) {
            ++missed;
            std::printf("missed %g mm, %g N, sign %g\n", arc, force, sign);
            continue;
          }
          worst_arc = std::max(worst_arc,
                               std::abs(sensed.contact.arc_mm - truth.arc_mm));
          worst_force = std::max(
              worst_force, std::abs(sensed.contact.normal_N - truth.normal_N));
          most = std::max(most, sensed.iterations);
        }
      }
    }
    std::printf(
        "n = %d: %d runs, %d not converged, worst %.1e mm, %.1e N, at most %d "
        "iterations\n",
        resolution, runs, missed, worst_arc, worst_force, most);
    EXPECT_EQ(missed, 0);
    EXPECT_LT(worst_arc, 1e-6);
    EXPECT_LT(worst_force, 1e-6);
  }
}

// Moved towards the middle of the link that holds the contact.
PointContact OnTheSameLink(const ChainLayout& layout,
                           const PointContact& truth) {
  const auto& joints = layout.front_joint_mm;
  const auto after =
      std::upper_bound(joints.begin(), joints.end(), truth.arc_mm);
  const double middle = 0.5 * (*after + *(after - 1));
  return {truth.arc_mm + (middle > truth.arc_mm ? 1.5 : -1.5),
          0.9 * truth.normal_N, truth.friction};
}

TEST(ChainSensingTest, CeresAgreesWithNewton) {
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), 40, GaugeRule::kOverlap);
  const double noise_rad[] = {2e-4, -3e-4, 1e-4, -1e-4};
  constexpr double kWeight = 1e3;
  double worst_arc[2] = {0, 0}, worst_force[2] = {0, 0};
  int most = 0;
  for (const double arc : {38.6, 61.4, 72.4, 97.9}) {
    for (const double force : {1.0, 5.0}) {
      for (const double noise : {0.0, 0.3}) {
        const PointContact truth = {arc, force, 0};
        SCOPED_TRACE(std::to_string(arc) + " mm, " + std::to_string(force) +
                     " N, noise " + std::to_string(noise));
        Eigen::VectorXd s0 = GaugesOf(layout, truth);
        s0 += noise * Eigen::Map<const Eigen::VectorXd>(noise_rad, 4);
        const PointContact start = OnTheSameLink(layout, truth);
        const ChainSensing newton = SenseContact(layout, s0, start, kWeight);
        const ChainSensing ceres =
            SenseContactWithCeres(layout, s0, start, 3e-4, kWeight);
        EXPECT_TRUE(newton.converged);
        EXPECT_TRUE(ceres.converged);
        const double arc_error =
            std::abs(newton.contact.arc_mm - ceres.contact.arc_mm);
        const double force_error =
            std::abs(newton.contact.normal_N - ceres.contact.normal_N);
        // Where a cost remains, comparing costs resolves the minimum only to
        // the root of rounding.
        EXPECT_LT(arc_error, noise > 0 ? 2e-6 : 1e-9);
        EXPECT_LT(force_error, 1e-7);
        const int k = noise > 0;
        worst_arc[k] = std::max(worst_arc[k], arc_error);
        worst_force[k] = std::max(worst_force[k], force_error);
        most = std::max(most, ceres.iterations);
        if (noise > 0) {
          EXPECT_GT(newton.misfit.norm(), 1e-6);
        }
      }
    }
  }
  for (int k = 0; k < 2; ++k) {
    std::printf("Ceres against Newton, %s gauges: %.1e mm, %.1e N\n",
                k == 0 ? "exact" : "noisy", worst_arc[k], worst_force[k]);
  }
  std::printf("at most %d iterations of Ceres\n", most);
}

// The direction x_c of the contact force turns by theta_i where l_c passes
// joint i: a step in the cost.
TEST(ChainSensingTest, CeresParksAtAJointThatNewtonPasses) {
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), 40, GaugeRule::kOverlap);
  const PointContact truth = {35.1, 5, 0}, start = {36.6, 4.5, 0};
  const Eigen::VectorXd s0 = GaugesOf(layout, truth);
  const ChainSensing newton = SenseContact(layout, s0, start);
  ASSERT_TRUE(newton.converged);
  EXPECT_NEAR(newton.contact.arc_mm, truth.arc_mm, 1e-6);
  const ChainSensing ceres = SenseContactWithCeres(layout, s0, start);
  EXPECT_FALSE(ceres.converged);
  double to_joint = 1e9;
  for (const double joint : layout.front_joint_mm) {
    to_joint = std::min(to_joint, std::abs(ceres.contact.arc_mm - joint));
  }
  EXPECT_LT(to_joint, 1e-4);
  EXPECT_GT(ceres.misfit.norm(), 1e-5);
}

// With friction, prestress, elastic ribs and unequal beams.
TEST(ChainSensingTest, RoundTripOfARichFinger) {
  const ChainLayout layout =
      MakeChainLayout(RichFinger(), 60, GaugeRule::kOverlap);
  for (const double friction : {-0.3, 0.3}) {
    const PointContact truth = {72.4, 4, friction};
    const ChainSensing sensed =
        SenseContact(layout, GaugesOf(layout, truth), Near(truth, 1));
    ASSERT_TRUE(sensed.converged);
    EXPECT_NEAR(sensed.contact.arc_mm, truth.arc_mm, 1e-6);
    EXPECT_NEAR(sensed.contact.normal_N, truth.normal_N, 1e-6);
  }
}

// Noise stays in the gauges, however heavy the model beyond the default.
TEST(ChainSensingTest, DefaultWeightHoldsTheModel) {
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), 40, GaugeRule::kOverlap);
  Eigen::VectorXd s0 = GaugesOf(layout, {72.4, 1, 0});
  s0 += Eigen::Vector4d(2e-4, -3e-4, 1e-4, -1e-4);
  const ChainSensing sensed = SenseContact(layout, s0, {70, 1, 0});
  const ChainSensing held = SenseContact(layout, s0, {70, 1, 0}, 1e8);
  ASSERT_TRUE(sensed.converged);
  ASSERT_TRUE(held.converged);
  EXPECT_NEAR(sensed.contact.arc_mm, held.contact.arc_mm, 1e-6);
  // And it is the equilibrium under the contact that it names.
  EXPECT_LT((GaugesOf(layout, held.contact) - s0 - held.misfit).norm(), 1e-9);
}

TEST(ChainSensingTest, SaysWhenItFails) {
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), 40, GaugeRule::kOverlap);
  const Eigen::VectorXd s0 = GaugesOf(layout, {72.4, 2, 0});
  Eigen::VectorXd broken = s0;
  broken[1] = std::nan("");
  for (const auto& sensed : {SenseContact(layout, broken, {70, 2, 0}),
                             SenseContactWithCeres(layout, broken, {70, 2, 0}),
                             SenseContact(layout, s0, {200, 2, 0}),
                             SenseContact(layout, 1e6 * s0, {70, 2, 0})}) {
    EXPECT_FALSE(sensed.converged);
    EXPECT_TRUE(sensed.state.AllFinite());
  }
}

TEST(ChainSensingTest, NoContactIsNoSolution) {
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), 40, GaugeRule::kOverlap);
  const ChainSensing found =
      SenseContact(layout, Eigen::VectorXd::Zero(4), {70, 0, 0});
  EXPECT_FALSE(found.converged);
}

}  // namespace
}  // namespace finray
