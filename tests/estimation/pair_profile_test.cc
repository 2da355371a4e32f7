#include "finray/estimation/pair_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/frame_table.h"
#include "finray/scene/clean_readings.h"
#include "shared_case.h"

namespace finray {
namespace {

// Eight gauges, and a second contact past the last rib: the places of a pair
// lie in a curved valley of chi2, of which the curvature at its bottom says
// little.
TEST(PairProfileTest, PairsPastTheLastRibAreWithinTheirStd) {
  const std::string folder = SharedCase("two_contacts/");
  if (folder.empty()) GTEST_SKIP() << "the inputs are not here";
  const Finger finger = ReadFinger(folder + "f.yaml");
  const FrameTable log = FrameTable::Read(folder + "log.csv");
  std::ifstream truth(folder + "truth.csv");
  std::string line;
  std::getline(truth, line);  // # l1,f1,l2,f2
  FrameEstimator estimator(finger, Scene());
  int ok = 0;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    ASSERT_TRUE(std::getline(truth, line));
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    Measurements readings;
    for (std::size_t j = 1; j <= finger.gauges.size(); ++j) {
      readings.gauges_V.push_back(
          log.Numbers("gauge_" + std::to_string(j) + "_V")[row]);
    }
    const FrameEstimate estimate = estimator.Estimate(readings);
    if (estimate.status != FrameStatus::kOk) continue;
    ++ok;
    EXPECT_EQ(estimate.contacts, 2) << row;
    for (const ContactEstimate& contact : estimate.contact) {
      double arc_mm, normal_N;
      ASSERT_TRUE(numbers >> arc_mm >> normal_N);
      EXPECT_LT(std::abs(contact.arc_mm - arc_mm), 5 * contact.arc_std_mm)
          << row;
      EXPECT_LT(std::abs(contact.normal_N - normal_N), 5 * contact.normal_std_N)
          << row;
    }
  }
  EXPECT_EQ(log.rows(), 16u);
  EXPECT_GE(ok, 4);
}

// chi2 by the statics alone.
double Chi2Of(const std::array<PointContact, kFittedContacts>& contacts,
              const Finger& finger, const Scene& scene,
              const Measurements& row) {
  EquilibriumSolver solver(finger, {});
  EXPECT_TRUE(solver.Solve({contacts[0], contacts[1]}));
  double chi2 = (row.tip_mm - solver.tip_pose().head<2>()).squaredNorm() /
                (*scene.tip_std_mm * *scene.tip_std_mm);
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    const double angle = solver.outputs()[static_cast<Eigen::Index>(j)];
    chi2 += std::pow((row.gauges_V[j] - gauge.Volts(angle)) / gauge.noise_V, 2);
  }
  return chi2;
}

// The tip counts, and the other three unknowns are where chi2 is least.
TEST(PairProfileTest, PlacesAreMinimaOverTheOthers) {
  const Finger finger = ReadFinger(
      FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm_eight_gauges.yaml");
  Scene scene;
  scene.contacts = 2;
  scene.tip_std_mm = 0.2;
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({{60, 3, 0}, {122, 2, 0}}));
  Measurements row = CleanReadings(solver);
  row.tip_mm = solver.tip_pose().head<2>() + Eigen::Vector2d(0.1, 0.2);
  RowFit fit(finger, scene, {}, nullptr, 25);
  fit.set_row(row);
  ContactSolution solution;
  ASSERT_TRUE(fit.FitFrom({{60, 3, 0}, {122, 2, 0}}, &solver, &solution));
  PairProfile profile;
  std::vector<ContactStart> places;
  profile.Profile(solution, 1000, &fit, &places);
  ASSERT_GE(places.size(), 6u);
  for (const ContactStart& place : places) {
    const double chi2 = Chi2Of(place.contacts, finger, scene, row);
    if (chi2 > 200) continue;  // the last place on the way out
    EXPECT_NEAR(chi2, place.chi2, 0.05 + 0.01 * chi2);
    // The second contact is held: it is past the last rib.
    for (const double part : {-1e-3, 1e-3}) {
      for (int k = 0; k < 3; ++k) {
        auto beside = place.contacts;
        (k == 0 ? beside[0].arc_mm : beside[k - 1].normal_N) *= 1 + part;
        EXPECT_GT(Chi2Of(beside, finger, scene, row), chi2 - 0.05) << k;
      }
    }
  }
}

}  // namespace
}  // namespace finray
