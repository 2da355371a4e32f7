#ifndef FINRAY_TESTS_ESTIMATION_WANDERING_LOG_H_
#define FINRAY_TESTS_ESTIMATION_WANDERING_LOG_H_

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "finray/scene/measurements.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// What a log of touches looks like whose gauge offsets wander.
struct WanderingLogSettings {
  double duration_s = 600, rate_Hz = 10;
  double walk_V_per_sqrt_s = 1e-3, start_std_V = 0.02, noise_V = 3e-4;
  double drift_V_per_s = 0;  ///< of all gauges
  double shortest_touch_s = 5, longest_touch_s = 15;
  double shortest_gap_s = 2, longest_gap_s = 6;
  double lowest_mm = 30, highest_mm = 105;  ///< places of touches
  double least_N = 0.5, most_N = 6;         ///< forces that they are held at
  double fastest_ramp_s = 0.2, slowest_ramp_s = 1.5;
  double longest_way_mm = 15;  ///< of a touch that moves
  unsigned seed = 1;
};

/// A log of touches that are pressed, held or moved, and let go, from a plant
/// of its own: a finger and a scheme that need not be the estimator's.
struct WanderingLog {
  WanderingLog(const Finger& plant, const Discretization& discretization,
               const WanderingLogSettings& settings)
      : generator_(settings.seed) {
    EquilibriumSolver solver(plant, discretization);
    const auto gauges = plant.gauges.size();
    std::vector<double> offset(gauges);
    for (double& b : offset) b = settings.start_std_V * normal_(generator_);
    const double dt = 1 / settings.rate_Hz;
    Touch touch = NextTouch(0, settings);
    const auto frames =
        static_cast<int>(std::lround(settings.duration_s * settings.rate_Hz));
    for (int t = 0; t < frames; ++t) {
      const double time = t * dt;
      if (time > touch.end_s) touch = NextTouch(time, settings);
      const PointContact contact = {touch.Arc(time), touch.Force(time), 0};
      if (contact.normal_N > 0) {
        solver.Solve({contact});
      } else {
        solver.Solve({});
      }
      Measurements row;
      row.time_s = time;
      row.force_N = contact.normal_N;
      for (std::size_t j = 0; j < gauges; ++j) {
        if (t > 0) {
          offset[j] +=
              settings.walk_V_per_sqrt_s * std::sqrt(dt) * normal_(generator_);
          offset[j] += settings.drift_V_per_s * dt;
        }
        row.gauges_V.push_back(
            plant.gauges[j].Volts(solver.gauge_angle(static_cast<int>(j))) +
            offset[j] + settings.noise_V * normal_(generator_));
      }
      rows.push_back(row);
      truth.push_back(contact);
      offsets_V.push_back(offset);
    }
  }

  std::vector<Measurements> rows;
  std::vector<PointContact> truth;  ///< normal_N is 0 where nothing touches
  std::vector<std::vector<double>> offsets_V;

 private:
  struct Touch {
    double begin_s, ramp_s, end_s;
    double arc_mm, way_mm, normal_N, swell_N, swell_s;

    double Arc(double time_s) const {
      const double share = (time_s - begin_s) / (end_s - begin_s);
      return arc_mm + way_mm * std::clamp(share, 0.0, 1.0);
    }
    double Force(double time_s) const {
      const double ramp =
          std::min((time_s - begin_s) / ramp_s, (end_s - time_s) / ramp_s);
      if (ramp <= 0) return 0;
      const double held =
          normal_N + swell_N * std::sin((time_s - begin_s) / swell_s);
      return held * std::min(1.0, ramp);
    }
  };

  Touch NextTouch(double time_s, const WanderingLogSettings& s) {
    const auto draw = [this](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(generator_);
    };
    Touch touch;
    touch.begin_s = time_s + draw(s.shortest_gap_s, s.longest_gap_s);
    touch.end_s = touch.begin_s + draw(s.shortest_touch_s, s.longest_touch_s);
    touch.ramp_s = draw(s.fastest_ramp_s, s.slowest_ramp_s);
    touch.arc_mm = draw(s.lowest_mm, s.highest_mm);
    const bool moves = draw(0, 1) < 0.5;
    const double end = touch.arc_mm + draw(-s.longest_way_mm, s.longest_way_mm);
    touch.way_mm = std::clamp(end, s.lowest_mm, s.highest_mm) - touch.arc_mm;
    if (!moves) touch.way_mm = 0;
    touch.normal_N = draw(s.least_N, s.most_N);
    touch.swell_N = draw(0, 1) < 0.5 ? 0 : 0.3 * touch.normal_N;
    touch.swell_s = draw(0.3, 2);
    return touch;
  }

  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_{0, 1};
};

}  // namespace finray

#endif  // FINRAY_TESTS_ESTIMATION_WANDERING_LOG_H_
