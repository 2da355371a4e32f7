// finray_estimate --follow: rows as they come, through pipes.

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <sstream>

#include "apps/command_line.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/frame_table.h"

namespace finray {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr char kNotCalibrated[] =
    "warning: the finger is not calibrated: its gains and stiffness are as "
    "drawn, and so are the std of its forces; calibrate it with "
    "finray_calibrate\n";

// The executable between two pipes.
class Follower {
 public:
  Follower(const std::vector<std::string>& arguments, std::string errors)
      : errors_(std::move(errors)) {
    int in[2], out[2];
    EXPECT_EQ(pipe2(in, O_CLOEXEC), 0);
    EXPECT_EQ(pipe2(out, O_CLOEXEC), 0);
    std::vector<std::string> all = {FINRAY_BINARY_DIR "/finray_estimate",
                                    "--follow"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& argument : all) argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
      dup2(in[0], STDIN_FILENO);
      dup2(out[1], STDOUT_FILENO);
      dup2(open(errors_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666),
           STDERR_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
    close(in[0]);
    close(out[1]);
    in_ = in[1];
    out_ = out[0];
  }
  ~Follower() {
    CloseInput();
    CloseOutput();
    if (child_ > 0) Wait();
  }

  void Write(const std::string& text) {
    EXPECT_EQ(write(in_, text.data(), text.size()),
              static_cast<ssize_t>(text.size()));
  }
  // The next line; waits for it.
  std::string Read() {
    std::string line;
    char c;
    while (read(out_, &c, 1) == 1 && c != '\n') line += c;
    return line;
  }
  std::string ReadAll() {
    std::string all, line;
    while (!(line = Read()).empty()) all += line + "\n";
    return all;
  }
  void CloseInput() { Close(&in_); }
  void CloseOutput() { Close(&out_); }
  void Signal(int signal) { kill(child_, signal); }
  // Its exit code, minus the signal that has ended it.
  int Wait() {
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  std::string Errors() const {
    std::ostringstream text;
    text << std::ifstream(errors_).rdbuf();
    return text.str();
  }

 private:
  static void Close(int* file) {
    if (*file >= 0) close(*file);
    *file = -1;
  }

  std::string errors_;
  pid_t child_ = 0;
  int in_ = -1, out_ = -1;
};

class FollowTest : public CommandLineTest {
 protected:
  FollowTest() {
    std::signal(SIGPIPE, SIG_IGN);
    folder_.Write("scene.yaml", "contacts: 1\n");
  }
  Follower Start(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"--finger", paper_, "--scene",
                                          folder_.Path("scene.yaml")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Follower(arguments, folder_.Path("errors"));
  }
  const std::string header_ =
      "time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n";
  const std::string good_ = ",0.02,0.03,0.04,0.02\n";
};

TEST_F(FollowTest, RowsAreThoseOfABatchAndComeOneByOne) {
  const std::string log = data_ + "train.csv";
  Follower follower = Start();
  std::ifstream lines(log);
  std::string line, rows;
  std::getline(lines, line);
  follower.Write(line + "\n");
  rows = follower.Read() + "\n";
  int count = 0;
  while (std::getline(lines, line)) {
    follower.Write(line + "\n");
    rows += follower.Read() + "\n";  // would wait for ever if it were held back
    ++count;
  }
  follower.CloseInput();
  EXPECT_EQ(follower.Read(), "");
  EXPECT_EQ(follower.Wait(), 0);
  EXPECT_THAT(follower.Errors(), StartsWith(kNotCalibrated));
  EXPECT_THAT(follower.Errors(), HasSubstr("\nlatency        p50 "));
  EXPECT_THAT(follower.Errors(),
              HasSubstr(" us, over " + std::to_string(count) + " frames\n"));

  ASSERT_EQ(Run("finray_estimate", "--finger " + paper_ +
                                       " --scene %scene.yaml --logs " + log +
                                       " --out_dir %out")
                .code,
            0);
  FrameTable batch = FrameTable::Read(folder_.Path("out/train.frames.csv"));
  FrameTable live = FrameTable::Read(folder_.Write("live.csv", rows));
  ASSERT_EQ(live.headers(), batch.headers());
  ASSERT_EQ(live.rows(), batch.rows());
  EXPECT_EQ(live.MutableText("status"), batch.MutableText("status"));
  for (const char* name : {"time_s", "force_N", "gauge_3_rad"}) {
    EXPECT_EQ(live.Numbers(name), batch.Numbers(name)) << name;
  }
  // Starts may differ, hence where iterations end.
  const auto near = [&](const std::string& name, double tolerance) {
    for (std::size_t row = 0; row < live.rows(); ++row) {
      const double is = live.Numbers(name)[row], was = batch.Numbers(name)[row];
      EXPECT_TRUE(std::isnan(was) ? std::isnan(is)
                                  : std::abs(is - was) < tolerance)
          << name << " " << row << ": " << is << " " << was;
    }
  };
  for (std::size_t row = 0; row < live.rows(); ++row) {
    if (live.MutableText("status")[row] == "ok") continue;
    // The place is not determined there.
    for (FrameTable* table : {&live, &batch}) {
      table->MutableNumbers("contact_1_mm")[row] = std::nan("");
      table->MutableNumbers("normal_1_N")[row] = std::nan("");
    }
  }
  near("contact_1_mm", 0.02);
  near("normal_1_N", 0.01);
  near("chi2", 1e-2);
}

TEST_F(FollowTest, LineEndsBlankLinesAndALastLineWithoutEnd) {
  Follower follower = Start();
  follower.Write("# a lab\r\n\r\n\xEF\xBB\xBF" + header_);
  follower.Write("\n1,0.02,0.0");
  follower.Write("3,0.04,0.02\r\n  \r\n2" + good_ + "3" + good_);
  follower.Write("4" + good_.substr(0, good_.size() - 1));
  follower.CloseInput();
  const std::string rows = follower.ReadAll();
  EXPECT_EQ(follower.Wait(), 0);
  const FrameTable table = FrameTable::Read(folder_.Write("live.csv", rows));
  EXPECT_THAT(table.Numbers("time_s"), testing::ElementsAre(1, 2, 3, 4));
  const auto& place = table.Numbers("contact_1_mm");
  for (const double arc : place) EXPECT_NEAR(arc, place[0], 1e-3);
}

TEST_F(FollowTest, AMalformedLineIsARowAndAMessage) {
  Follower follower = Start();
  follower.Write(header_);
  follower.Read();
  const auto bad = [&](const std::string& line, const std::string& row) {
    follower.Write(line + "\n");
    const std::string found = follower.Read();
    EXPECT_THAT(found, StartsWith(row));
    EXPECT_THAT(found, EndsWith(",bad_input"));
  };
  bad("1,0.02,oops,0.04,0.02", "1,0.02,,,,");
  bad("2,0.02,0.03,0.04", ",,,,,");
  bad("3,0.02,0.03,\"0.04,0.02", ",,,,,");
  bad(std::string("4,0.02,0.03\0,0.04,0.02", 23), ",,,,,");
  follower.Write("5" + good_);
  EXPECT_THAT(follower.Read(), StartsWith("5,0.02,0.03,0.04,0.02,"));
  follower.CloseInput();
  EXPECT_EQ(follower.Wait(), 0);
  std::istringstream errors(follower.Errors());
  std::string line;
  for (const char* expected :
       {"warning: the finger is not calibrated",
        "stdin:2:3: gauge_2_V: expected a number, found 'oops'",
        "stdin:3: expected 5 cells as in the header, found 4",
        "stdin:4:4: a quoted cell does not end on its line",
        "stdin:5:3: gauge_2_V: the cell holds a NUL byte", "over 5 frames"}) {
    std::getline(errors, line);
    EXPECT_THAT(line, HasSubstr(expected));
  }
}

// In a batch, too: the run goes on behind a reading that no gauge gives.
TEST_F(FollowTest, ImpossibleReadingsAreBadInput) {
  folder_.Write("scene.yaml", "contacts: auto\n");
  const std::string readings[] = {"inf", "-inf", "9.9E+37", "1e400", "-50"};
  std::string log = header_;
  for (int i = 0; i < 10; ++i) {
    log += std::to_string(i) +
           (i % 2 == 0 ? ",0.0214,0.0321,0.0362,0.0304\n"
                       : ",0.0214," + readings[i / 2] + ",0.0362,0.0304\n");
  }
  folder_.Write("log.csv", log);
  const Outcome batch =
      Run("finray_estimate", "--finger " + paper_ +
                                 " --scene %scene.yaml --logs %log.csv "
                                 "--out_dir %out");
  EXPECT_EQ(batch.code, 0) << batch.output;
  EXPECT_THAT(batch.output, HasSubstr("0 not_converged, 5 bad_input"));
  const FrameTable found = FrameTable::Read(folder_.Path("out/log.frames.csv"));
  Follower follower = Start();
  follower.Write(log);
  follower.CloseInput();
  const FrameTable live =
      FrameTable::Read(folder_.Write("live.csv", follower.ReadAll()));
  EXPECT_EQ(follower.Wait(), 0);
  ASSERT_EQ(found.rows(), 10u);
  ASSERT_EQ(live.rows(), 10u);
  for (std::size_t row = 0; row < 10; ++row) {
    EXPECT_EQ(found.Text("status")[row] == "bad_input", row % 2 == 1) << row;
    EXPECT_EQ(live.Text("status")[row], found.Text("status")[row]) << row;
    EXPECT_EQ(std::isnan(found.Numbers("normal_1_N")[row]), row % 2 == 1);
  }
}

TEST_F(FollowTest, NoneOrOne) {
  const std::filesystem::path shared =
      FINRAY_SOURCE_DIR "/../shared/cases/none_or_one/";
  if (!std::filesystem::exists(shared)) GTEST_SKIP() << "no " << shared;
  std::ifstream file(shared / "Sa.yaml");
  std::ostringstream scene;
  scene << file.rdbuf() << "\nmost_contacts: 1\n";
  folder_.Write("scene.yaml", scene.str());
  const Outcome outcome =
      Run("finray_estimate", "--finger " + (shared / "finger.yaml").string() +
                                 " --scene %scene.yaml --logs " +
                                 (shared / "free_then_touch.csv").string() +
                                 " --out_dir %out");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("ok             174, no_contact 618"));
}

TEST_F(FollowTest, ASearchThatIsEndedSaysSo) {
  folder_.Write("scene.yaml", "contacts: 2\nsearch_iteration_limit: 1\n");
  Follower follower = Start();
  follower.Write(header_ + "1" + good_ + "2" + good_);
  follower.CloseInput();
  const FrameTable table =
      FrameTable::Read(folder_.Write("live.csv", follower.ReadAll()));
  EXPECT_EQ(follower.Wait(), 0);
  EXPECT_THAT(table.Numbers("search_ended"), testing::ElementsAre(1, 1));
  EXPECT_THAT(
      follower.Errors(),
      HasSubstr("\nsearches       2 ended by the scene's limit of 1\n"));
}

TEST_F(FollowTest, StrictEndsAtAMalformedLine) {
  Follower follower = Start({"--strict"});
  follower.Write(header_ + "1" + good_ + "2,x,1,1,1\n3" + good_);
  follower.CloseInput();
  const std::string rows = follower.ReadAll();
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 2);
  EXPECT_EQ(follower.Wait(), 2);
  EXPECT_EQ(follower.Errors(),
            std::string(kNotCalibrated) +
                "finray_estimate: stdin:3:2: gauge_1_V: expected a number, "
                "found 'x'\n");
}

TEST_F(FollowTest, UnexplainedRowsAreLoudAtTheEnd) {
  folder_.Write("scene.yaml", "contacts: 0\n");
  Follower follower = Start({"--strict"});
  follower.Write(header_ + "1" + good_ + "2" + good_ + "3" + good_);
  follower.CloseInput();
  follower.ReadAll();
  EXPECT_EQ(follower.Wait(), 4);
  EXPECT_THAT(follower.Errors(),
              HasSubstr("\nwarning: likeliest cause: the finger is not "
                        "calibrated; 3 of 3 solved frames of stdin are not "
                        "explained"));
}

TEST_F(FollowTest, ABadHeaderIsBadInput) {
  const auto bad = [&](const std::string& text, const std::string& message) {
    Follower follower = Start();
    follower.Write(text);
    follower.CloseInput();
    EXPECT_EQ(follower.ReadAll(), "");
    EXPECT_EQ(follower.Wait(), 2);
    EXPECT_EQ(follower.Errors(), "finray_estimate: " + message + "\n");
  };
  bad("", "stdin: is empty, expected a header and rows");
  bad("a,a\n", "stdin:1:2: header 'a' appears twice");
  bad("#\n1,2\n", "stdin:2: expected a header, found numbers only");
  bad("gauge_1_V,gauge_2_V,gauge_3_V,gauge4_V\n",
      "stdin: no column 'gauge_4_V' (did you mean 'gauge4_V'?)");
}

TEST_F(FollowTest, EndsWithItsReader) {
  Follower follower = Start();
  follower.Write(header_ + "1" + good_);
  follower.Read();
  follower.Read();
  follower.CloseOutput();
  follower.Write("2" + good_);
  EXPECT_EQ(follower.Wait(), 0);
  EXPECT_THAT(follower.Errors(), EndsWith("over 1 frames\n"));
}

TEST_F(FollowTest, SignalsEndIt) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Follower follower = Start();
    follower.Write(header_ + "1" + good_);
    follower.Read();
    follower.Read();
    follower.Signal(signal);
    EXPECT_EQ(follower.Wait(), 0);
    EXPECT_THAT(follower.Errors(), EndsWith("over 1 frames\n"));
  }
  // Also before the header, and while nobody reads.
  Follower silent = Start();
  Follower unread = Start();
  unread.Write(header_);
  unread.Read();
  for (int i = 0; i < 500; ++i) unread.Write("1" + good_);
  usleep(300000);  // more rows than a pipe holds
  for (Follower* follower : {&silent, &unread}) {
    follower->Signal(SIGINT);
    EXPECT_EQ(follower->Wait(), 0);
  }
}

TEST_F(FollowTest, FlagsOfABatchAreRefused) {
  for (const std::string flag :
       {"logs", "logs_root", "out_dir", "resume", "threads", "keep_going"}) {
    const bool takes_none = flag == "resume" || flag == "keep_going";
    const Outcome outcome =
        Run("finray_estimate", "--follow --finger " + paper_ + " --" + flag +
                                   (takes_none ? "" : " 1"));
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.output, "finray_estimate: --" + flag +
                                  " does not go with --follow; see --help\n");
  }
}

TEST_F(FollowTest, TheExampleOfTheDocs) {
  std::ostringstream docs, example;
  docs << std::ifstream(FINRAY_SOURCE_DIR "/docs/guides/sense_live.md").rdbuf();
  example << std::ifstream(FINRAY_SOURCE_DIR "/examples/cpp/live_contact.cc")
                 .rdbuf();
  ASSERT_THAT(example.str(), Not(testing::IsEmpty()));
  EXPECT_THAT(docs.str(), HasSubstr("```cpp\n" + example.str() + "```\n"));

  folder_.Write("in.csv", "contact_1_mm,normal_1_N\n62,3\n");
  const std::string three_gauges =
      FINRAY_SOURCE_DIR "/configs/fingers/printed_100mm.yaml";
  for (const std::string& finger : {paper_, three_gauges}) {
    ASSERT_EQ(Run("finray_simulate",
                  "--finger " + finger + " --frames %in.csv --out %out.csv")
                  .code,
              0);
    const FrameTable frame = FrameTable::Read(folder_.Path("out.csv"));
    std::ostringstream volts;
    volts.precision(9);
    for (std::size_t j = 1; j <= ReadFinger(finger).gauges.size(); ++j) {
      volts << frame.Numbers("gauge_" + std::to_string(j) + "_V")[0] << " ";
    }
    folder_.Write("volts", volts.str() + "\n" + volts.str() + "\n");
    const Outcome outcome = Run("live_contact", finger + " < %volts");
    double arc = 0, force = 0;
    EXPECT_EQ(
        std::sscanf(outcome.output.c_str(), "ok %lf mm %lf N", &arc, &force), 2)
        << outcome.output;
    EXPECT_NEAR(arc, 62, 0.05);
    EXPECT_NEAR(force, 3, 0.01);
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'),
              2);
  }
}

}  // namespace
}  // namespace finray
