#include "finray/io/message_text.h"

#include <gtest/gtest.h>

namespace finray {
namespace {

TEST(NearestNameTest, FindsSlipsAndRefusesStrangers) {
  const std::vector<std::string> names = {"front_mm", "length_mm", "angle_deg"};
  EXPECT_EQ(DidYouMean("lenght_mm", names), " (did you mean 'length_mm'?)");
  EXPECT_EQ(DidYouMean("FRONT_MM", names), " (did you mean 'front_mm'?)");
  EXPECT_EQ(DidYouMean("colour", names), "");
  EXPECT_EQ(DidYouMean(std::string(1 << 20, 'x'), names), "");
  EXPECT_EQ(DidYouMean("angel_deg", names), " (did you mean 'angle_deg'?)");
}

}  // namespace
}  // namespace finray
