#include "finray/perception/stiffness_order.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace finray {

Stiffness MeanStiffness(const std::vector<Stiffness>& trials) {
  double weights = 0, sum = 0;
  for (const Stiffness& trial : trials) {
    const double weight = 1 / (trial.std * trial.std);
    weights += weight;
    sum += weight * trial.N_per_mm;
  }
  const double mean = sum / weights;
  double scatter = 0;
  for (const Stiffness& trial : trials) {
    const double off = (trial.N_per_mm - mean) / trial.std;
    scatter += off * off;
  }
  const auto count = static_cast<double>(trials.size());
  const double enlarged = count > 1 ? scatter / (count - 1) : 1;
  return {mean, std::sqrt(std::max(1.0, enlarged) / weights)};
}

std::vector<double> SortByStiffness(std::vector<ObjectStiffness>* objects) {
  std::stable_sort(objects->begin(), objects->end(),
                   [](const ObjectStiffness& a, const ObjectStiffness& b) {
                     return a.mean.N_per_mm > b.mean.N_per_mm;
                   });
  std::vector<double> confidence;
  for (std::size_t i = 0; i + 1 < objects->size(); ++i) {
    const Stiffness &a = (*objects)[i].mean, &b = (*objects)[i + 1].mean;
    const double off = (a.N_per_mm - b.N_per_mm) / std::hypot(a.std, b.std);
    confidence.push_back(0.5 * std::erfc(-off / std::sqrt(2.0)));
  }
  return confidence;
}

double OrderConfidence(const std::vector<ObjectStiffness>& objects,
                       std::uint64_t seed, int draws) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  int right = 0;
  for (int draw = 0; draw < draws; ++draw) {
    double before = 0;
    bool sorted = true;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const Stiffness& mean = objects[i].mean;
      const double drawn = mean.N_per_mm + mean.std * normal(generator);
      sorted = sorted && (i == 0 || drawn < before);
      before = drawn;
    }
    right += sorted;
  }
  return static_cast<double>(right) / draws;
}

}  // namespace finray
