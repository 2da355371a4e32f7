#ifndef FINRAY_TESTS_APPS_BATCH_FIXTURE_H_
#define FINRAY_TESTS_APPS_BATCH_FIXTURE_H_

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "apps/command_line.h"

namespace finray {

/// A folder with logs for finray_estimate, and ways to run it.
class BatchTest : public CommandLineTest {
 protected:
  BatchTest() {
    // Frames cost next to nothing: what is tested is what is around them.
    folder_.Write("scene.yaml", "contacts: 0\n");
    std::filesystem::create_directory(folder_.Path("runs"));
  }

  // Of a free finger, or of one that bends as no scene of ours explains.
  enum class Readings { kFree, kBent };

  void WriteLog(const std::string& name, int frames, int seed,
                Readings readings = Readings::kBent) {
    std::ofstream log(folder_.Path(name));
    log << "time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,force_N,note\n";
    for (int i = 0; i < frames; ++i) {
      const int v = (i * 37 + seed) % 1000;
      if (readings == Readings::kFree) {
        log << i << ",0,0,0,0," << v * 1e-3 << ",n" << v << "\n";
        continue;
      }
      log << i << "," << v * 1e-5 << ",0.00" << v % 97 << ",0.01,"
          << (v % 50 == 0 ? "" : "0.001") << "," << v * 1e-3 << ",n" << v
          << "\n";
    }
  }

  // Arguments for the logs of the folder.
  std::string Arguments(const std::string& logs, const std::string& more) {
    return "--finger " + paper_ + " --scene %scene.yaml --logs " + logs +
           " --threads 2 " + more;
  }

  std::map<std::string, std::string> Files(const std::string& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(folder_.Path(folder))) {
      const std::string name = entry.path().filename().string();
      // Temporaries of small files that a kill has hit.
      if (name.rfind(".finray-", 0) == 0) continue;
      files[name] = folder_.Read(folder + "/" + name);
    }
    return files;
  }

  // A process of the executable, silent.
  pid_t Start(const std::vector<std::string>& arguments) {
    std::vector<char*> argv;
    std::vector<std::string> all = {FINRAY_BINARY_DIR "/finray_estimate"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    for (std::string& argument : all) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      const int log = open(folder_.Path("stderr").c_str(),
                           O_WRONLY | O_CREAT | O_TRUNC, 0666);
      dup2(log, STDOUT_FILENO);
      dup2(log, STDERR_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
    return child;
  }

  std::vector<std::string> ArgumentsOf(const std::string& logs,
                                       const std::string& out) {
    return {"--finger",  paper_,
            "--scene",   folder_.Path("scene.yaml"),
            "--logs",    folder_.Path(logs),
            "--out_dir", folder_.Path(out),
            "--threads", "2"};
  }

  static int ExitCode(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
};

}  // namespace finray

#endif  // FINRAY_TESTS_APPS_BATCH_FIXTURE_H_
