#ifndef FINRAY_PERCEPTION_COMPLIANT_CONTACT_H_
#define FINRAY_PERCEPTION_COMPLIANT_CONTACT_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/io/frame_table.h"

namespace finray {

// Simulated compliance experiments: a circular pulley on a slider that yields
// along -x of frame S by a force law of any kind, against a finger.

/// Force that an object takes at a displacement; grows with it.
using ForceLaw = std::function<double(double)>;

struct SliderProtocol {
  double radius_mm = 10;  ///< of the pulley
  double height_mm = 65;
  int steps = 20;
  double step_mm = 1;
  bool unloading = true;  ///< and back, step by step
  double friction_N = 0;  ///< of the slider, Coulomb's
};

struct SliderNoise {
  bool gauges = true;  ///< each of its own noise_V
  double stage_std_mm = 0;
  std::uint64_t seed = 1;
};

/// The log of pushing a finger against the slider, step by step: gauge_<j>_V,
/// object_x_mm, object_y_mm (the slider's unloaded place), force_N along the
/// slider. While the slider stands, friction takes what is missing. Throws
/// std::runtime_error where there is no equilibrium.
FrameTable SimulateSlider(const Finger& plant, const ForceLaw& law,
                          const Discretization& discretization,
                          const SliderProtocol& protocol,
                          const SliderNoise& noise);

/// Both fingers' logs of squeezing an object between them, which is free to
/// shift: at rising forces, `steps` up to `largest_N`. In either log the
/// object's place is that of a pulley of half the object, held where the middle
/// between both palms puts it. `displacement` is the law's inverse.
struct SqueezeLogs {
  FrameTable first, second;
};
SqueezeLogs SimulateSqueeze(const Finger& first, const Finger& second,
                            const ForceLaw& displacement,
                            const Discretization& discretization,
                            const SliderProtocol& protocol, double largest_N,
                            const SliderNoise& noise);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_COMPLIANT_CONTACT_H_
