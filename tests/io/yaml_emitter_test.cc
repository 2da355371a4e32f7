#include "finray/io/yaml_emitter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <locale>
#include <string>
#include <vector>

namespace finray {
namespace {

// 1234.5 is 1.234,5.
class DecimalComma : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

std::string Everything() {
  YamlEmitter yaml;
  yaml << YAML::Flow << YAML::BeginMap;
  YamlPair(&yaml, "number", 1234.5);
  YamlPair(&yaml, "count", std::size_t{2577});
  YamlPair(&yaml, "negative", -2577);
  YamlPair(&yaml, "list", std::vector<double>{1e-12, 0.1 + 0.2});
  YamlPair(&yaml, "nothing", std::nan(""));
  YamlPair(&yaml, "all", -std::numeric_limits<double>::infinity());
  YamlPair(&yaml, "true", true);
  YamlPair(&yaml, "text", "1,5");
  yaml << YAML::EndMap;
  return yaml.c_str();
}

TEST(YamlEmitterTest, NumbersAreTheSameInEveryLocale) {
  const std::string expected =
      "{number: 1234.5, count: 2577, negative: -2577, list: [1.0e-12, "
      "0.30000000000000004], nothing: .nan, all: -.inf, true: true, text: "
      "\"1,5\"}";
  EXPECT_EQ(Everything(), expected);
  const std::locale before =
      std::locale::global(std::locale(std::locale(), new DecimalComma));
  const std::string in_german = Everything();
  std::locale::global(before);
  EXPECT_EQ(in_german, expected);
}

TEST(YamlEmitterTest, ReadsBackTheSameOrRounded) {
  for (const double value : {0.1, -1.0 / 3, 1e300, 5e-324, 1e22}) {
    EXPECT_EQ(YAML::Load(YamlNumber(value)).as<double>(), value);
  }
  EXPECT_EQ(YamlNumber(0.1 + 0.2, 12), "0.3");
  EXPECT_EQ(YamlNumber(2e-15 / 3, 3), "6.67e-16");
}

}  // namespace
}  // namespace finray
