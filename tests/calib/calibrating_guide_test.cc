// docs/guides/troubleshooting.md has every warning code of the sources, and no
// other.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace finray {
namespace {

std::string TextOf(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

void AddMatches(const std::string& text, const std::regex& pattern,
                std::set<std::string>* found) {
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end;
       match != end; ++match) {
    found->insert((*match)[1]);
  }
}

// A code begins a warning's braces.
std::set<std::string> CodesOfSources() {
  const std::regex pushed(
      "warnings(?:->|\\.)(?:push_back\\(|insert\\(\\s*first,)\\s*\\{\\s*\"(\\w+"
      ")\"");
  std::set<std::string> codes;
  for (const auto& file : std::filesystem::recursive_directory_iterator(
           FINRAY_SOURCE_DIR "/calib/finray/calib")) {
    if (file.path().extension() != ".cc") continue;
    AddMatches(TextOf(file.path()), pushed, &codes);
  }
  return codes;
}

TEST(CalibratingGuideTest, HasEveryWarningCode) {
  const std::set<std::string> codes = CodesOfSources();
  // Some of different files, lest the pattern finds nothing any more.
  for (const char* code : {"noise_above_plan", "dead_gauge", "no_free_frame"}) {
    EXPECT_THAT(codes, testing::Contains(code));
  }
  const std::string guide =
      TextOf(FINRAY_SOURCE_DIR "/docs/guides/troubleshooting.md");
  const std::size_t from = guide.find("\n## Warning codes\n");
  ASSERT_NE(from, std::string::npos);
  std::set<std::string> documented;
  AddMatches(guide.substr(from, guide.find("\n## ", from + 1) - from),
             std::regex("\n\\| `(\\w+)` \\|"), &documented);
  EXPECT_EQ(documented, codes);
}

}  // namespace
}  // namespace finray
