#ifndef FINRAY_TESTS_TEMP_FILE_H_
#define FINRAY_TESTS_TEMP_FILE_H_

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace finray {

/// A folder of one test, removed with it. Tests run in parallel processes.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = testing::TempDir() + "finray_XXXXXX";
    path_ = mkdtemp(pattern.data());
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }

  std::string Path(const std::string& name) const { return path_ + "/" + name; }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name), std::ios::binary) << text;
    return Path(name);
  }
  std::string Read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(Path(name), std::ios::binary).rdbuf();
    return text.str();
  }

 private:
  std::string path_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_TEMP_FILE_H_
