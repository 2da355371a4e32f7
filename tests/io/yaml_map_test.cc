#include "finray/io/yaml_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

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

TEST_F(YamlMapTest, ErrorsNameTheDefault) {
  EXPECT_INPUT_ERROR(Load("a: x\n").Number("a", 3e-4),
                     "a: expected a number, found 'x'; the default is 0.0003");
  EXPECT_INPUT_ERROR(Load("a: 0\n").PositiveNumber("a", 2), "default is 2");
  EXPECT_INPUT_ERROR(Load("a: x\n").Integer("a", 5), "default is 5");
  EXPECT_INPUT_ERROR(Load("a: x\n").Boolean("a", false), "default is false");
  EXPECT_INPUT_ERROR(Load("a: []\n").Text("a", "auto"), "default is auto");
  for (const double fallback : {-HUGE_VAL, std::nan("")}) {
    EXPECT_THAT([&] { Load("a: x\n").Number("a", fallback); },
                ThrowsMessage<InputError>(Not(HasSubstr("default"))));
  }
  EXPECT_THAT([&] { Load("a: x\n").Number("a"); },
              ThrowsMessage<InputError>(Not(HasSubstr("default"))));
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
  EXPECT_INPUT_ERROR(Load("a:\n  b: 1\n \tc: 2\n"),
                     ":3:2: not valid YAML: tab in the indentation, YAML wants "
                     "spaces (");
  EXPECT_INPUT_ERROR(YamlMap::FromFile(folder_.Path("none")),
                     "none: cannot be read: No such file");
  EXPECT_INPUT_ERROR(YamlMap::FromFile(folder_.Path("")), "is a folder");
}

TEST_F(YamlMapTest, FilesThatStandForTooMuch) {
  EXPECT_INPUT_ERROR(Load(", a: 1\n"), "not valid YAML");
  EXPECT_INPUT_ERROR(Load("a: &a [*a]\n"),
                     "a.yaml:1:8: an alias refers to a value that contains it");
  EXPECT_INPUT_ERROR(
      Load("a: " + std::string(51, '[') + std::string(51, ']')),
      "a.yaml:1:53: expected lists and mappings at most 50 deep");
  Load("a: " + std::string(49, '[') + std::string(49, ']') + "\n");
  // Ten to the sixth words, and what holds them.
  std::string laughs = "l0: &l0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i <= 5; ++i) {
    const std::string before = "*l" + std::to_string(i - 1);
    laughs += "l" + std::to_string(i) + ": &l" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) laughs += (k > 0 ? ", " : "") + before;
    laughs += "]\n";
    if (i == 4) {
      EXPECT_NO_THROW(Load(laughs));
    }
  }
  EXPECT_INPUT_ERROR(Load(laughs), "expected at most 1000000 values in a file");
  EXPECT_INPUT_ERROR(Load("a: " + std::string(17 << 20, 'x')),
                     "is too long, expected a YAML file of at most 16 MiB");
}

TEST_F(YamlMapTest, NumbersHaveLimits) {
  EXPECT_EQ(Load("a: -1e30\n").Number("a"), -1e30);
  EXPECT_INPUT_ERROR(Load("a: -1.1e30\n").Number("a"), "at most 1e30");
  EXPECT_EQ(Load("a: 1e-30\n").PositiveNumber("a"), 1e-30);
  EXPECT_INPUT_ERROR(Load("a: 0.9e-30\n").PositiveNumber("a"),
                     "at least 1e-30");
  EXPECT_INPUT_ERROR(Load("a: 0x10\n").Number("a"), "expected a number");
}

TEST_F(YamlMapTest, MessagesAreOneLine) {
  EXPECT_INPUT_ERROR(Load("a: \"x\\ny\"\n").Text("a"),
                     "one short line of text");
  EXPECT_THAT([&] { Load("%YAML 9\r\n---\na: 1\n"); },
              ThrowsMessage<InputError>(Not(HasSubstr("\r"))));
  EXPECT_THAT([&] { Load("a: \"x\\ny\"\n").Number("a"); },
              ThrowsMessage<InputError>(Not(HasSubstr("\n"))));
}

}  // namespace
}  // namespace finray
