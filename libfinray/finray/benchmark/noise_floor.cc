#include "finray/benchmark/noise_floor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "finray/estimation/row_fit.h"
#include "finray/fit/contact_covariance.h"

namespace finray {

NoiseFloor NoiseFloorOf(const Finger& finger, const BenchmarkCase& c) {
  NoiseFloor floor;
  floor.scene = c.scene_name;
  floor.gauge_rad = std::numeric_limits<double>::infinity();
  for (const Gauge& gauge : finger.gauges) {
    floor.gauge_rad = std::min(floor.gauge_rad, 1 / gauge.AngleWeight());
  }
  if (!c.scene.contacts) return floor;

  RowFit fit(finger, c.scene, {}, nullptr,
             std::numeric_limits<double>::infinity());
  EquilibriumSolver solver(finger, {});
  ContactSolution found;
  double arc = 0, normal = 0;
  int contacts = 0;
  for (std::size_t k = 0; k < c.frames.size(); ++k) {
    const BenchmarkFrame& frame = c.frames[k];
    Measurements readings;
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      readings.gauges_V.push_back(finger.gauges[j].Volts(
          c.forward[k].gauges_rad[static_cast<Eigen::Index>(j)]));
    }
    if (c.scene.object_std_mm) {
      for (int i = 0; i < 2; ++i) {
        readings.object_mm[i] = frame.object.position_mm[i];
      }
    }
    fit.set_row(readings);
    if (!fit.FitFrom(frame.contacts, &solver, &found)) {
      throw std::runtime_error("noise floor: " + c.scene_name + ", frame " +
                               std::to_string(k) + " has no fit");
    }
    const ContactMatrix covariance = CovarianceOf(found.information);
    for (Eigen::Index i = 0; i < covariance.rows(); i += 2) {
      arc += covariance(i, i);
      normal += covariance(i + 1, i + 1);
      ++contacts;
    }
  }
  floor.contact_mm = std::sqrt(arc / contacts);
  floor.normal_N = std::sqrt(normal / contacts);
  return floor;
}

NoiseFloor FloorOf(const std::vector<NoiseFloor>& floors,
                   const std::string& scene) {
  for (const NoiseFloor& floor : floors) {
    if (floor.scene == scene) return floor;
  }
  return {};
}

}  // namespace finray
