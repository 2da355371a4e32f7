#include "finray/benchmark/pareto.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "finray/benchmark/statistics.h"

namespace finray {
namespace {

// mm or rad; the reference itself is no better.
constexpr double kLeastError = 1e-11;
constexpr double kSameTime = 1.05, kFaster = 1.15, kExacter = 1.5;

}  // namespace

bool Dominates(const TimeAndError& a, const TimeAndError& b) {
  if (a.time > kSameTime * b.time || a.error > kSameError * b.error) {
    return false;
  }
  return kFaster * a.time < b.time || kExacter * a.error < b.error;
}

std::vector<std::size_t> ParetoFront(const std::vector<TimeAndError>& points) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::none_of(points.begin(), points.end(),
                     [&](const TimeAndError& other) {
                       return Dominates(other, points[i]);
                     })) {
      front.push_back(i);
    }
  }
  std::sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
    return points[a].time < points[b].time;
  });
  return front;
}

TimeAndError PointOf(const Measurement& measurement) {
  // Ratios, for times of one machine in one hour, scaled back to us.
  return {Median(measurement.ratios()) * Median(measurement.yardstick_us),
          std::max(measurement.error(), kLeastError)};
}

std::vector<SceneFront> ParetoFronts(const std::vector<Measurement>& all) {
  std::vector<SceneFront> fronts;
  for (const Measurement& first : all) {
    const auto same = [&](const SceneFront& front) {
      return front.task == first.name.task && front.scene == first.name.scene;
    };
    if (std::any_of(fronts.begin(), fronts.end(), same)) continue;
    std::vector<std::size_t> members;
    std::vector<TimeAndError> points;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Measurement& m = all[i];
      if (m.name.task != first.name.task || m.name.scene != first.name.scene ||
          m.solved_percent < 100 || std::isnan(m.error())) {
        continue;
      }
      members.push_back(i);
      points.push_back(PointOf(m));
    }
    SceneFront front{first.name.task, first.name.scene, {}};
    for (const std::size_t k : ParetoFront(points)) {
      front.front.push_back(members[k]);
    }
    fronts.push_back(front);
  }
  return fronts;
}

}  // namespace finray
