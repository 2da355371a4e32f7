#include "finray/io/python_script.h"

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>

#include "finray/io/error.h"
#include "finray/io/resources.h"

extern char** environ;

namespace finray {

int RunPython(const std::string& script,
              const std::vector<std::string>& arguments) {
  // -B: no __pycache__ is left in an installation.
  std::vector<std::string> words = {"/usr/bin/python3", "-B",
                                    ResourcePath(script)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child;
  if (posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ) !=
      0) {
    return -1;
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string RunPythonScript(const std::string& script,
                            const std::vector<std::string>& arguments,
                            const std::string& packages) {
  try {
    if (RunPython(script, arguments) == 0) return "";
  } catch (const InputError& error) {
    return error.what();
  }
  return script + " failed; are " + packages + " installed?";
}

}  // namespace finray
