// The fuzzers' seeds and past findings without a fuzzer.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "fuzz/targets.h"

namespace finray {

void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

namespace {

namespace fs = std::filesystem;

constexpr char kCorpus[] = FINRAY_SOURCE_DIR "/tests/fuzz/corpus";

class CorpusTest : public testing::TestWithParam<Target> {};

// A target ends the process if an answer is not one short line or if what it
// read does not read back.
TEST_P(CorpusTest, EveryFileIsReadOrRefused) {
  int files = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(kCorpus) / GetParam().name)) {
    SCOPED_TRACE(entry.path().string());
    std::ostringstream bytes;
    bytes << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    EXPECT_NO_THROW(GetParam().run(bytes.str()));
    ++files;
  }
  EXPECT_GT(files, 0);
}

INSTANTIATE_TEST_SUITE_P(All, CorpusTest, testing::ValuesIn(kTargets),
                         [](const testing::TestParamInfo<Target>& info) {
                           return std::string(info.param.name);
                         });

TEST(FuzzCorpusTest, EveryFolderHasATarget) {
  const auto folders = std::distance(fs::directory_iterator(kCorpus), {});
  EXPECT_EQ(folders, static_cast<std::ptrdiff_t>(std::size(kTargets)));
}

}  // namespace
}  // namespace finray
