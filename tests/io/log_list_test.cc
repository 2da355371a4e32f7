#include "finray/io/log_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class LogListTest : public testing::Test {
 protected:
  LogListTest() {
    std::filesystem::create_directory(At("runs"));
    for (const char* name : {"runs/b.csv", "runs/a.csv", "runs/c.csv.gz",
                             "runs/x[1].csv", "x.csv"}) {
      folder_.Write(name, "");
    }
    std::filesystem::create_directory(At("runs/folder.csv"));
  }
  std::string At(const std::string& name) const { return folder_.Path(name); }
  void ExpectError(const std::vector<std::string>& items,
                   const std::string& text) {
    EXPECT_THAT([&] { ExpandLogs(items); },
                ThrowsMessage<InputError>(HasSubstr(text)));
  }
  TempFolder folder_;
};

TEST_F(LogListTest, FilesPatternsAndLists) {
  EXPECT_THAT(ExpandLogs({"none.csv", At("x.csv")}),
              ElementsAre("none.csv", At("x.csv")));
  EXPECT_THAT(ExpandLogs({At("runs/[ab]*.csv"), At("?.csv")}),
              ElementsAre(At("runs/a.csv"), At("runs/b.csv"), At("x.csv")));
  EXPECT_THAT(ExpandLogs({At("runs/*.csv*")}),
              ElementsAre(At("runs/a.csv"), At("runs/b.csv"),
                          At("runs/c.csv.gz"), At("runs/x[1].csv")));
  EXPECT_THAT(ExpandLogs({At("runs/x[1].csv")}),
              ElementsAre(At("runs/x[1].csv")));
  const std::string text =
      "# logs of May\r\n\r\n runs/b.csv # again\r\nx.csv\nruns/c*\n" +
      At("runs/a.csv");
  folder_.Write("may", text);
  folder_.Write("may.list", text);
  for (const std::string& item : {"@" + At("may"), At("may.list")}) {
    EXPECT_THAT(ExpandLogs({item}),
                ElementsAre(At("runs/b.csv"), At("x.csv"), At("runs/c.csv.gz"),
                            At("runs/a.csv")));
  }
}

TEST_F(LogListTest, FoldersAndAnyFolders) {
  for (const char* name : {"runs/d", "runs/d/e", "runs/.hidden", "empty"}) {
    std::filesystem::create_directory(At(name));
  }
  for (const char* name : {"runs/d/e/a.csv", "runs/d/z.txt",
                           "runs/.hidden/a.csv", "runs/d/a.frames.csv"}) {
    folder_.Write(name, "");
  }
  std::filesystem::create_directory_symlink(At("runs/d"), At("runs/link"));
  const std::vector<std::string> in_runs = {At("runs/a.csv"), At("runs/b.csv"),
                                            At("runs/c.csv.gz"),
                                            At("runs/x[1].csv")};
  EXPECT_EQ(ExpandLogs({At("runs")}), in_runs);
  EXPECT_EQ(ExpandLogs({At("runs/")}), in_runs);
  EXPECT_THAT(ExpandLogs({At("runs/**/a*.csv")}, At("runs/d")),
              ElementsAre(At("runs/a.csv"), At("runs/d/e/a.csv")));
  EXPECT_THAT(ExpandLogs({At("ru*/**/e/**")}),
              ElementsAre(At("runs/d/e/a.csv")));
  EXPECT_THAT(
      ExpandLogs({At("**")}, At("runs")),
      ElementsAre(At("runs/a.csv"), At("runs/b.csv"), At("runs/c.csv.gz"),
                  At("runs/d/e/a.csv"), At("runs/x[1].csv"), At("x.csv")));
  ExpectError({At("empty")}, "empty: is a folder without *.csv and *.csv.gz");
}

TEST_F(LogListTest, SaysWhatIsMissing) {
  ExpectError({}, "--logs: names no log");
  ExpectError({At("runs/*.tsv")}, "runs/*.tsv' matches no file");
  ExpectError({"@" + At("none")}, "none: cannot be read: No such file");
  folder_.Write("a.txt", "# none\n");
  ExpectError({At("a.txt")}, "a.txt: lists no logs");
  folder_.Write("a.txt", "x.csv\n\nruns/*.tsv\n");
  ExpectError({At("a.txt")}, "a.txt:3: '" + At("runs/*.tsv") + "' matches no");
  folder_.Write("a.txt", "x.csv\ny.csv\n");
  ExpectError({At("a.txt")}, "a.txt:2: there is no log '" + At("y.csv") + "'");
}

TEST_F(LogListTest, PatternsPassOverResults) {
  folder_.Write("runs/a.frames.csv", "");
  folder_.Write("runs/summary.csv", "");
  EXPECT_THAT(ExpandLogs({At("runs/[as]*.csv")}, At("runs")),
              ElementsAre(At("runs/a.csv")));
  EXPECT_THAT(ExpandLogs({At("runs/[as]*.csv")}, At("other")),
              ElementsAre(At("runs/a.csv"), At("runs/a.frames.csv"),
                          At("runs/summary.csv")));
}

TEST_F(LogListTest, ResultsDoNotClash) {
  EXPECT_THAT(
      ResultPaths({"p/a.csv", "b.csv.gz", "c"}, "D"),
      ElementsAre("D/a.frames.csv", "D/b.frames.csv", "D/c.frames.csv"));
  EXPECT_THAT(
      [] {
        ResultPaths({"p/a.csv", "b.csv", "q/a.csv.gz"}, "D");
      },
      ThrowsMessage<InputError>(
          HasSubstr("'p/a.csv' and 'q/a.csv.gz' would both be written "
                    "to D/a.frames.csv")));
  const std::string result = folder_.Write("x.frames.csv", "");
  EXPECT_THAT(
      [&] {
        ResultPaths({At("x.csv"), result}, At(""));
      },
      ThrowsMessage<InputError>(HasSubstr("x.csv' would overwrite '")));
}

TEST_F(LogListTest, ResultsLieAsTheLogsLieInTheirRoot) {
  EXPECT_THAT(
      ResultPaths({"p/a.csv", "p/q/a.csv", "p/q/../b.csv"}, "D", "p"),
      ElementsAre("D/a.frames.csv", "D/q/a.frames.csv", "D/b.frames.csv"));
  EXPECT_THAT(
      [] {
        ResultPaths({"p/q/a.csv", "p/q/a.csv.gz"}, "D", "p");
      },
      ThrowsMessage<InputError>(HasSubstr("both be written to D/q/a.frames")));
  for (const char* log : {"b.csv", "pq/a.csv", "p/../a.csv"}) {
    EXPECT_THAT([&] { ResultPaths({log}, "D", "p"); },
                ThrowsMessage<InputError>(HasSubstr(
                    std::string("'") + log + "' is not below --logs_root p")));
  }
}

}  // namespace
}  // namespace finray
