#include <algorithm>
#include <cmath>

#include "finray/scene/history_filter.h"
#include "inside.h"

namespace finray::v1 {
namespace {

Contact ToPublicContact(const ContactEstimate& contact) {
  return {contact.arc_mm,       contact.arc_std_mm,   contact.normal_N,
          contact.normal_std_N, contact.pose.x(),     contact.pose.y(),
          contact.pose.z(),     contact.arc_low_mm,   contact.arc_high_mm,
          contact.normal_low_N, contact.normal_high_N};
}

}  // namespace

struct LiveEstimator::Inside {
  Inside(const finray::Finger& finger, const finray::Scene& scene,
         const finray::Discretization& discretization, FrameMethod method)
      : estimator(finger, scene, discretization, method),
        history(finger, scene),
        offsets_wander(scene.gauge_offset_walk.has_value()) {
    estimator.Prepare();
  }

  FrameEstimator estimator;
  HistoryFilter history;
  bool offsets_wander;
  Measurements row;
  Frame frame;
};

LiveEstimator::LiveEstimator(const Finger& finger, const Scene& scene,
                             const EstimateOptions& options)
    : inside_(Guarded([&] {
        if (options.joint) {
          throw InputError("joint: does not go with live frames");
        }
        return std::make_unique<Inside>(
            finger.inside().finger, SceneOf(scene, true),
            ToInternal(options.discretization), MethodOf(options));
      })) {}
LiveEstimator::~LiveEstimator() = default;
LiveEstimator::LiveEstimator(LiveEstimator&&) noexcept = default;
LiveEstimator& LiveEstimator::operator=(LiveEstimator&&) noexcept = default;

const Frame& LiveEstimator::Next(const Readings& readings) {
  return Guarded([&]() -> const Frame& {
    const finray::Finger& finger = inside_->estimator.finger();
    if (readings.gauges_V.size() != finger.gauges.size()) {
      throw InputError("gauges_V: expected " +
                       std::to_string(finger.gauges.size()) +
                       " readings, one per gauge of the finger, found " +
                       std::to_string(readings.gauges_V.size()));
    }
    Measurements& row = inside_->row;
    row.gauges_V = readings.gauges_V;
    row.time_s = readings.time_s;
    row.object_mm = {readings.object_x_mm, readings.object_y_mm};
    row.object_angle_rad = readings.object_angle_deg * M_PI / 180;
    if (std::isnan(readings.time_s) && HasCreep(finger)) {
      throw InputError("time_s: is missing; gauges of the finger creep");
    }
    if (std::isnan(readings.time_s) && inside_->offsets_wander) {
      throw InputError(
          "time_s: is missing; the scene's gauge_offset_walk needs it");
    }
    if (!inside_->history.empty()) inside_->history.Remove(&row);
    const FrameEstimate& estimate = inside_->estimator.Next(row);
    Frame& frame = inside_->frame;
    frame.status = static_cast<FrameStatus>(estimate.status);
    frame.contacts = estimate.contacts;
    std::transform(estimate.contact.begin(), estimate.contact.end(),
                   frame.contact, ToPublicContact);
    frame.chi2 = estimate.chi2;
    frame.chi2_p_value = estimate.p_value();
    frame.tip_x_mm = estimate.tip_pose.x();
    frame.tip_y_mm = estimate.tip_pose.y();
    frame.tip_angle_rad = estimate.tip_pose.z();
    frame.iterations = estimate.iterations;
    frame.search_ended = estimate.search_ended;
    frame.ribs_N = estimate.rib_tension_N;
    return frame;
  });
}

void LiveEstimator::Restart() {
  inside_->estimator.Restart();
  inside_->history.Restart();
}

}  // namespace finray::v1
