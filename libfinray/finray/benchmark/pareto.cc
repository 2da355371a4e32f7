#include "finray/benchmark/pareto.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

constexpr double kSameTime = 1.05, kFaster = 1.15, kExacter = 1.5, kCoarser = 2;

}  // namespace

bool Dominates(const Measurement& a, const Measurement& b, double time_ratio) {
  if (time_ratio > kSameTime || a.error() > kSameError * b.error()) {
    return false;
  }
  for (const ComparedError& error : kComparedErrors) {
    if (a.errors.*error.value >
        kCoarser * std::max(b.errors.*error.value, Measurement::kLeastError)) {
      return false;
    }
  }
  return kFaster * time_ratio < 1 || kExacter * a.error() < b.error();
}

std::vector<SceneFront> ParetoFronts(const std::vector<Measurement>& all) {
  std::vector<SceneFront> fronts;
  for (const Measurement& first : all) {
    SceneFront front{first.name.task, first.name.scene, {}};
    const auto belongs = [&](const auto& other) {
      return other.task == front.task && other.scene == front.scene;
    };
    if (std::any_of(fronts.begin(), fronts.end(), belongs)) continue;
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (belongs(all[i].name) && all[i].solved_percent == 100 &&
          !std::isnan(all[i].error())) {
        members.push_back(i);
      }
    }
    for (const std::size_t i : members) {
      if (std::none_of(members.begin(), members.end(), [&](std::size_t k) {
            return Dominates(all[k], all[i], all[k].ratio() / all[i].ratio());
          })) {
        front.front.push_back(i);
      }
    }
    std::sort(front.front.begin(), front.front.end(),
              [&](std::size_t i, std::size_t k) {
                return all[i].ratio() < all[k].ratio();
              });
    fronts.push_back(front);
  }
  return fronts;
}

}  // namespace finray
