#include "finray/io/sha256.h"

#include <gtest/gtest.h>

#include "temp_file.h"

namespace finray {
namespace {

TEST(Sha256Test, KnownDigests) {  // FIPS 180-4 examples
  const TempFolder folder;
  EXPECT_EQ(Sha256OfFile(folder.Write("a", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256OfFile(folder.Write("b", "")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256OfText("abc"), Sha256OfFile(folder.Path("a")));
}

TEST(Sha256Test, EndsWhenToldTo) {
  const TempFolder folder;
  int calls = 0;
  const std::string path = folder.Write("a", std::string(1 << 20, 'a'));
  EXPECT_EQ(Sha256OfFile(path, [&] { return ++calls == 2; }), "");
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(Sha256OfFile(path, [] { return false; }), Sha256OfFile(path));
}

}  // namespace
}  // namespace finray
