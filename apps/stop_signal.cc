#include "stop_signal.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace finray {
namespace {

volatile std::sig_atomic_t requested = 0;
volatile std::sig_atomic_t wake = -1;

void InstallWith(int flags) {
  struct sigaction action = {};
  action.sa_handler = [](int) {
    requested = 1;
    const int error = errno;
    if (wake >= 0 && write(wake, "", 1) < 0) errno = error;
  };
  action.sa_flags = flags | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void StopSignal::Install() { InstallWith(SA_RESTART); }

int StopSignal::InstallWaking() {
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) == 0) wake = ends[1];
  InstallWith(0);
  return ends[0];
}

bool StopSignal::Requested() { return requested != 0; }

}  // namespace finray
