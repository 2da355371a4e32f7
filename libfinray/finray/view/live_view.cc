#include "finray/view/live_view.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "finray/finger/finger_yaml.h"
#include "finray/view/page_text.h"

namespace finray {

LiveView::LiveView(const Finger& finger, const Scene& scene,
                   const Discretization& discretization, double updates_Hz,
                   const ServeSettings& settings, LiveZero::Make make)
    : feed_(finger.gauges.size()),
      updates_(finger, discretization, scene.friction_coefficient),
      zero_(finger, discretization, std::move(make),
            scene.friction_coefficient),
      server_(settings,
              {LogPageText(finger.name, updates_.PageJson(finger.name)),
               [this] { return zero_.Request() + "\n"; },
               [this] {
                 return FingerToYaml(
                     zero_.finger(),
                     "Of finray_estimate --follow --serve. " + zero_.message());
               }},
              &hub_),
      publisher_([this, updates_Hz] { Publish(updates_Hz); }) {}

LiveView::~LiveView() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  end_.notify_all();
  publisher_.join();
  hub_.Close();
}

void LiveView::Publish(double updates_Hz) {
  using Clock = std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1 / updates_Hz));
  std::string message;
  Clock::time_point next = Clock::now();
  // The last pass begins after the end, so it takes the last row.
  for (bool ended = false; !ended;) {
    next = std::max(next + period, Clock::now());
    {
      std::unique_lock<std::mutex> lock(mutex_);
      ended = end_.wait_until(lock, next, [this] { return ending_; });
    }
    if (std::string news = zero_.message(); news != message) {
      message = std::move(news);
      updates_.set_gauges(zero_.finger().gauges);
    }
    std::string update = updates_.Next(&feed_, message, zero_.busy());
    if (!update.empty()) hub_.Publish(std::move(update));
  }
}

}  // namespace finray
