#ifndef FINRAY_TESTS_APPS_COMMAND_LINE_H_
#define FINRAY_TESTS_APPS_COMMAND_LINE_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "temp_file.h"

namespace finray {

struct Outcome {
  int code;
  std::string output;  // both streams
};

class CommandLineTest : public testing::Test {
 protected:
  // `%` in the arguments stands for the test's folder.
  Outcome Run(const std::string& app, std::string arguments) {
    for (std::size_t at; (at = arguments.find('%')) != std::string::npos;) {
      arguments.replace(at, 1, folder_.Path(""));
    }
    const std::string command =
        FINRAY_BINARY_DIR "/" + app + " " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    Outcome outcome;
    std::array<char, 4096> buffer;
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) {
      outcome.output += buffer.data();
    }
    const int status = pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
  }

  // Exit code 2, one line that says `message`, and no output file.
  void ExpectBadInput(const std::string& app, const std::string& arguments,
                      const std::string& message) {
    const Outcome outcome = Run(app, arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_THAT(outcome.output, testing::HasSubstr(message));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1)
        << outcome.output;
    EXPECT_FALSE(std::filesystem::exists(folder_.Path("out")));
  }

  const std::string paper_ =
      FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml";
  const std::string plan_ =
      FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml";
  const std::string data_ = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";
  TempFolder folder_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_APPS_COMMAND_LINE_H_
