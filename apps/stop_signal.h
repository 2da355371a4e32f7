#ifndef FINRAY_APPS_STOP_SIGNAL_H_
#define FINRAY_APPS_STOP_SIGNAL_H_

#include <csignal>

namespace finray {

/// SIGINT and SIGTERM as a request to come to an end; a second one ends the
/// process at once.
class StopSignal {
 public:
  static void Install() {
    struct sigaction action = {};
    action.sa_handler = [](int) { requested_ = 1; };
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
  }
  static bool Requested() { return requested_ != 0; }

 private:
  static inline volatile std::sig_atomic_t requested_ = 0;
};

}  // namespace finray

#endif  // FINRAY_APPS_STOP_SIGNAL_H_
