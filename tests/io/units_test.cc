#include "finray/io/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

TEST(UnitsTest, KnowsTorques) {
  for (const char* name : {"Nm", "N m", "N.m", "N*m", "N-m", "N\xC2\xB7m"}) {
    const auto unit = FindUnit(name);
    ASSERT_TRUE(unit) << name;
    EXPECT_EQ(unit->name, "Nm");
    EXPECT_EQ(unit->dimension, Dimension::kTorque);
    EXPECT_EQ(unit->multiply, 1e3);
  }
  EXPECT_EQ(FindUnit("Nmm")->multiply, 1);
  EXPECT_EQ(FindUnit("mNm")->divide, 1);
  EXPECT_FALSE(FindUnit("N."));
  EXPECT_FALSE(FindUnit("m V"));
}

TEST(UnitsTest, FactorsAreThoseOfTheirDefinitions) {
  EXPECT_EQ(FindUnit("lbf")->multiply, 0.45359237 * 9.80665);
  EXPECT_EQ(FindUnit("degF")->shift, -32 * 5 / 9.);
  EXPECT_EQ(FindUnit("deg")->multiply, M_PI);
  EXPECT_EQ(FindUnitInFile("kg")->name, "kgf");
  EXPECT_FALSE(FindUnit("kg"));
  EXPECT_EQ(UnitOfColumn("temperature_C").name, "degC");
}

}  // namespace
}  // namespace finray
