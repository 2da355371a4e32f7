#include "finray/benchmark/statistics.h"

#include <algorithm>
#include <random>

#include "finray/io/nan.h"

namespace finray {

double Quantile(std::vector<double> values, double q) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  const double at = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  if (below + 1 >= values.size()) return values.back();
  const double share = at - static_cast<double>(below);
  return values[below] + share * (values[below + 1] - values[below]);
}

Interval RatioOfQuantiles(const std::vector<double>& a,
                          const std::vector<double>& b, double q,
                          double confidence) {
  constexpr int kDraws = 2000;
  if (a.empty() || b.empty()) return {kNaN, kNaN};
  std::mt19937_64 generator(1);
  std::vector<double> drawn;
  const auto quantile = [&](const std::vector<double>& sample) {
    drawn.resize(sample.size());
    for (double& value : drawn) value = sample[generator() % sample.size()];
    return Quantile(drawn, q);
  };
  std::vector<double> ratios(kDraws);
  for (double& ratio : ratios) {
    const double of_a = quantile(a);
    ratio = quantile(b) / of_a;
  }
  const double tail = (1 - confidence) / 2;
  return {Quantile(ratios, tail), Quantile(ratios, 1 - tail)};
}

}  // namespace finray
