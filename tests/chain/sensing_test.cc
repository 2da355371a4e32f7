#include "finray/chain/sensing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "chain/chain_fixture.h"
#include "finray/chain/ceres_sensing.h"
#include "finray/chain/forward.h"

namespace finray {
namespace {

Eigen::VectorXd GaugesOf(const ChainLayout& layout,
                         const ChainContact& contact) {
  ChainState state;
  EXPECT_TRUE(SolveForward(layout, contact, &state));
  return layout.gauges * state.theta;
}

ChainContact Near(const ChainContact& truth, double sign) {
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
          const ChainContact truth = {arc, force, 0};
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

TEST(ChainSensingTest, CeresAgreesWithNewton) {
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), 40, GaugeRule::kOverlap);
  const double noise_rad[] = {2e-4, -3e-4, 1e-4, -1e-4};
  double worst_arc = 0, worst_force = 0;
  int most = 0;
  for (const double arc : {35.1, 61.4, 72.4, 97.9}) {
    for (const double force : {1.0, 5.0}) {
      for (const double noise : {0.0, 1.0}) {
        const ChainContact truth = {arc, force, 0};
        Eigen::VectorXd s0 = GaugesOf(layout, truth);
        s0 += noise * Eigen::Map<const Eigen::VectorXd>(noise_rad, 4);
        const ChainContact start = {arc + 1.5, 0.9 * force, 0};
        const ChainSensing newton = SenseContact(layout, s0, start);
        const ChainSensing ceres = SenseContactWithCeres(layout, s0, start);
        EXPECT_TRUE(newton.converged) << arc << " " << force << " " << noise;
        EXPECT_TRUE(ceres.converged) << arc << " " << force << " " << noise;
        worst_arc = std::max(
            worst_arc, std::abs(newton.contact.arc_mm - ceres.contact.arc_mm));
        worst_force = std::max(worst_force, std::abs(newton.contact.normal_N -
                                                     ceres.contact.normal_N));
        most = std::max(most, ceres.iterations);
        if (noise > 0) {
          EXPECT_GT(newton.misfit.norm(), 1e-5);
        }
      }
    }
  }
  std::printf("Ceres against Newton: %.1e mm, %.1e N, at most %d iterations\n",
              worst_arc, worst_force, most);
  EXPECT_LT(worst_arc, 1e-7);
  EXPECT_LT(worst_force, 1e-7);
}

}  // namespace
}  // namespace finray
