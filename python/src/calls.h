#ifndef FINRAY_PYTHON_SRC_CALLS_H_
#define FINRAY_PYTHON_SRC_CALLS_H_

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "finray/error.h"

namespace finray_python {

/// Asks Python now and then whether the user has pressed Ctrl-C. Any thread may
/// ask; only the one that called from Python looks.
class StopOnSignal {
 public:
  bool operator()() {
    if (std::this_thread::get_id() != caller_) return signalled_;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return signalled_;
    last_ = now;
    const pybind11::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) signalled_ = true;
    return signalled_;
  }

 private:
  std::thread::id caller_ = std::this_thread::get_id();
  std::chrono::steady_clock::time_point last_ =
      std::chrono::steady_clock::now();
  std::atomic<bool> signalled_ = false;
};

/// Returns call(stop) without the lock of the interpreter. Ctrl-C makes `stop`
/// return true, and raises KeyboardInterrupt once the call has ended for it.
template <class Call>
auto CallWithoutGil(const Call& call) {
  StopOnSignal stop;
  const std::function<bool()> ask = [&stop] { return stop(); };
  try {
    const pybind11::gil_scoped_release release;
    return call(ask);
  } catch (const finray::Interrupted&) {
    throw pybind11::error_already_set();
  }
}

}  // namespace finray_python

#endif  // FINRAY_PYTHON_SRC_CALLS_H_
