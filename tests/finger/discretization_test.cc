#include "finray/finger/discretization.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/io/error.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(DiscretizationTest, NamesRoundTrip) {
  for (const std::string& name : SchemeNames()) {
    EXPECT_EQ(SchemeName(ParseDiscretization(name, 10).scheme), name);
  }
}

TEST(DiscretizationTest, ErrorsNameTheNearestScheme) {
  EXPECT_THAT([] { ParseDiscretization("tailor", 10); },
              ThrowsMessage<InputError>(HasSubstr("did you mean 'taylor'?")));
  EXPECT_THAT([] { ParseDiscretization("taylor", -1); },
              ThrowsMessage<InputError>(HasSubstr("--resolution: -1")));
  EXPECT_THAT([] { ParseDiscretization("taylor", 2001); },
              ThrowsMessage<InputError>(HasSubstr("from 1 to 2000 (0: ")));
  EXPECT_EQ(ParseDiscretization("rigid_chain", 2000).resolution, 2000);
}

}  // namespace
}  // namespace finray
