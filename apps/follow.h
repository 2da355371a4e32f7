#ifndef FINRAY_APPS_FOLLOW_H_
#define FINRAY_APPS_FOLLOW_H_

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

#include "app.h"
#include "finray/batch/latency_histogram.h"
#include "finray/batch/live_rows.h"
#include "finray/io/file_descriptor.h"
#include "finray/io/line_reader.h"
#include "stop_signal.h"

namespace finray {

/// Runs `finray_estimate --follow`: it reads a log from standard input and
/// writes each row to standard output at once. It ends with its input, with a
/// stop signal, or when nobody reads its output any more. Then it says how long
/// the rows have taken, from having the whole line to having written its row.
class Follow {
 public:
  Follow(const Finger& finger, const Scene& scene,
         const Discretization& discretization, FrameMethod method, bool strict)
      : finger_(finger),
        scene_(scene),
        discretization_(discretization),
        method_(method),
        strict_(strict) {}

  int Run() {
    std::signal(SIGPIPE, SIG_IGN);
    LineReader lines =
        ReadPipe(STDIN_FILENO, StopSignal::InstallWaking(), kSource);
    LiveEstimator estimator(finger_, scene_, discretization_, method_);
    CsvLine header;
    do {
      if (!lines.Next()) return NoHeader();
      header = lines.line();
    } while (!IsHeaderLine(&header));
    LiveRows rows(finger_, scene_, kSource, header, &estimator);
    bool open = Write(rows.HeaderCsv());
    while (open && !StopSignal::Requested() && lines.Next()) {
      const Clock::time_point start = Clock::now();
      const std::string& row = rows.Next(lines.line());
      if (!rows.error().empty()) {
        if (strict_) throw InputError(rows.error());
        std::cerr << "finray_estimate: " << rows.error() << "\n";
      }
      open = Write(row);
      if (open) latency_.Add(Nanoseconds(Clock::now() - start));
      unsolved_ += rows.status() == FrameStatus::kNotConverged ||
                   rows.status() == FrameStatus::kBadInput;
    }
    PrintLatency();
    return strict_ && unsolved_ > 0 ? kSolveFailed : kGood;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr char kSource[] = "stdin";

  static std::uint64_t Nanoseconds(Clock::duration time) {
    return static_cast<std::uint64_t>(std::chrono::nanoseconds(time).count());
  }

  static int NoHeader() {
    if (StopSignal::Requested()) return kGood;
    throw InputError(std::string(kSource) +
                     ": is empty, expected a header and rows");
  }

  // Returns false if nobody reads the output, or if told to stop while it waits
  // for a reader.
  static bool Write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t count = write(STDOUT_FILENO, text.data(), text.size());
      if (count >= 0) {
        text.remove_prefix(static_cast<std::size_t>(count));
      } else if (errno == EPIPE ||
                 (errno == EINTR && StopSignal::Requested())) {
        return false;
      } else if (errno != EINTR) {
        throw InputError(std::string("stdout: cannot be written: ") +
                         std::strerror(errno));
      }
    }
    return true;
  }

  void PrintLatency() const {
    const auto us = [this](double share) {
      return 1e-3 * latency_.Quantile(share);
    };
    std::fprintf(stderr,
                 "latency        p50 %.1f us, p99 %.1f us, p99.9 %.1f us, max "
                 "%.1f us, over %llu frames\n",
                 us(0.5), us(0.99), us(0.999),
                 1e-3 * static_cast<double>(latency_.max()),
                 static_cast<unsigned long long>(latency_.count()));
  }

  const Finger& finger_;
  const Scene& scene_;
  Discretization discretization_;
  FrameMethod method_;
  bool strict_;
  LatencyHistogram latency_;
  std::size_t unsolved_ = 0;
};

}  // namespace finray

#endif  // FINRAY_APPS_FOLLOW_H_
