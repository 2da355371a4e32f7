#include "finray/io/yaml_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

class YamlMapTest : public testing::Test {
 protected:
  YamlMap Load(const std::string& text) {
    return YamlMap::FromFile(folder_.Write("a.yaml", text));
  }
  TempFolder folder_;
};

#define EXPECT_INPUT_ERROR(expression, text) \
  EXPECT_THAT([&] { expression; }, ThrowsMessage<InputError>(HasSubstr(text)))

TEST_F(YamlMapTest, ReadsValues) {
  const YamlMap map = Load(
      "a: 1.5\nb: word\nc: {d: 2e-3}\ne:\n  - {f: 1}\n  - {f: 2}\ng: true\n");
  EXPECT_EQ(map.Number("a"), 1.5);
  EXPECT_EQ(map.Number("z", 7), 7);
  EXPECT_EQ(map.Text("b"), "word");
  EXPECT_EQ(map.Map("c").Number("d"), 2e-3);
  ASSERT_EQ(map.Maps("e").size(), 2u);
  EXPECT_EQ(map.Maps("e")[1].Integer("f"), 2);
  EXPECT_TRUE(map.Boolean("g", false));
}

TEST_F(YamlMapTest, ErrorsNameThePlace) {
  EXPECT_INPUT_ERROR(Load("a: x\n").Number("a"),
                     "a.yaml:1:4: a: expected a number, found 'x'");
  EXPECT_INPUT_ERROR(Load("a: 1,5\n").Number("a"), "expected a number");
  EXPECT_INPUT_ERROR(Load("a: .nan\n").Number("a"), "expected a number");
  EXPECT_INPUT_ERROR(Load("a: 1e999\n").Number("a"), "expected a number");
  EXPECT_INPUT_ERROR(Load("a: {b: 0}\n").Map("a").PositiveNumber("b"),
                     "a.yaml:1:8: b: expected a number above 0, found '0'");
  EXPECT_INPUT_ERROR(Load("a: 1\n").Number("b"), "'b' is missing in the file");
  EXPECT_INPUT_ERROR(Load("a: 1.5\n").Integer("a"), "expected a whole number");
  EXPECT_INPUT_ERROR(Load("a: yes\n").Boolean("a", false), "true or false");
  EXPECT_INPUT_ERROR(Load("a: fornt\n").Choice("a", {"front", "back"}),
                     "found 'fornt' (did you mean 'front'?)");
  EXPECT_INPUT_ERROR(Load("ribs:\n  - {a: 1}\n  - 3\n").Maps("ribs"),
                     "a.yaml:3:5: ribs[2]: expected a mapping, found '3'");
}

TEST_F(YamlMapTest, UnknownAndDoubleKeys) {
  EXPECT_INPUT_ERROR(
      Load("r:\n  - {lenght_mm: 1}\n").Maps("r")[0].AllowOnly({"length_mm"}),
      "a.yaml:2:6: unknown key 'lenght_mm' in r[1] (did you mean "
      "'length_mm'?)");
  EXPECT_INPUT_ERROR(Load("colour: 1\n").AllowOnly({"a", "b"}),
                     "unknown key 'colour' in the file; known are a b");
  EXPECT_INPUT_ERROR(Load("a: 1\na: 2\n"), "a.yaml:2:1: key 'a' appears twice");
}

TEST_F(YamlMapTest, FilesThatAreNoMapping) {
  EXPECT_INPUT_ERROR(Load(""), "is empty, expected a YAML mapping");
  EXPECT_INPUT_ERROR(Load("a: 1\n---\nb: 2\n"), "a second YAML document");
  EXPECT_INPUT_ERROR(Load(std::string("a: 1\n\0", 6)), ":2:1: found a NUL");
  EXPECT_INPUT_ERROR(Load("- 1\n"), "found a sequence");
  EXPECT_INPUT_ERROR(Load("a: [1\n"), "not valid YAML");
  EXPECT_INPUT_ERROR(YamlMap::FromFile(folder_.Path("none")),
                     "none: cannot be read: No such file");
  EXPECT_INPUT_ERROR(YamlMap::FromFile(folder_.Path("")), "is a folder");
}

TEST_F(YamlMapTest, MessagesAreOneLine) {
  EXPECT_THAT([&] { Load("a: \"x\\ny\"\n").Number("a"); },
              ThrowsMessage<InputError>(Not(HasSubstr("\n"))));
}

}  // namespace
}  // namespace finray
