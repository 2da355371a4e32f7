#include "finray/io/python_script.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "finray/io/error.h"
#include "finray/io/message_text.h"
#include "finray/io/resources.h"

extern char** environ;

namespace finray {

namespace {

constexpr std::size_t kMostErrors = 1 << 16;

// Returns what is written into a pipe until its other ends are closed, as far
// as it is kept.
std::string ReadToEnd(int pipe) {
  std::string text;
  char buffer[1 << 12];
  for (;;) {
    const ssize_t n = read(pipe, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(n));
    if (text.size() > kMostErrors) text.erase(0, text.size() - kMostErrors);
  }
}

std::string LastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

// Runs a script. With `errors`, what it writes on stderr goes there.
int Run(const std::string& script, const std::vector<std::string>& arguments,
        std::string* errors) {
  // -B: no __pycache__ is left in an installation.
  std::vector<std::string> words = {"/usr/bin/python3", "-B",
                                    ResourcePath(script)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int ends[2] = {-1, -1};
  if (errors != nullptr && pipe2(ends, O_CLOEXEC) != 0) return -1;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (errors != nullptr) {
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  }
  pid_t child;
  const bool spawned = posix_spawn(&child, argv[0], &actions, nullptr,
                                   argv.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  if (errors != nullptr) {
    close(ends[1]);
    if (spawned) *errors = ReadToEnd(ends[0]);
    close(ends[0]);
  }
  if (!spawned) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

int RunPython(const std::string& script,
              const std::vector<std::string>& arguments) {
  return Run(script, arguments, nullptr);
}

std::string RunPythonScript(const std::string& script,
                            const std::vector<std::string>& arguments,
                            const std::string& packages) {
  constexpr int kBadInput = 2;
  constexpr char kCannotWrite[] = ": cannot be written: ";  // whole_file.py
  std::string errors;
  int code = 0;
  try {
    code = Run(script, arguments, &errors);
  } catch (const InputError& error) {  // the script is missing
    return error.what();
  }
  const std::string reason = ShownLine(LastLine(errors));
  if (code == kBadInput && reason.find(kCannotWrite) != reason.npos) {
    throw InputError(reason);
  }
  if (code == 0) {
    std::fputs(errors.c_str(), stderr);
    return "";
  }
  return script + " failed" + (reason.empty() ? "" : ": " + reason) + "; are " +
         packages + " installed?";
}

}  // namespace finray
