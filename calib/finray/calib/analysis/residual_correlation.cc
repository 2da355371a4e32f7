#include "finray/calib/analysis/residual_correlation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "finray/estimation/chi_squared.h"

namespace finray {
namespace {

constexpr int kLeastRows = 20;
constexpr int kTestedLags = 10;
constexpr double kWindow = 5;  // the window in units of tau

double Gamma(const std::vector<std::vector<double>>& logs, int lag) {
  double sum = 0;
  for (const std::vector<double>& r : logs) {
    for (std::size_t t = lag; t < r.size(); ++t) sum += r[t] * r[t - lag];
  }
  return sum;
}

// Returns the component of the k-th residual of a family in a frame. Pins may
// be hidden in some rows, so they are counted by rib, side and coordinate.
int Component(ResidualFamily family, const CalibrationFrame& frame, int k) {
  if (family != ResidualFamily::kPin) return k;
  const SeenPin& pin = frame.pins[k / 2];
  return 2 * (2 * pin.rib + (pin.side == Side::kBack ? 1 : 0)) + k % 2;
}

}  // namespace

IntegratedTime IntegrateTime(const std::vector<std::vector<double>>& logs) {
  IntegratedTime result;
  for (const auto& log : logs) result.n += static_cast<int>(log.size());
  const double variance = Gamma(logs, 0);
  if (result.n < kLeastRows || !(variance > 0)) return result;
  const double n = result.n;
  double q = 0, sum = 1;
  int lags = 0, window = 0;
  for (int k = 1; k <= result.n / 4; ++k) {
    const double rho = Gamma(logs, k) / variance;
    if (k == 1) result.lag_1 = rho;
    if (k <= kTestedLags) {
      q += rho * rho / (n - k);
      ++lags;
    }
    if (window == 0) {
      sum += 2 * rho;
      if (k >= kWindow * std::max(sum, 1.0)) window = k;
    }
    if (window > 0 && k >= kTestedLags) break;
  }
  if (window == 0) window = result.n / 4;
  result.tau = std::max(1.0, sum / (1 - (2 * window + 1) / n));
  result.p_value = ChiSquaredTail(n * (n + 2) * q, lags);
  return result;
}

const ResidualCorrelation::Series* ResidualCorrelation::Slowest() const {
  const auto slowest = std::max_element(
      series.begin(), series.end(),
      [](const Series& a, const Series& b) { return a.time.tau < b.time.tau; });
  return slowest == series.end() ? nullptr : &*slowest;
}

ResidualCorrelation AnalyzeResidualCorrelation(const CalibrationLogs& all,
                                               const Linearization& at,
                                               const Identifiability& found) {
  const auto& frames = all.frames;
  const auto logs = all.paths.size();
  const auto n = static_cast<int>(found.std.size());
  ResidualCorrelation result;
  result.enlargement.assign(n, 1);

  using Key = std::tuple<int, int, int, int>;  // the fields of Series
  std::map<Key, std::vector<double>> series;
  // The number of residuals so far in the frame, by family and gauge.
  std::map<std::pair<int, int>, int> components;
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    const ResidualInfo& row = at.rows[i];
    if (i == 0 || row.frame != at.rows[i - 1].frame) components.clear();
    // Rows that repeat each other share an error, which their std allow for.
    if (frames[row.frame].StdTimes(row.family) > 1) continue;
    const int family = static_cast<int>(row.family);
    const int component = Component(row.family, frames[row.frame],
                                    components[{family, row.gauge}]++);
    series[{frames[row.frame].log, family, row.gauge, component}].push_back(
        at.weighted_residuals[i]);
  }
  double least = 1;
  for (const auto& [key, values] : series) {
    if (values.size() < kLeastRows) continue;
    const auto [log, family, gauge, component] = key;
    const IntegratedTime time = IntegrateTime({values});
    // Alternating residuals do no harm.
    if (time.tau > 1) least = std::min(least, time.p_value);
    result.series.push_back(
        {log, static_cast<ResidualFamily>(family), gauge, component, time});
  }
  result.p_value =
      std::min(1.0, least * static_cast<double>(result.series.size()));
  for (const Identifiability::Noise& noise : found.noise) {
    const double beyond = noise.chi2 - noise.dof;
    result.loud |=
        beyond > ResidualCorrelation::kLoud * std::sqrt(2 * noise.dof) &&
        beyond > ResidualCorrelation::kLoudShare * noise.dof;
  }
  if (!result.enlarges()) return result;

  const Eigen::MatrixXd& covariance = found.covariance;
  const Eigen::MatrixXd by_pull = covariance * found.unit.asDiagonal();
  const Eigen::MatrixXd of_data = covariance * found.information * covariance;
  for (int i = 0; i < n; ++i) {
    std::vector<std::vector<double>> influence(logs);  // psi_t,i
    for (std::size_t k = 0; k < at.frames.size(); ++k) {
      influence[frames[at.frames[k]].log].push_back(by_pull.row(i).dot(
          at.pulls.col(static_cast<Eigen::Index>(k)).cast<double>()));
    }
    const double tau = result.correlated() ? IntegrateTime(influence).tau : 1;
    const double share = of_data(i, i) / covariance(i, i);
    if (!(share > 1e-6)) continue;
    const double v = std::max(1.0, tau * Gamma(influence, 0) / of_data(i, i));
    result.enlargement[i] = std::sqrt(1 + (v - 1) * share);
  }
  return result;
}

void EnlargeStd(const ResidualCorrelation& by, Identifiability* found) {
  if (!by.enlarges()) return;
  for (std::size_t i = 0; i < found->std.size(); ++i) {
    found->std[i] *= by.enlargement[i];
    found->bounded_std[i] *= by.enlargement[i];
  }
}

}  // namespace finray
