#ifndef FINRAY_APPS_STOP_SIGNAL_H_
#define FINRAY_APPS_STOP_SIGNAL_H_

namespace finray {

/// Turns SIGINT and SIGTERM into a request to finish. A second signal ends the
/// process at once.
class StopSignal {
 public:
  /// Lets system calls go on after a signal.
  static void Install();

  /// Interrupts system calls, and returns a descriptor that is readable from
  /// the request on, for a poll() that must not miss it; -1 if there is none.
  static int InstallWaking();

  static bool Requested();
};

}  // namespace finray

#endif  // FINRAY_APPS_STOP_SIGNAL_H_
