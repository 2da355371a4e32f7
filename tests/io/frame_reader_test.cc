#include "finray/io/frame_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "finray/io/error.h"
#include "renaming.h"
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
  ColumnMapping renames_ = Renaming("U1", "gauge_1_V");
  TempFolder folder_;
};

TEST_F(FrameReaderTest, PiecesAreTheWhole) {
  const std::string path = Write(100);
  const FrameTable whole = FrameTable::Read(path, renames_);
  const std::vector<double>& numbers = whole.Numbers("gauge_1_V");
  whole.Write(folder_.Path("log.csv.gz"));
  for (const std::size_t rows : {1, 7, 100, 1000}) {
    FrameReader reader(path, renames_);
    FrameReader zipped(folder_.Path("log.csv.gz"));
    EXPECT_EQ(reader.parser().names(), whole.headers());
    EXPECT_EQ(zipped.parser().names(), whole.headers());
    LineBlock lines, unzipped;
    std::size_t row = 0;
    while (reader.ReadLines(rows, &lines)) {
      EXPECT_EQ(lines.size(), std::min(rows, 100 - row));
      ASSERT_TRUE(zipped.ReadLines(rows, &unzipped));
      ASSERT_EQ(unzipped.size(), lines.size());
      for (std::size_t i = 0; i < lines.size(); ++i, ++row) {
        EXPECT_EQ(lines.at(i).number, whole.line(row));
        for (const auto& [from, line] :
             {std::pair(&reader, lines.at(i)), {&zipped, unzipped.at(i)}}) {
          FrameRows cells;
          from->parser().Parse(line, &cells);
          EXPECT_EQ(cells.at(0, 0).number, numbers[row]);
          EXPECT_EQ(cells.at(0, 1).text, row % 3 ? "a" : "b,c");
        }
      }
    }
    EXPECT_EQ(row, 100u);
    EXPECT_EQ(reader.position(), 100u);
    EXPECT_FALSE(reader.ReadLines(rows, &lines));
  }
}

TEST_F(FrameReaderTest, GoesOnBehindWhatWasSkipped) {
  const std::string path = Write(10);
  const FrameTable whole = FrameTable::Read(path, renames_);
  FrameReader reader(path, renames_);
  EXPECT_EQ(reader.Skip(8), 8u);
  LineBlock lines;
  ASSERT_TRUE(reader.ReadLines(8, &lines));
  EXPECT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines.at(1).number, whole.line(9));
  FrameRows row;
  reader.parser().Parse(lines.at(0), &row);
  EXPECT_EQ(row.at(0, 0).number, whole.Numbers("gauge_1_V")[8]);
  EXPECT_EQ(reader.Skip(1), 0u);
}

TEST_F(FrameReaderTest, ErrorsNameThePlaceInTheFile) {
  const std::string path =
      folder_.Write("bad.csv", "force_N\n1\n2\n3\n4x\n5\n");
  EXPECT_THAT([&] { FrameTable::Read(path); },
              ThrowsMessage<InputError>(HasSubstr("bad.csv:5:1: force_N: ")));
  const std::string empty = folder_.Write("empty.csv", "force_N\n");
  EXPECT_THAT([&] { FrameReader reader(empty); },
              ThrowsMessage<InputError>(HasSubstr("a header but no rows")));
}

}  // namespace
}  // namespace finray
