#include "finray/io/utf8.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "finray/io/message_text.h"
#include "finray/io/yaml_emitter.h"

namespace finray {
namespace {

TEST(Utf8Test, NamesOfAnyBytesAreTextAndComeBack) {
  for (const std::string name :
       {"a.csv", "100 %41.csv", "caf\xc3\xa9.csv", "a\nb.csv"}) {
    EXPECT_EQ(AsUtf8(name), name);
  }
  EXPECT_EQ(AsUtf8("caf\xe9 100%.csv"), "caf%E9 100%25.csv");
  EXPECT_EQ(AsUtf8("\x7f\xe2\x80\xa8"), "%7F%E2%80%A8");
  for (const std::string name :
       {"caf\xe9 %41.csv", "\xff\xfe", "\xed\xa0\x80", "\xc2\x85"}) {
    EXPECT_NE(AsUtf8(name), name);
    EXPECT_EQ(WithoutPercents(AsUtf8(name)), name);
  }
}

TEST(Utf8Test, EmittedTextsReadBack) {
  for (const std::string name : {"a\nb", "a\x01b", "- a: [b", "caf\xe9"}) {
    YamlEmitter yaml;
    yaml << YAML::BeginMap;
    YamlPair(&yaml, "log", name);
    yaml << YAML::EndMap;
    EXPECT_EQ(WithoutPercents(YAML::Load(yaml.c_str())["log"].Scalar()), name);
  }
}

TEST(Utf8Test, AMessageIsOneLineOfText) {
  EXPECT_EQ(OneLine("a\nb\x1b[2J caf\xe9 \xc3\xa9"), "a b [2J caf? \xc3\xa9");
}

}  // namespace
}  // namespace finray
