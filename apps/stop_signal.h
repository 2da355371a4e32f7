#ifndef FINRAY_APPS_STOP_SIGNAL_H_
#define FINRAY_APPS_STOP_SIGNAL_H_

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace finray {

/// SIGINT and SIGTERM as a request to come to an end; a second one ends the
/// process at once.
class StopSignal {
 public:
  /// System calls go on.
  static void Install() { InstallWith(SA_RESTART); }

  /// System calls are interrupted, and the descriptor returned can be read from
  /// the request on, for a poll() that must not miss it; -1 if there is none to
  /// be had.
  static int InstallWaking() {
    int ends[2] = {-1, -1};
    if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) == 0) wake_ = ends[1];
    InstallWith(0);
    return ends[0];
  }

  static bool Requested() { return requested_ != 0; }

 private:
  static void InstallWith(int flags) {
    struct sigaction action = {};
    action.sa_handler = [](int) {
      requested_ = 1;
      const int error = errno;
      if (wake_ >= 0 && write(wake_, "", 1) < 0) errno = error;
    };
    action.sa_flags = flags | static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
  }

  static inline volatile std::sig_atomic_t requested_ = 0;
  static inline volatile std::sig_atomic_t wake_ = -1;
};

}  // namespace finray

#endif  // FINRAY_APPS_STOP_SIGNAL_H_
