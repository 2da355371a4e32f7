#include "finray/calib/analysis/force_check.h"

#include <algorithm>
#include <cmath>

#include "finray/batch/batch_estimation.h"

namespace finray {

Measurements GaugesOnly(const CalibrationFrame& frame) {
  Measurements readings;
  readings.gauges_V = frame.gauges_V;
  if (frame.IsBench()) {
    readings.gauges_V.assign(frame.gauges_V.size(), std::nan(""));
  }
  return readings;
}

ForceCheck CheckForces(const Finger& before, const Finger& after,
                       const Plan& plan, const CalibrationLogs& logs,
                       const CalibrationLogs& corrected,
                       const Discretization& discretization, int threads) {
  // A calibration's frames have one contact or none.
  Scene scene = plan.scene;
  scene.most_contacts = 1;
  scene.pin_std_mm = scene.tip_std_mm = std::nullopt;
  const auto estimate = [&](const Finger& finger, const CalibrationLogs& of) {
    std::vector<Measurements> readings;
    for (const CalibrationFrame& frame : of.frames) {
      readings.push_back(GaugesOnly(frame));
    }
    return EstimateFrames(finger, scene, discretization, readings, threads);
  };
  ForceCheck check;
  check.before.resize(logs.frames.size());
  check.has_before.assign(logs.frames.size(), false);
  // A contact has two unknowns, so fewer than two gauges give no estimate.
  if (before.gauges.size() < 2) {
    check.after.resize(logs.frames.size());
    return check;
  }
  const std::size_t some =
      std::min(logs.frames.size(), ForceCheck::kMostBefore);
  CalibrationLogs spread{logs.paths, logs.names, {}};
  for (std::size_t k = 0; k < some; ++k) {
    const std::size_t i = k * logs.frames.size() / some;
    check.has_before[i] = true;
    spread.frames.push_back(logs.frames[i]);
  }
  std::size_t next = 0;
  for (FrameEstimate& was : estimate(before, spread)) {
    while (!check.has_before[next]) ++next;
    check.before[next++] = std::move(was);
  }
  check.after = estimate(after, corrected);
  const double per_normal = std::hypot(1, plan.scene.friction_coefficient);
  for (std::size_t i = 0; i < logs.frames.size(); ++i) {
    const double force = ReferenceForce(corrected.frames[i]);
    const double was = per_normal * check.before[i].contact[0].normal_N - force;
    const double is = per_normal * check.after[i].contact[0].normal_N - force;
    ForceCheck::Error& error =
        logs.frames[i].held_out ? check.held_out : check.fitted;
    if (!std::isnan(was)) {
      ++error.frames_before;
      error.before_rms_N += was * was;
    }
    if (std::isnan(is)) continue;
    ++error.frames;
    error.after_rms_N += is * is;
    error.after_max_N = std::max(error.after_max_N, std::abs(is));
    error.reference_mean_N += force;
  }
  for (ForceCheck::Error* error : {&check.fitted, &check.held_out}) {
    if (error->frames_before > 0) {
      error->before_rms_N = std::sqrt(
          error->before_rms_N / static_cast<double>(error->frames_before));
    }
    if (error->frames == 0) continue;
    const auto n = static_cast<double>(error->frames);
    error->after_rms_N = std::sqrt(error->after_rms_N / n);
    error->reference_mean_N /= n;
  }
  return check;
}

}  // namespace finray
