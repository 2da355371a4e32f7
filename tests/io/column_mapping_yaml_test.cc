#include "finray/io/column_mapping_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temp_file.h"

namespace finray {
namespace {

ColumnMapping Read(const std::string& text) {
  const TempFolder folder;
  return ReadColumnMapping(YamlMap::FromFile(folder.Write("m.yaml", text)));
}

TEST(ColumnMappingYamlTest, ReadsBackAsTheSame) {
  const std::string text = ColumnMappingToYaml(Read(
      R"(columns:
  "Fz [gf], \"raw\"": {to: force_N, unit: gf}
  gauge_1_V: U1
  ch2: {to: gauge_2_V, scale: 8.06e-4, offset: -0.1}
  ch3: {to: gauge_3_V, unit: {adc_bits: 12, range_V: [-2.5, 2.5], signed: true}}
  t: {to: time_s, unit: epoch_ms}
  123: {to: object_x_mm, unit: m, scale: -1}
delimiter: tab
decimal: ","
header_line: 4
units_row: false
not_measured: [-9999, OVLD, "#"]
)"));
  const ColumnMapping back = Read(text);
  EXPECT_EQ(ColumnMappingToYaml(back), text);
  ASSERT_EQ(back.rules.size(), 6u);
  EXPECT_EQ(back.rules[0].from, "Fz [gf], \"raw\"");
  EXPECT_EQ(back.rules[0].unit->name, "gf");
  EXPECT_EQ(back.rules[1].from, "U1");
  EXPECT_EQ(back.rules[2].scale, 8.06e-4);
  EXPECT_EQ(back.rules[2].offset, -0.1);
  EXPECT_TRUE(back.rules[3].counts->is_signed);
  EXPECT_EQ(back.rules[3].counts->from_V, -2.5);
  EXPECT_EQ(back.rules[4].format, TimeFormat::kEpoch);
  EXPECT_EQ(back.rules[4].unit->name, "ms");
  EXPECT_EQ(back.rules[5].from, "123");
  EXPECT_EQ(back.delimiter, '\t');
  EXPECT_EQ(back.decimal, ',');
  EXPECT_EQ(back.header_line, 4);
  EXPECT_EQ(back.units_row, false);
  EXPECT_EQ(back.not_measured.size(), 3u);
}

TEST(ColumnMappingYamlTest, NothingIsNothing) {
  EXPECT_EQ(ColumnMappingToYaml({}), "");
}

}  // namespace
}  // namespace finray
