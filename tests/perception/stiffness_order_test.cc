#include <gtest/gtest.h>

#include <cmath>

#include "finray/perception/compliance.h"

namespace finray {
namespace {

TEST(StiffnessOrderTest, MeanOfTrials) {
  const Stiffness equal = MeanStiffness({{1.0, 0.1}, {1.1, 0.1}});
  EXPECT_NEAR(equal.N_per_mm, 1.05, 1e-12);
  EXPECT_NEAR(equal.std, 0.1 / std::sqrt(2.0), 1e-12);
  // Two trials that differ by 2 have chi2 = 200, which scales the std.
  const Stiffness apart = MeanStiffness({{0.0, 0.1}, {2.0, 0.1}});
  EXPECT_NEAR(apart.std, 0.1 / std::sqrt(2.0) * std::sqrt(200.0), 1e-9);
}

TEST(StiffnessOrderTest, ConfidenceOfNeighbours) {
  std::vector<ObjectStiffness> objects(3);
  objects[0].name = "soft";
  objects[0].mean = {1, 0.3};
  objects[1].name = "stiff";
  objects[1].mean = {5, 0.1};
  objects[2].name = "middle";
  objects[2].mean = {1.5, 0.4};
  const std::vector<double> confidence = SortByStiffness(&objects);
  EXPECT_EQ(objects[0].name, "stiff");
  EXPECT_EQ(objects[1].name, "middle");
  ASSERT_EQ(confidence.size(), 2u);
  EXPECT_NEAR(confidence[0], 1, 1e-12);
  EXPECT_NEAR(confidence[1], 0.841345, 1e-6);  // one std apart
  EXPECT_NEAR(OrderConfidence(objects), 0.8413, 0.01);
}

}  // namespace
}  // namespace finray
