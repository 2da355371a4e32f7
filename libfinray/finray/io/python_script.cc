#include "finray/io/python_script.h"

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>

#include "finray/io/error.h"
#include "finray/io/resources.h"

extern char** environ;

namespace finray {

std::string RunPythonScript(const std::string& script,
                            const std::vector<std::string>& arguments,
                            const std::string& packages) {
  // -B: no __pycache__ is left in an installation.
  std::vector<std::string> words = {"/usr/bin/python3", "-B"};
  try {
    words.push_back(ResourcePath(script));
  } catch (const InputError& error) {
    return error.what();
  }
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child;
  const int error =
      posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ);
  if (error != 0) return words[0] + ": " + std::strerror(error);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  return script + " failed; are " + packages + " installed?";
}

}  // namespace finray
