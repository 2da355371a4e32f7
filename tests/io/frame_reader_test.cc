#include "finray/io/frame_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class FrameReaderTest : public testing::Test {
 protected:
  std::string Write(int rows) {
    std::string text = "# lab 3\nU1,note\n";
    for (int i = 0; i < rows; ++i) {
      text += std::to_string(0.1 * i) + (i % 3 ? ",a\n" : ",\"b,c\"\n\n");
    }
    return folder_.Write("log.csv", text);
  }
  const std::map<std::string, std::string> renames_ = {{"U1", "gauge_1_V"}};
  TempFolder folder_;
};

TEST_F(FrameReaderTest, PiecesAreTheWhole) {
  const std::string path = Write(100);
  const FrameTable whole = FrameTable::Read(path, renames_);
  whole.Write(folder_.Path("log.csv.gz"));
  for (const std::size_t rows : {1, 7, 100, 1000}) {
    FrameReader reader(path, renames_);
    FrameReader zipped(folder_.Path("log.csv.gz"));
    std::string text, unzipped;
    FrameTable table;
    for (std::size_t row = 0; reader.Read(rows, &table); ++row) {
      EXPECT_EQ(table.line(0), whole.line(row * rows));
      text += table.RowsCsv();
      ASSERT_TRUE(zipped.Read(rows, &table));
      unzipped += table.RowsCsv();
    }
    EXPECT_EQ(table.headers(), whole.headers());
    EXPECT_EQ(text, whole.RowsCsv());
    EXPECT_EQ(unzipped, text);
    EXPECT_EQ(reader.position(), 100u);
    EXPECT_FALSE(reader.Read(rows, &table));
  }
}

TEST_F(FrameReaderTest, GoesOnBehindWhatWasSkipped) {
  const std::string path = Write(10);
  const FrameTable whole = FrameTable::Read(path, renames_);
  FrameReader reader(path, renames_);
  EXPECT_EQ(reader.Skip(8), 8u);
  FrameTable table;
  ASSERT_TRUE(reader.Read(8, &table));
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.line(1), whole.line(9));
  EXPECT_EQ(table.Numbers("gauge_1_V")[0], whole.Numbers("gauge_1_V")[8]);
  EXPECT_EQ(reader.Skip(1), 0u);
}

TEST_F(FrameReaderTest, ErrorsNameThePlaceInTheFile) {
  const std::string path =
      folder_.Write("bad.csv", "force_N\n1\n2\n3\n4x\n5\n");
  FrameReader reader(path);
  FrameTable table;
  ASSERT_TRUE(reader.Read(2, &table));
  EXPECT_THAT([&] { reader.Read(2, &table); },
              ThrowsMessage<InputError>(HasSubstr("bad.csv:5:1: force_N: ")));
  const std::string empty = folder_.Write("empty.csv", "force_N\n");
  EXPECT_THAT([&] { FrameReader reader(empty); },
              ThrowsMessage<InputError>(HasSubstr("a header but no rows")));
}

}  // namespace
}  // namespace finray
