#include "finray/io/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(AtomicFileTest, ReplacesAndLeavesNothingBeside) {
  const TempFolder folder;
  WriteFileAtomically(folder.Path("a"), "one");
  WriteFileAtomically(folder.Path("a"), "two");
  EXPECT_EQ(folder.Read("a"), "two");
  int files = 0;
  for ([[maybe_unused]] const auto& entry :
       std::filesystem::directory_iterator(folder.Path(""))) {
    ++files;
  }
  EXPECT_EQ(files, 1);
}

TEST(AtomicFileTest, FailuresNameThePath) {
  const TempFolder folder;
  const std::string path = folder.Path("no/such/file");
  EXPECT_THAT([&] { WriteFileAtomically(path, ""); },
              ThrowsMessage<InputError>(HasSubstr(path + ": cannot be written: "
                                                         "No such file")));
  folder.Write("file", "");
  EXPECT_THAT([&] { MakeFolder(folder.Path("file")); },
              ThrowsMessage<InputError>(HasSubstr("cannot be made a folder")));
}

TEST(NumberTextTest, ReadsBackTheSame) {
  for (const double value :
       {0.1, -1.0 / 3, 1e300, 5e-324, 123456789.123456789, 0.0}) {
    EXPECT_EQ(std::strtod(NumberText(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(NumberText(0.1), "0.1");
  EXPECT_EQ(NumberText(std::nan("")), "nan");
  EXPECT_EQ(NumberText(-std::numeric_limits<double>::infinity()), "-inf");
}

}  // namespace
}  // namespace finray
