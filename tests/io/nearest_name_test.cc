#include "finray/io/nearest_name.h"

#include <gtest/gtest.h>

namespace finray {
namespace {

TEST(NearestNameTest, FindsSlipsAndRefusesStrangers) {
  const std::vector<std::string> names = {"front_mm", "length_mm", "angle_deg"};
  EXPECT_EQ(NearestName("lenght_mm", names), "length_mm");
  EXPECT_EQ(NearestName("FRONT_MM", names), "front_mm");
  EXPECT_EQ(NearestName("colour", names), "");
  EXPECT_EQ(NearestName(std::string(1 << 20, 'x'), names), "");
  EXPECT_EQ(DidYouMean("angel_deg", names), " (did you mean 'angle_deg'?)");
}

}  // namespace
}  // namespace finray
