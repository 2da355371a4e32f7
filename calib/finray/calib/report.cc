#include "finray/calib/report.h"

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>

extern char** environ;

namespace finray {

std::string RenderReport(const std::string& out_dir) {
  // Debian's interpreter by its path: the first on PATH may lack matplotlib.
  std::string python = "/usr/bin/python3";
  std::string script = FINRAY_REPORT_DIR "/render.py";
  std::string folder = out_dir;
  char* arguments[] = {python.data(), script.data(), folder.data(), nullptr};
  pid_t child;
  const int error =
      posix_spawn(&child, python.c_str(), nullptr, nullptr, arguments, environ);
  if (error != 0) return python + ": " + std::strerror(error);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  return script +
         " failed; are python3-matplotlib, python3-jinja2 and "
         "python3-yaml installed?";
}

}  // namespace finray
