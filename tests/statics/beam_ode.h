#ifndef FINRAY_TESTS_STATICS_BEAM_ODE_H_
#define FINRAY_TESTS_STATICS_BEAM_ODE_H_

#include <array>
#include <cmath>

namespace finray {

/// (x, y, theta, M) of a beam section, in extended precision.
using BeamOdeState = std::array<long double, 4>;

/// Integrates the beam equation x' = cos(theta), y' = sin(theta), theta' = M /
/// EI, M' = N_x sin(theta) - N_y cos(theta) over `length` by `steps` classical
/// Runge-Kutta steps. The reference that owes nothing to the library.
inline BeamOdeState IntegrateBeam(BeamOdeState state, long double force_x,
                                  long double force_y, long double stiffness,
                                  long double length, int steps) {
  const auto slope = [&](const BeamOdeState& at) {
    const long double c = std::cos(at[2]), s = std::sin(at[2]);
    return BeamOdeState{c, s, at[3] / stiffness, force_x * s - force_y * c};
  };
  const auto moved = [](const BeamOdeState& at, const BeamOdeState& by,
                        long double h) {
    BeamOdeState to;
    for (int i = 0; i < 4; ++i) to[i] = at[i] + h * by[i];
    return to;
  };
  const long double h = length / steps;
  for (int k = 0; k < steps; ++k) {
    const BeamOdeState k1 = slope(state);
    const BeamOdeState k2 = slope(moved(state, k1, h / 2));
    const BeamOdeState k3 = slope(moved(state, k2, h / 2));
    const BeamOdeState k4 = slope(moved(state, k3, h));
    for (int i = 0; i < 4; ++i) {
      state[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
  }
  return state;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_BEAM_ODE_H_
