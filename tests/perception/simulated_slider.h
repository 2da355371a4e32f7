#ifndef FINRAY_TESTS_PERCEPTION_SIMULATED_SLIDER_H_
#define FINRAY_TESTS_PERCEPTION_SIMULATED_SLIDER_H_

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "finray/objects/object_contact.h"
#include "perception/noisy_log.h"

namespace finray {

// Simulated compliance experiments: a finger against a circular pulley on a
// slider, which yields along -x of frame S by any force law.

/// The force of an object at a displacement. It grows with the displacement.
using ForceFunction = std::function<double(double)>;

struct SliderProtocol {
  double radius_mm = 10;  ///< of the pulley
  double height_mm = 65;
  int steps = 20;
  double step_mm = 1;
  bool unloading = true;  ///< go back as well, step by step
  double friction_N = 0;  ///< Coulomb friction of the slider
};

/// The finger against a pulley that is held in place. The depth says how far
/// its rim would reach behind the front beam at rest.
class HeldPulley {
 public:
  HeldPulley(const Finger& plant, const Discretization& discretization,
             const SliderProtocol& protocol)
      : protocol_(protocol),
        object_{Outline(CircleOutline{protocol.radius_mm}), {}},
        solver_(plant, discretization) {}

  /// The force on the pulley along -x. Leaves the solver at the equilibrium;
  /// throws std::runtime_error if there is none.
  double Force(double depth_mm) {
    const ObjectContact found = SolveObjectContact(
        object_, {Centre(depth_mm), 0}, 0, &solver_, contacts_);
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

  /// The root of a rising function of the depth, from 0 to `deepest`.
  template <class Function>
  static double Depth(double deepest, Function excess) {
    constexpr double kTolerance_mm = 1e-7;
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

  Eigen::Vector2d Centre(double depth_mm) const {
    return {depth_mm - protocol_.radius_mm, protocol_.height_mm};
  }
  const EquilibriumSolver& solver() const { return solver_; }

 private:
  SliderProtocol protocol_;
  RigidObject object_;
  EquilibriumSolver solver_;
  std::vector<PointContact> contacts_;
};

/// The log of pushing a finger against the slider, step by step: gauge_<j>_V,
/// object_x_mm and object_y_mm (the slider's unloaded place), force_N along the
/// slider. While the slider stands, its friction balances the rest of the
/// force.
inline FrameTable SimulateSlider(const Finger& plant, const ForceFunction& law,
                                 const Discretization& discretization,
                                 const SliderProtocol& protocol,
                                 const LogNoise& noise) {
  HeldPulley pulley(plant, discretization, protocol);
  const int rows = protocol.steps * (protocol.unloading ? 2 : 1);
  NoisyLog log(rows, noise, noise.seed * 1000 + 1);
  double displacement = 0;
  for (int row = 0; row < rows; ++row) {
    const int step =
        row < protocol.steps ? row + 1 : 2 * protocol.steps - 1 - row;
    const double approach = protocol.step_mm * step;
    // The slider's displacement if it slides against this friction.
    const auto sliding = [&](double friction) {
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
    const double force = pulley.Force(approach - displacement);
    log.Write(row, pulley.solver(), pulley.Centre(approach), force);
  }
  return std::move(log.table());
}

/// Logs of two fingers that squeeze an object, which is free to shift, with
/// forces that rise to `largest_N` in `steps`. In each log the object is a
/// pulley of half its size, whose place is the middle between both palms.
/// `displacement` is the inverse of the force law.
struct SqueezeLogs {
  FrameTable first, second;
};
inline SqueezeLogs SimulateSqueeze(const Finger& first, const Finger& second,
                                   const ForceFunction& displacement,
                                   const Discretization& discretization,
                                   const SliderProtocol& protocol,
                                   double largest_N, const LogNoise& noise) {
  const Finger* fingers[] = {&first, &second};
  std::vector<NoisyLog> logs;
  std::vector<HeldPulley> pulleys;
  for (std::uint64_t k = 0; k < 2; ++k) {
    logs.emplace_back(protocol.steps, noise, noise.seed * 1000 + k + 2);
    pulleys.emplace_back(*fingers[k], discretization, protocol);
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
    // Both palms are equally far from the middle.
    const double closing = 0.5 * (depth[0] + depth[1] + displacement(force));
    for (std::size_t k = 0; k < 2; ++k) {
      logs[k].Write(row, pulleys[k].solver(), pulleys[k].Centre(closing),
                    force);
    }
  }
  return {std::move(logs[0].table()), std::move(logs[1].table())};
}

}  // namespace finray

#endif  // FINRAY_TESTS_PERCEPTION_SIMULATED_SLIDER_H_
