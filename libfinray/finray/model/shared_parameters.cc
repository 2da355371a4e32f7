#include "finray/model/shared_parameters.h"

#include <cmath>
#include <utility>

namespace finray {

SharedParameters SharedParameters::Of(const Finger& finger,
                                      std::vector<FingerParameter> effects) {
  SharedParameters shared;
  shared.ln_front_stiffness = std::log(finger.front_stiffness_N_mm2);
  shared.ln_back_stiffness = std::log(finger.back_stiffness_N_mm2);
  for (const Rib& rib : finger.ribs) {
    shared.rib_lengths_mm.push_back(rib.length_mm);
  }
  for (const Gauge& gauge : finger.gauges) {
    shared.gauge_starts_mm.push_back(gauge.start_mm);
    shared.gauge_lengths_mm.push_back(gauge.length_mm);
  }
  for (const FingerParameter& effect : effects) {
    shared.effect_values.push_back(ParameterValue(finger, effect));
  }
  shared.effects = std::move(effects);
  return shared;
}

}  // namespace finray
