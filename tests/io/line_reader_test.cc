#include "finray/io/line_reader.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <thread>

#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

class LineReaderTest : public testing::Test {
 protected:
  LineReaderTest() { EXPECT_EQ(pipe(ends_), 0); }
  ~LineReaderTest() override {
    close(ends_[0]);
    if (ends_[1] >= 0) close(ends_[1]);
  }
  void Write(const std::string& text) {
    EXPECT_EQ(write(ends_[1], text.data(), text.size()),
              static_cast<ssize_t>(text.size()));
  }
  void End() {
    close(ends_[1]);
    ends_[1] = -1;
  }
  int ends_[2];
};

TEST_F(LineReaderTest, PiecesOfAnySizeAreTheLines) {
  const std::string text =
      "a\r\n\n\xC3\xA4,b\n \t\n" + std::string(100000, 'c') + "\r\r\nlast";
  for (const std::size_t piece : {1, 7, 4096}) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    std::thread writer([&] {
      for (std::size_t at = 0; at < text.size(); at += piece) {
        const std::string part = text.substr(at, piece);
        if (write(ends[1], part.data(), part.size()) < 0) break;
      }
      close(ends[1]);
    });
    LineReader lines = ReadPipe(ends[0], -1, "pipe");
    const auto expect = [&](const std::string& line, int number) {
      ASSERT_TRUE(lines.Next());
      EXPECT_EQ(lines.line().text, line);
      EXPECT_EQ(lines.line().number, number);
      EXPECT_FALSE(lines.line().nul);
    };
    expect("a", 1);
    expect("\xC3\xA4,b", 3);
    expect(std::string(100000, 'c'), 5);
    expect("last", 6);
    EXPECT_FALSE(lines.Next());
    EXPECT_FALSE(lines.Next());
    writer.join();
    close(ends[0]);
  }
}

TEST_F(LineReaderTest, SeesNulBytes) {
  LineReader lines = ReadPipe(ends_[0], -1, "pipe");
  Write(std::string("1,\0002\n3\n", 7));
  ASSERT_TRUE(lines.Next());
  EXPECT_TRUE(lines.line().nul);
  EXPECT_EQ(lines.line().text.size(), 4u);
  ASSERT_TRUE(lines.Next());
  EXPECT_FALSE(lines.line().nul);
}

TEST_F(LineReaderTest, ALineWithoutEndIsRefused) {
  const TempFolder folder;
  folder.Write("long", "a\n" + std::string((1 << 24) + 10, '1'));
  const int file = open(folder.Path("long").c_str(), O_RDONLY);
  LineReader lines = ReadPipe(file, -1, "pipe");
  ASSERT_TRUE(lines.Next());
  EXPECT_THAT([&] { lines.Next(); },
              testing::ThrowsMessage<InputError>(
                  "pipe:2: the line is too long for a table of numbers"));
  close(file);
}

TEST_F(LineReaderTest, WakesUp) {
  int wake[2];
  ASSERT_EQ(pipe(wake), 0);
  LineReader lines = ReadPipe(ends_[0], wake[0], "pipe");
  Write("a\nhalf");
  ASSERT_TRUE(lines.Next());
  std::thread waker([&] {
    usleep(20000);
    EXPECT_EQ(write(wake[1], "", 1), 1);
  });
  EXPECT_FALSE(lines.Next());
  waker.join();
  for (const int end : wake) close(end);
}

TEST_F(LineReaderTest, PipeAndFileGiveTheSameLines) {
  const TempFolder folder;
  const std::string text =
      "\n a,b \r\n" + std::string(300000, '1') + "\n\t\n2\r\r\n,\nlast";
  const std::string path = folder.Write("a.csv", text);
  const int file = open(path.c_str(), O_RDONLY);
  LineReader piped = ReadPipe(file, -1, "pipe");
  LineReader read = ReadFile(path);
  int lines = 0;
  for (; read.Next(); ++lines) {
    ASSERT_TRUE(piped.Next());
    EXPECT_EQ(read.line().text, piped.line().text);
    EXPECT_EQ(read.line().number, piped.line().number);
  }
  EXPECT_FALSE(piped.Next());
  EXPECT_EQ(lines, 5);
  close(file);
}

}  // namespace
}  // namespace finray
