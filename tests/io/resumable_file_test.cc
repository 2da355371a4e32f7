#include "finray/io/resumable_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class ResumableFileTest : public testing::Test {
 protected:
  // Writes "one" up to a checkpoint, and more behind it, as a crash leaves it.
  void Crash() {
    ResumableFile file(path_, "k", false);
    file.Append("one ");
    file.Checkpoint("note 1");
    file.Append("lost");
  }
  bool Exists(const std::string& name) const {
    return std::filesystem::exists(folder_.Path(name));
  }
  std::string Journal() const { return folder_.Read(".a.csv.journal"); }

  TempFolder folder_;
  const std::string path_ = folder_.Path("a.csv");
};

TEST_F(ResumableFileTest, AppearsWhenItIsComplete) {
  ResumableFile file(path_, "k", false);
  EXPECT_EQ(file.note(), "");
  file.Append("one ");
  file.Checkpoint("1");
  file.Append("two");
  EXPECT_FALSE(Exists("a.csv"));
  file.Finish("2");
  EXPECT_EQ(folder_.Read("a.csv"), "one two");
  EXPECT_EQ(file.bytes(), 7u);
  file.Forget();
  EXPECT_FALSE(Exists(".a.csv.journal"));
  EXPECT_FALSE(Exists(".a.csv.part"));
}

TEST_F(ResumableFileTest, GoesOnFromTheLastCheckpoint) {
  Crash();
  ResumableFile file(path_, "k", true);
  EXPECT_EQ(file.note(), "note 1");
  EXPECT_EQ(file.bytes(), 4u);
  file.Append("two");
  file.Finish("");
  EXPECT_EQ(folder_.Read("a.csv"), "one two");
}

TEST_F(ResumableFileTest, CheckpointsMadeMeanwhileCountWhatIsThere) {
  {
    ResumableFile file(path_, "k", false);
    for (int i = 0; i < 50; ++i) {
      file.Append("0123456789");
      file.CheckpointSoon(std::to_string(i));
    }
  }
  {
    ResumableFile file(path_, "k", true);
    ASSERT_NE(file.note(), "");  // the first one was not skipped
    EXPECT_EQ(file.bytes(), 10u * (std::stoul(file.note()) + 1));
    file.Append("more");
    file.CheckpointSoon("soon");
    file.Checkpoint("now");
  }
  ResumableFile file(path_, "k", true);
  EXPECT_EQ(file.note(), "now");
  file.CheckpointSoon("soon");
  file.Finish("end");
  EXPECT_EQ(folder_.Read("a.csv").size(), file.bytes());
}

TEST_F(ResumableFileTest, StartsOverWithAnotherKeyOrOnRequest) {
  for (const bool resume : {true, false}) {
    Crash();
    ResumableFile file(path_, resume ? "other" : "k", resume);
    EXPECT_EQ(file.note(), "");
    file.Append("new");
    file.Finish("");
    EXPECT_EQ(folder_.Read("a.csv"), "new");
    file.Forget();
  }
}

TEST_F(ResumableFileTest, AJournalCutAnywhereLosesItsLastLineAtMost) {
  Crash();
  const std::string one = Journal();
  {
    ResumableFile file(path_, "k", true);
    file.Append("two ");
    file.Checkpoint("note 2");
  }
  const std::string both = Journal();
  const std::string longer = folder_.Read(".a.csv.part");
  for (std::size_t cut = 0; cut <= both.size(); ++cut) {
    folder_.Write(".a.csv.part", longer);
    folder_.Write(".a.csv.journal", both.substr(0, cut));
    ResumableFile file(path_, "k", true);
    const std::string expected = cut == both.size()  ? "note 2"
                                 : cut >= one.size() ? "note 1"
                                                     : "";
    ASSERT_EQ(file.note(), expected) << cut;
    file.Append("end");
    file.Finish("");
    ASSERT_EQ(folder_.Read("a.csv").substr(file.bytes() - 3), "end");
    ASSERT_EQ(folder_.Read("a.csv").size(), file.bytes());
    file.Forget();
  }
  // Bytes that did not reach the disk read as zeros.
  folder_.Write(".a.csv.part", longer);
  folder_.Write(".a.csv.journal", one + std::string(20, '\0') + "\n");
  EXPECT_EQ(ResumableFile(path_, "k", true).note(), "note 1");
  // A journal counts on bytes that have gone.
  folder_.Write(".a.csv.part", "on");
  folder_.Write(".a.csv.journal", one);
  EXPECT_EQ(ResumableFile(path_, "k", true).note(), "");
}

TEST_F(ResumableFileTest, AFlippedBitIsNotGoneOnWith) {
  Crash();
  {
    ResumableFile file(path_, "k", true);
    file.Append("two ");
    file.Checkpoint("note 2");
  }
  const std::string journal = Journal(), part = folder_.Read(".a.csv.part");
  const std::size_t bytes = journal.size() + part.size();
  for (std::size_t bit = 0; bit < 8 * bytes; bit += 11) {
    std::string both = journal + part;
    both[bit / 8] = static_cast<char>(both[bit / 8] ^ (1 << bit % 8));
    folder_.Write(".a.csv.journal", both.substr(0, journal.size()));
    folder_.Write(".a.csv.part", both.substr(journal.size()));
    const ResumableFile file(path_, "k", true);
    ASSERT_NE(file.note(), "note 2") << bit;
    ASSERT_NE(file.damaged(), "") << bit;
    const std::string kept = folder_.Read(".a.csv.part");
    ASSERT_EQ(kept, file.note() == "note 1" ? "one " : "") << bit;
  }
  // So in the whole file of a run that ended before it said so.
  folder_.Write(".a.csv.journal", journal);
  folder_.Write(".a.csv.part", part);
  ResumableFile(path_, "k", true).Finish("sum");
  folder_.Write("a.csv", "one twO ");
  const ResumableFile file(path_, "k", true);
  EXPECT_FALSE(file.finished());
  EXPECT_EQ(file.damaged(), path_);
}

TEST_F(ResumableFileTest, LinksAreNotFollowed) {
  const std::string theirs = folder_.Write("theirs", "kept");
  for (const char* name : {".a.csv.journal", ".a.csv.part", "a.csv"}) {
    std::filesystem::create_symlink(theirs, folder_.Path(name));
    try {
      ResumableFile file(path_, "k", true);
      file.Append("new");
      file.Finish("");
      file.Forget();
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("journal is a link"));
    }
    EXPECT_EQ(folder_.Read("theirs"), "kept") << name;
    std::filesystem::remove(folder_.Path(name));
    std::filesystem::remove(path_);
  }
}

TEST_F(ResumableFileTest, ACrashAfterTheRenameLeavesNothingToDo) {
  {
    ResumableFile file(path_, "k", false);
    file.Append("all");
    file.Finish("sum");
  }
  {
    ResumableFile file(path_, "k", true);
    EXPECT_TRUE(file.finished());
    EXPECT_EQ(file.note(), "sum");
    EXPECT_EQ(file.bytes(), 3u);
  }
  // Before the rename it is made up for.
  std::filesystem::rename(path_, folder_.Path(".a.csv.part"));
  {
    ResumableFile file(path_, "k", true);
    EXPECT_FALSE(file.finished());
    file.Finish("sum");
    EXPECT_EQ(folder_.Read("a.csv"), "all");
  }
  folder_.Write("a.csv", "something else");
  EXPECT_FALSE(ResumableFile(path_, "k", true).finished());
}

TEST_F(ResumableFileTest, OneWriterAtATime) {
  ResumableFile file(path_, "k", false);
  EXPECT_THAT(
      [&] { ResumableFile(path_, "k", true); },
      ThrowsMessage<InputError>(HasSubstr("another process is writing it")));
  file.Discard();
  EXPECT_TRUE(std::filesystem::is_empty(folder_.Path("")));
}

TEST_F(ResumableFileTest, SaysWhatCannotBeWritten) {
  EXPECT_THAT(
      [&] { ResumableFile(folder_.Path("no/a.csv"), "k", true); },
      ThrowsMessage<InputError>(HasSubstr("no/a.csv: cannot be written: No")));
  std::filesystem::create_directory(path_);
  EXPECT_THAT([&] { ResumableFile(path_, "k", true); },
              ThrowsMessage<InputError>(HasSubstr("no regular file")));
}

}  // namespace
}  // namespace finray
