#include "finray/io/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace finray {
namespace {

// What a locale would change is in tests/apps/hostile_input_test.py.

TEST(NumberTextTest, ReadsBackTheSame) {
  for (const double value :
       {0.1, -1.0 / 3, 1e300, 5e-324, 123456789.123456789, 0.0}) {
    EXPECT_EQ(std::strtod(NumberText(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(NumberText(0.1), "0.1");
  EXPECT_EQ(NumberText(std::nan("")), "nan");
  EXPECT_EQ(NumberText(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(FormatTextTest, WhateverItsLength) {
  EXPECT_EQ(FormatText("%d of %s: %+.2f %%", 3, "four", 1.5),
            "3 of four: +1.50 %");
  EXPECT_EQ(FormatText("%s", ""), "");
  const std::string text(10000, 'x');
  EXPECT_EQ(FormatText("%s.", text.c_str()), text + ".");
}

TEST(FormatTextTest, LeavesTheLocaleAsItWas) {
  const locale_t own = newlocale(LC_ALL_MASK, "C.UTF-8", nullptr);
  const locale_t before = uselocale(own);
  FormatText("%g", 1.5);
  EXPECT_EQ(uselocale(before), own);
  freelocale(own);
}

}  // namespace
}  // namespace finray
