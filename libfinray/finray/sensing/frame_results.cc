#include "finray/sensing/frame_results.h"

#include <cmath>

#include "finray/sensing/frame_columns.h"

namespace finray {
namespace {

double FiniteOrNan(double value) {
  return std::isfinite(value) ? value : std::nan("");
}

}  // namespace

std::vector<FrameReadings> ReadReadings(const Finger& finger,
                                        const FrameTable& log) {
  std::vector<FrameReadings> readings(log.rows());
  for (FrameReadings& frame : readings) {
    frame.gauges_V.resize(finger.gauges.size());
  }
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    const std::string name = GaugeVolts(static_cast<int>(j));
    const std::string angle_name = GaugeAngle(static_cast<int>(j));
    const bool angles = !log.Has(name) && log.Has(angle_name);
    const auto& column = log.Numbers(angles ? angle_name : name);
    for (std::size_t row = 0; row < log.rows(); ++row) {
      readings[row].gauges_V[j] =
          angles ? gauge.gain_V_per_rad * column[row] + gauge.offset_V
                 : column[row];
    }
  }
  return readings;
}

void FillResults(const Finger& finger, const Scene& scene,
                 const std::vector<FrameReadings>& readings,
                 const std::vector<FrameEstimate>& estimates, FrameTable* log) {
  const auto fill = [&](const std::string& name, const auto& value) {
    std::vector<double>& column = log->MutableNumbers(name);
    for (std::size_t row = 0; row < estimates.size(); ++row) {
      column[row] = FiniteOrNan(value(estimates[row]));
    }
  };
  using E = const FrameEstimate&;
  fill(ContactArc(0), [](E e) { return e.contact[0].arc_mm; });
  fill(ContactArcStd(0), [](E e) { return e.contact[0].arc_std_mm; });
  fill(NormalForce(0), [](E e) { return e.contact[0].normal_N; });
  fill(NormalForceStd(0), [](E e) { return e.contact[0].normal_std_N; });
  if (scene.friction_coefficient != 0) {
    fill(Friction(0), [&](E e) {
      return std::isfinite(e.contact[0].arc_mm) ? scene.friction_coefficient
                                                : std::nan("");
    });
  }
  fill(ContactX(0), [](E e) { return e.contact[0].pose.x(); });
  fill(ContactY(0), [](E e) { return e.contact[0].pose.y(); });
  fill(ContactAngle(0), [](E e) { return e.contact[0].pose.z(); });
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    std::vector<double>& column =
        log->MutableNumbers(GaugeAngle(static_cast<int>(j)));
    for (std::size_t row = 0; row < readings.size(); ++row) {
      column[row] =
          (readings[row].gauges_V[j] - gauge.offset_V) / gauge.gain_V_per_rad;
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

  std::vector<std::string>& status = log->MutableText("status");
  for (std::size_t row = 0; row < estimates.size(); ++row) {
    status[row] = StatusName(estimates[row].status);
  }
}

}  // namespace finray
