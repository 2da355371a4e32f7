#include "follow_input.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include "app.h"
#include "finray/batch/estimation_warnings.h"
#include "finray/io/log_lines.h"
#include "finray/view/live_view.h"

namespace finray {
namespace {

// Writes to standard output. Returns false if nobody reads it, or if told to
// stop while it waits for a reader.
bool WriteLive(std::string_view text, const FollowSettings& follow) {
  while (!text.empty()) {
    const ssize_t count = write(STDOUT_FILENO, text.data(), text.size());
    if (count >= 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EPIPE || (errno == EINTR && follow.stop())) {
      return false;
    } else if (errno != EINTR) {
      throw InputError("the rows of " + follow.source +
                       " cannot be written: " + std::strerror(errno));
    }
  }
  return true;
}

// Reads up to the header of `log`. Returns false if it was stopped before.
bool ReadHeader(const ColumnMapping& columns, const FollowSettings& follow,
                std::optional<LogLines>* log) {
  try {
    log->emplace(
        LineReader(follow.read ? follow.read
                               : PipeBytes(STDIN_FILENO, follow.stop_file,
                                           follow.source),
                   follow.source),
        follow.source, columns);
    return true;
  } catch (const InputError&) {
    if (follow.stop()) return false;
    throw;
  }
}

std::unique_ptr<LiveView> Serve(const BatchSettings& settings,
                                const FollowSettings& follow,
                                LiveZero::Make make) {
  if (!follow.serve) return nullptr;
  auto view = std::make_unique<LiveView>(
      settings.finger, settings.scene, settings.discretization,
      follow.updates_Hz, *follow.serve, std::move(make));
  const std::string& address = follow.serve->address;
  const bool is_ipv6 = address.find(':') != std::string::npos;
  const std::string host = is_ipv6 ? "[" + address + "]" : address;
  const std::string token =
      follow.serve->token.empty() ? "" : "?token=" + follow.serve->token;
  std::fprintf(stderr, "live page      http://%s:%d/%s\n", host.c_str(),
               view->port(), token.c_str());
  return view;
}

}  // namespace

void PrintLatency(const char* label, const LatencyHistogram& latency) {
  const auto us = [&](double share) { return 1e-3 * latency.Quantile(share); };
  std::fprintf(stderr,
               "%-14s p50 %.1f us, p99 %.1f us, p99.9 %.1f us, max %.1f us, "
               "over %llu frames\n",
               label, us(0.5), us(0.99), us(0.999),
               1e-3 * static_cast<double>(latency.max()),
               static_cast<unsigned long long>(latency.count()));
}

void PrintEnded(const char* label, const EstimationSummary& summary,
                const Scene& scene, std::FILE* out) {
  if (!scene.search_iteration_limit) return;
  std::fprintf(out, "%-14s %zu ended by the scene's limit of %d\n", label,
               summary.search_ended, *scene.search_iteration_limit);
}

namespace {

// Warns, once, of a touch that lasts so long that offsets may have drifted,
// where the scene does not say how far.
class LongTouch {
 public:
  explicit LongTouch(const Scene& scene)
      : warned_(scene.gauge_offset_walk.has_value()) {}

  void Add(const FrameEstimate& estimate, double time_s) {
    if (warned_ || std::isnan(time_s)) return;
    if (estimate.contacts == 0 || !(time_s >= since_s_)) since_s_ = time_s;
    if (time_s - since_s_ < kLong_s) return;
    warned_ = true;
    Warn(
        "a touch lasts a minute, and offsets that drift under it read like a "
        "force",
        "say in the scene how much they wander, gauge_offset_walk");
  }

 private:
  static constexpr double kLong_s = 60;
  bool warned_;
  double since_s_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

std::optional<Followed> FollowInput(const BatchSettings& settings,
                                    const FollowSettings& follow) {
  using Clock = std::chrono::steady_clock;
  std::optional<LogLines> log;
  if (!ReadHeader(settings.scene.columns, follow, &log)) return {};
  LogLines& lines = *log;
  const auto with = [&](std::unique_ptr<FrameEstimator> estimator) {
    return std::make_unique<LiveEstimator>(std::move(estimator), settings.scene,
                                           lines.parser(), settings.format);
  };
  const LiveZero::Make make = [&](const Finger& finger) {
    return with(std::make_unique<FrameEstimator>(
        finger, settings.scene, settings.discretization, settings.method));
  };
  std::unique_ptr<LiveEstimator> live =
      follow.prepared ? with(follow.prepared->ForAnotherThread())
                      : make(settings.finger);
  const std::unique_ptr<LiveView> view = Serve(settings, follow, make);
  std::optional<Followed> followed(std::in_place);
  if (follow.warn_of_finger) Warn(WarningsOf(settings.finger, settings.scene));
  const auto write = [&](std::string_view row) {
    return follow.write ? follow.write(row) : WriteLive(row, follow);
  };
  LongTouch long_touch(settings.scene);
  bool open = write(live->rows.HeaderCsv());
  while (open && !follow.stop() && lines.Next()) {
    const Clock::time_point start = Clock::now();
    LiveRows& rows = live->rows;
    const std::string& row = rows.Next(lines.line());
    if (!rows.error().empty()) {
      if (follow.strict) throw InputError(rows.error());
      std::fprintf(stderr, "finray_estimate: %s\n", rows.error().c_str());
    }
    open = write(row);
    const auto taken = static_cast<std::uint64_t>(
        std::chrono::nanoseconds(Clock::now() - start).count());
    if (open) followed->latency.Add(taken);
    followed->summary.Add(rows.estimate(), settings.scene.friction_coefficient,
                          rows.readings(), settings.finger);
    long_touch.Add(rows.estimate(), rows.readings().time_s);
    if (!view) continue;
    view->Push(rows, taken);
    if (auto zeroed = view->TakeZeroed()) {
      live = std::move(zeroed);
      std::fprintf(stderr, "%s\n", view->message().c_str());
    }
  }
  return followed;
}

}  // namespace finray
