#include "finray/sensing/fast/rival_map.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>
#include <utility>

#include "finray/sensing/contact_search.h"
#include "finray/sensing/fast/contact_fit.h"
#include "test_finger.h"

namespace finray {
namespace {

// Wherever the map says so, an exhaustive search finds no rival.
TEST(RivalMapTest, WhatItCallsUniqueHasNoRival) {
  for (const auto& [noise, friction] :
       {std::pair{1e-4, 0.}, {3e-4, 0.}, {3e-3, 0.}, {1e-4, 0.3}}) {
    Scene scene;
    scene.friction_coefficient = friction;
    Finger finger = PaperFinger();
    for (Gauge& gauge : finger.gauges) gauge.noise_V = noise;
    EquilibriumSolver solver(finger, {});
    const GaugeTable table(&solver, friction, std::nullopt);
    PackedReadings measurement;
    measurement.weights = Eigen::VectorXd::Constant(4, 1 / noise);
    measurement.gauges = measurement.all = 4;
    const GaugeSurface surface(solver, friction, std::nullopt,
                               table.heaviest_N());
    const RivalMap map(table, surface, measurement.weights, table.heaviest_N());
    ContactSearch search(finger, scene, {});
    std::mt19937_64 generator(11);
    std::uniform_real_distribution<double> place(10, 135), force(0, 2);
    std::normal_distribution<double> normal(0, noise);
    int unique = 0, usual_unique = 0, usual_frames = 0;
    constexpr int kFrames = 400;
    for (int i = 0; i < kFrames; ++i) {
      const PointContact truth{place(generator),
                               0.1 * std::pow(10, force(generator)), friction};
      ASSERT_TRUE(solver.Solve({truth}));
      const bool usual = truth.arc_mm > 25 && truth.arc_mm < 108 &&
                         truth.normal_N > 1 && truth.normal_N < 8;
      usual_frames += usual;
      measurement.values = solver.outputs().head(4);
      for (double& angle : measurement.values) angle += normal(generator);
      Measurements row;
      for (int j = 0; j < 4; ++j) {
        row.gauges_V.push_back(finger.gauges[j].Volts(measurement.values[j]));
      }
      if (!search.Search(1, row, measurement)) continue;
      const ContactSolution& best = search.best();
      const double std = std::sqrt(CovarianceOf(best.information)(0, 0));
      if (!map.IsUnique(best.contacts[0].arc_mm, std, best.contacts[0].normal_N,
                        best.chi2, ContactSearch::kWithinNoise)) {
        continue;
      }
      ++unique;
      usual_unique += usual;
      EXPECT_EQ(search.rival(), nullptr);
      // No fit from any row of the table finds another minimum that is as good.
      ContactFit fit(finger, {});
      for (const GaugeTable::Row& row : table.rows()) {
        std::vector<PointContact> contacts = {
            {row.arc_mm, best.contacts[0].normal_N, friction}};
        fit.set_state(row.nodes[5].state);
        if (!fit.Fit(measurement.values, measurement.weights, &contacts)) {
          continue;
        }
        // In a flat valley a fit may stop short of its lowest point.
        const bool same =
            std::abs(contacts[0].arc_mm - best.contacts[0].arc_mm) < 2 * std;
        EXPECT_TRUE(same ||
                    fit.chi2() > best.chi2 + ContactSearch::kWithinNoise)
            << noise << ": " << contacts[0].arc_mm << " and "
            << best.contacts[0].arc_mm;
      }
    }
    std::printf(
        "noise %g rad, friction %g: %d of %d frames unique, %d of %d usual "
        "ones\n",
        noise, friction, unique, kFrames, usual_unique, usual_frames);
    if (noise < 2e-4) {
      EXPECT_GT(usual_unique, 0.8 * usual_frames);
    }
  }
}

}  // namespace
}  // namespace finray
