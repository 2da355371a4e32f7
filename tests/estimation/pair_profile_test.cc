#include "finray/estimation/pair_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/frame_table.h"
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

}  // namespace
}  // namespace finray
