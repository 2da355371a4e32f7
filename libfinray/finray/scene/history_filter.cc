#include "finray/scene/history_filter.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/possible_reading.h"
#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"

namespace finray {
namespace {

// The std of a stage, where the scene does not state one.
constexpr double kUsualObjectStd_mm = 0.05;

bool Creeps(const Gauge& gauge) { return gauge.creep_share != 0; }
bool HasPlay(const Gauge& gauge) { return gauge.hysteresis_rad != 0; }

}  // namespace

HistoryFilter::HistoryFilter(const Finger& finger, const Scene& scene)
    : change_(finger.gauges),
      play_(std::any_of(finger.gauges.begin(), finger.gauges.end(), HasPlay)) {
  if (scene.object && scene.presliding_mm && scene.friction_coefficient > 0 &&
      !scene.smoothing) {
    sliding_.reset(new Sliding{
        EquilibriumSolver(finger, {}),
        SlidingFriction(*scene.object, scene.friction_coefficient,
                        *scene.presliding_mm,
                        scene.object_std_mm.value_or(kUsualObjectStd_mm))});
  }
  if (!play_ &&
      std::none_of(finger.gauges.begin(), finger.gauges.end(), Creeps)) {
    return;
  }
  gauges_ = finger.gauges;
  for (const Gauge& gauge : gauges_) {
    lags_.emplace_back(gauge.creep_share, gauge.creep_time_constant_s);
    plays_.emplace_back(gauge.HysteresisV() / gauge.noise_V);
  }
}

void HistoryFilter::Remove(Measurements* row) {
  if (sliding_) {
    row->friction =
        sliding_->friction
            .Next({row->object_mm, row->object_angle_rad}, &sliding_->solver)
            .value_or(Measurements::kNotMeasured);
  }
  // The estimator refuses such a row, and the next ones must not remember it.
  if (!ArePossible(gauges_, row->gauges_V)) return;
  const double moved2 = play_ ? change_.Next(row->gauges_V) : 0;
  if (play_) row->history_std_V.assign(gauges_.size(), 0);
  for (std::size_t j = 0; j < gauges_.size(); ++j) {
    const Gauge& gauge = gauges_[j];
    double& volts = row->gauges_V[j];
    if (!gauge.IsInRange(volts)) continue;
    if (Creeps(gauge)) {
      volts -= gauge.creep_share *
               lags_[j].Next(row->time_s, volts - gauge.offset_V);
    }
    if (!HasPlay(gauge)) continue;
    plays_[j].Next(volts / gauge.noise_V, moved2);
    volts += gauge.noise_V * plays_[j].mean();
    row->history_std_V[j] = gauge.noise_V * std::sqrt(plays_[j].variance());
  }
}

void HistoryFilter::Restart() {
  for (GaugeLag<double>& lag : lags_) lag.Restart();
  for (PlayBelief<double>& play : plays_) play.Restart();
  change_.Restart();
  if (sliding_) sliding_->friction.Lift();
}

bool HasCreep(const Finger& finger) {
  return std::any_of(finger.gauges.begin(), finger.gauges.end(), Creeps);
}

void RequireTimeForCreep(const Finger& finger,
                         const std::vector<std::string>& names,
                         const std::string& path) {
  if (!HasCreep(finger) ||
      std::find(names.begin(), names.end(), "time_s") != names.end()) {
    return;
  }
  throw InputError(path + ": " + NoColumn("time_s", names) +
                   "; the creep of the finger's gauges needs it");
}

}  // namespace finray
