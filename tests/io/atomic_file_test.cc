#include "finray/io/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(AtomicFileTest, ALinkIsReplacedAndItsTargetKept) {
  const TempFolder folder;
  folder.Write("theirs", "kept");
  for (const char* target : {"theirs", "nothing"}) {
    std::filesystem::create_symlink(folder.Path(target), folder.Path("a"));
    WriteFileAtomically(folder.Path("a"), "new");
    EXPECT_EQ(folder.Read("a"), "new");
    EXPECT_FALSE(std::filesystem::is_symlink(folder.Path("a")));
    std::filesystem::remove(folder.Path("a"));
  }
  EXPECT_EQ(folder.Read("theirs"), "kept");
  EXPECT_FALSE(std::filesystem::exists(folder.Path("nothing")));
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

}  // namespace
}  // namespace finray
