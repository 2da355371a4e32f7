#include "finray/benchmark/pareto.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "finray/benchmark/statistics.h"

namespace finray {
namespace {

// mm or rad; the reference itself is no better.
constexpr double kLeastError = 1e-11;
constexpr double kSameTime = 1.05, kFaster = 1.15, kExacter = 1.5, kCoarser = 2;

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
  return {measurement.ratio(), std::max(measurement.error(), kLeastError)};
}

bool DominatesSetting(const Measurement& a, const Measurement& b,
                      double time_ratio) {
  const auto coarser = [](double of_a, double of_b) {
    return of_a > kCoarser * std::max(of_b, kLeastError);
  };
  const BenchmarkErrors &x = a.errors, &y = b.errors;
  return Dominates({time_ratio, PointOf(a).error}, {1, PointOf(b).error}) &&
         !coarser(x.contact_mm, y.contact_mm) &&
         !coarser(x.normal_N, y.normal_N) && !coarser(x.tip_mm, y.tip_mm) &&
         !coarser(x.gauges_rad, y.gauges_rad);
}

std::vector<SceneFront> ParetoFronts(const std::vector<Measurement>& all) {
  std::vector<SceneFront> fronts;
  for (const Measurement& first : all) {
    const auto same = [&](const SceneFront& front) {
      return front.task == first.name.task && front.scene == first.name.scene;
    };
    if (std::any_of(fronts.begin(), fronts.end(), same)) continue;
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Measurement& m = all[i];
      if (m.name.task == first.name.task && m.name.scene == first.name.scene &&
          m.solved_percent == 100 && !std::isnan(m.error())) {
        members.push_back(i);
      }
    }
    SceneFront front{first.name.task, first.name.scene, {}};
    for (const std::size_t i : members) {
      if (std::none_of(members.begin(), members.end(), [&](std::size_t k) {
            return DominatesSetting(
                all[k], all[i], PointOf(all[k]).time / PointOf(all[i]).time);
          })) {
        front.front.push_back(i);
      }
    }
    std::sort(front.front.begin(), front.front.end(),
              [&](std::size_t i, std::size_t k) {
                return PointOf(all[i]).time < PointOf(all[k]).time;
              });
    fronts.push_back(front);
  }
  return fronts;
}

}  // namespace finray
