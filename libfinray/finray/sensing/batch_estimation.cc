#include "finray/sensing/batch_estimation.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "finray/sensing/frame_columns.h"

namespace finray {
namespace {

// Volts of all gauges by row.
std::vector<std::vector<double>> ReadVolts(const Finger& finger,
                                           const FrameTable& log) {
  std::vector<std::vector<double>> volts(
      log.rows(), std::vector<double>(finger.gauges.size()));
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    const std::string name = GaugeVolts(static_cast<int>(j));
    const std::string angle_name = GaugeAngle(static_cast<int>(j));
    const bool angles = !log.Has(name) && log.Has(angle_name);
    const auto& column = log.Numbers(angles ? angle_name : name);
    for (std::size_t row = 0; row < log.rows(); ++row) {
      volts[row][j] = angles
                          ? gauge.gain_V_per_rad * column[row] + gauge.offset_V
                          : column[row];
    }
  }
  return volts;
}

double FiniteOrNan(double value) {
  return std::isfinite(value) ? value : std::nan("");
}

}  // namespace

std::vector<FrameEstimate> EstimateFrames(
    const Finger& finger, const Scene& scene,
    const Discretization& discretization,
    const std::vector<std::vector<double>>& readings_V, int threads) {
  std::vector<FrameEstimate> estimates(readings_V.size());
  // The first one is made here, where a bad scene or finger can be reported.
  auto first = std::make_unique<FrameEstimator>(finger, scene, discretization);
  if (threads <= 1) {
    for (std::size_t i = 0; i < readings_V.size(); ++i) {
      estimates[i] = first->Estimate(readings_V[i]);
    }
    return estimates;
  }
  tbb::enumerable_thread_specific<std::unique_ptr<FrameEstimator>> estimators;
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, readings_V.size(), 64),
        [&](const tbb::blocked_range<std::size_t>& range) {
          auto& estimator = estimators.local();
          if (!estimator) {
            estimator =
                std::make_unique<FrameEstimator>(finger, scene, discretization);
          }
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            estimates[i] = estimator->Estimate(readings_V[i]);
          }
        });
  });
  return estimates;
}

EstimationSummary EstimateLog(const Finger& finger, const Scene& scene,
                              const Discretization& discretization, int threads,
                              FrameTable* log) {
  const auto volts = ReadVolts(finger, *log);
  const std::vector<FrameEstimate> estimates =
      EstimateFrames(finger, scene, discretization, volts, threads);

  const auto fill = [&](const std::string& name, const auto& value) {
    std::vector<double>& column = log->MutableNumbers(name);
    for (std::size_t row = 0; row < estimates.size(); ++row) {
      column[row] = FiniteOrNan(value(estimates[row]));
    }
  };
  using E = const FrameEstimate&;
  fill(ContactArc(0), [](E e) { return e.contact_mm; });
  fill(ContactArcStd(0), [](E e) { return e.contact_std_mm; });
  fill(NormalForce(0), [](E e) { return e.normal_N; });
  fill(NormalForceStd(0), [](E e) { return e.normal_std_N; });
  if (scene.friction_coefficient != 0) {
    fill(Friction(0), [&](E e) {
      return std::isfinite(e.contact_mm) ? scene.friction_coefficient
                                         : std::nan("");
    });
  }
  fill(ContactX(0), [](E e) { return e.contact_pose.x(); });
  fill(ContactY(0), [](E e) { return e.contact_pose.y(); });
  fill(ContactAngle(0), [](E e) { return e.contact_pose.z(); });
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    std::vector<double>& column =
        log->MutableNumbers(GaugeAngle(static_cast<int>(j)));
    for (std::size_t row = 0; row < volts.size(); ++row) {
      column[row] = (volts[row][j] - gauge.offset_V) / gauge.gain_V_per_rad;
    }
  }
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    fill(RibForce(static_cast<int>(i)),
         [i](E e) { return e.rib_tension_N[i]; });
  }
  fill("tip_x_mm", [](E e) { return e.tip_pose.x(); });
  fill("tip_y_mm", [](E e) { return e.tip_pose.y(); });
  fill("tip_angle_rad", [](E e) { return e.tip_pose.z(); });
  fill("chi2", [](E e) { return e.chi2; });
  fill("iterations", [](E e) { return static_cast<double>(e.iterations); });

  EstimationSummary summary;
  summary.frames = estimates.size();
  std::vector<std::string>& status = log->MutableText("status");
  const std::vector<double> force = log->NumbersOrNan("force_N");
  const double per_normal = std::hypot(1, scene.friction_coefficient);
  double squares = 0;
  for (std::size_t row = 0; row < estimates.size(); ++row) {
    const FrameEstimate& estimate = estimates[row];
    status[row] = StatusName(estimate.status);
    ++summary.by_status[static_cast<std::size_t>(estimate.status)];
    const bool solved = estimate.status == FrameStatus::kOk ||
                        estimate.status == FrameStatus::kUnobservable ||
                        estimate.status == FrameStatus::kNoContact;
    if (!solved || std::isnan(force[row])) continue;
    const double error = per_normal * estimate.normal_N - force[row];
    squares += error * error;
    summary.force_max_N = std::max(summary.force_max_N, std::abs(error));
    ++summary.force_compared;
  }
  if (summary.force_compared > 0) {
    summary.force_rms_N =
        std::sqrt(squares / static_cast<double>(summary.force_compared));
  }
  return summary;
}

}  // namespace finray
