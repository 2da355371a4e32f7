#include "finray/control/trajectory.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// Rows of a log are at k / rate and jumps at k hold_s; where both coincide they
// may differ by rounding.
constexpr double kRounding_s = 1e-9;

std::size_t Level(const StepTrajectory& steps, double time_s) {
  const double passed =
      std::floor((std::max(time_s, 0.0) + kRounding_s) / steps.hold_s);
  return static_cast<std::size_t>(
      std::min(passed, static_cast<double>(steps.levels.size() - 1)));
}

struct ValueAt {
  double time_s;
  double operator()(const ConstantTrajectory& t) const { return t.value; }
  double operator()(const HarmonicTrajectory& t) const {
    return t.mean + t.amplitude * std::sin(2 * M_PI * time_s / t.period_s);
  }
  double operator()(const TriangularTrajectory& t) const {
    return t.mean + t.amplitude * 2 / M_PI *
                        std::asin(std::sin(2 * M_PI * time_s / t.period_s));
  }
  double operator()(const StepTrajectory& t) const {
    const std::size_t level = Level(t, time_s);
    const double since_s =
        std::max(time_s - static_cast<double>(level) * t.hold_s, 0.0);
    if (level == 0 || !(since_s < t.ramp_s)) return t.levels[level];
    return t.levels[level - 1] +
           since_s / t.ramp_s * (t.levels[level] - t.levels[level - 1]);
  }
};

}  // namespace

double Trajectory::At(double time_s) const {
  return std::visit(ValueAt{std::max(time_s, 0.0)}, shape_);
}

double Trajectory::SinceStep(double time_s) const {
  const auto* steps = std::get_if<StepTrajectory>(&shape_);
  if (steps == nullptr) return std::numeric_limits<double>::infinity();
  const std::size_t level = Level(*steps, time_s);
  return level == 0 ? std::numeric_limits<double>::infinity()
                    : time_s - static_cast<double>(level) * steps->hold_s;
}

double Trajectory::Middle() const {
  const auto* steps = std::get_if<StepTrajectory>(&shape_);
  if (steps == nullptr) return At(0);  // which is the mean
  const auto [least, most] =
      std::minmax_element(steps->levels.begin(), steps->levels.end());
  return 0.5 * (*least + *most);
}

}  // namespace finray
