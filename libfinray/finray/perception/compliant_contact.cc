#include "finray/perception/compliant_contact.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include "finray/objects/object_contact.h"
#include "finray/scene/frame_columns.h"

namespace finray {
namespace {

constexpr double kTolerance_mm = 1e-7;

// The finger against a pulley held so far in that its rim would reach a depth
// behind the front beam at rest.
class HeldPulley {
 public:
  HeldPulley(const Finger& plant, const Discretization& discretization,
             const SliderProtocol& protocol)
      : protocol_(protocol),
        object_{Outline(CircleOutline{protocol.radius_mm}), {}},
        solver_(plant, discretization) {}

  /// The force on the pulley along -x. The solver is left there.
  double Force(double depth_mm) {
    const ObjectPose pose{{Centre(depth_mm), protocol_.height_mm}, 0};
    const ObjectContact found =
        SolveObjectContact(object_, pose, 0, &solver_, contacts_);
    if (found.status == ObjectContactStatus::kNoContact) return 0;
    if (found.status != ObjectContactStatus::kContact) {
      throw std::runtime_error("no equilibrium against the pulley");
    }
    contacts_ = found.contacts;
    double force = 0;
    for (std::size_t c = 0; c < found.contacts.size(); ++c) {
      force += found.contacts[c].normal_N *
               std::sin(solver_.contact_pose(static_cast<int>(c))[2]);
    }
    return force;
  }

  /// The depth at which a rising function of it is 0, from 0 to `deepest`.
  template <class Function>
  double Depth(double deepest, Function excess) {
    double low = 0, high = deepest;
    double at_low = excess(low), at_high = excess(high);
    if (at_low >= 0) return low;
    if (at_high <= 0) return high;
    for (int i = 0; i < 80 && high - low > kTolerance_mm; ++i) {
      // The secant, kept off the ends; every third time the middle.
      double share = i % 3 == 2 ? 0.5 : at_low / (at_low - at_high);
      share = std::min(std::max(share, 0.01), 0.99);
      const double next = low + share * (high - low);
      const double value = excess(next);
      (value < 0 ? low : high) = next;
      (value < 0 ? at_low : at_high) = value;
    }
    return 0.5 * (low + high);
  }

  double Centre(double depth_mm) const {
    return depth_mm - protocol_.radius_mm;
  }
  const EquilibriumSolver& solver() const { return solver_; }

 private:
  SliderProtocol protocol_;
  RigidObject object_;
  EquilibriumSolver solver_;
  std::vector<PointContact> contacts_;
};

class NoisyLog {
 public:
  NoisyLog(std::size_t rows, const SliderNoise& noise, std::uint64_t stream)
      : table_(rows), noise_(noise), generator_(noise.seed * 1000 + stream) {}

  void Write(std::size_t row, const EquilibriumSolver& solver, double x_mm,
             double y_mm, double force_N) {
    const Finger& finger = solver.model().finger();
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      const Gauge& gauge = finger.gauges[j];
      const int index = static_cast<int>(j);
      table_.MutableNumbers(GaugeVolts(index))[row] =
          gauge.Volts(solver.gauge_angle(index)) +
          Error(noise_.gauges ? gauge.noise_V : 0);
    }
    table_.MutableNumbers("object_x_mm")[row] =
        x_mm + Error(noise_.stage_std_mm);
    table_.MutableNumbers("object_y_mm")[row] =
        y_mm + Error(noise_.stage_std_mm);
    table_.MutableNumbers("force_N")[row] = force_N;
  }

  FrameTable& table() { return table_; }

 private:
  double Error(double std) { return std > 0 ? std * normal_(generator_) : 0.0; }

  FrameTable table_;
  SliderNoise noise_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
};

}  // namespace

FrameTable SimulateSlider(const Finger& plant, const ForceLaw& law,
                          const Discretization& discretization,
                          const SliderProtocol& protocol,
                          const SliderNoise& noise) {
  HeldPulley pulley(plant, discretization, protocol);
  const int rows = protocol.steps * (protocol.unloading ? 2 : 1);
  NoisyLog log(static_cast<std::size_t>(rows), noise, 1);
  double displacement = 0;
  for (int row = 0; row < rows; ++row) {
    const int step =
        row < protocol.steps ? row + 1 : 2 * protocol.steps - 1 - row;
    const double approach = protocol.step_mm * step;
    const auto sliding = [&](double friction) {
      // In depth; the way of the slider is the rest of the approach.
      return approach - pulley.Depth(approach, [&](double depth) {
        return pulley.Force(depth) - law(approach - depth) - friction;
      });
    };
    const double forward = sliding(protocol.friction_N);
    const double backward = sliding(-protocol.friction_N);
    if (forward > displacement) {
      displacement = forward;
    } else if (backward < displacement) {
      displacement = backward;
    }
    const double depth = approach - displacement;
    const double force = pulley.Force(depth);
    log.Write(static_cast<std::size_t>(row), pulley.solver(),
              pulley.Centre(approach), protocol.height_mm, force);
  }
  return std::move(log.table());
}

SqueezeLogs SimulateSqueeze(const Finger& first, const Finger& second,
                            const ForceLaw& displacement,
                            const Discretization& discretization,
                            const SliderProtocol& protocol, double largest_N,
                            const SliderNoise& noise) {
  const Finger* fingers[] = {&first, &second};
  std::vector<NoisyLog> logs;
  for (std::uint64_t k = 0; k < 2; ++k) {
    logs.emplace_back(static_cast<std::size_t>(protocol.steps), noise, k + 2);
  }
  std::vector<HeldPulley> pulleys;
  for (const Finger* finger : fingers) {
    pulleys.emplace_back(*finger, discretization, protocol);
  }
  constexpr double kDeepest_mm = 40;
  for (int row = 0; row < protocol.steps; ++row) {
    const double force = largest_N * (row + 1) / protocol.steps;
    double depth[2];
    for (std::size_t k = 0; k < 2; ++k) {
      depth[k] = pulleys[k].Depth(
          kDeepest_mm, [&](double d) { return pulleys[k].Force(d) - force; });
      pulleys[k].Force(depth[k]);
    }
    // Both palms have come as near to the middle.
    const double closing = 0.5 * (depth[0] + depth[1] + displacement(force));
    for (std::size_t k = 0; k < 2; ++k) {
      logs[k].Write(static_cast<std::size_t>(row), pulleys[k].solver(),
                    pulleys[k].Centre(closing), protocol.height_mm, force);
    }
  }
  return {std::move(logs[0].table()), std::move(logs[1].table())};
}

}  // namespace finray
