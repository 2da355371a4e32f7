#ifndef FINRAY_TESTS_CHAIN_CHAIN_FIXTURE_H_
#define FINRAY_TESTS_CHAIN_CHAIN_FIXTURE_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "finray/chain/forward.h"
#include "test_finger.h"

namespace finray {

/// A finger with everything that the chain models.
inline Finger RichFinger() {
  Finger finger = PaperFinger();
  const double error_mm[] = {0.3, -0.4, 0.5, -0.2, 0.25};
  for (std::size_t k = 0; k < finger.ribs.size(); ++k) {
    finger.ribs[k].length_mm += error_mm[k];
  }
  finger.ribs[1].axial_stiffness_N = 500;
  finger.ribs[3].axial_stiffness_N = 80;
  finger.front_stiffness_N_mm2 = 8000;
  finger.back_stiffness_N_mm2 = 21000;
  finger.gauges[0].beam = Side::kFront;
  return finger;
}

}  // namespace finray

#endif  // FINRAY_TESTS_CHAIN_CHAIN_FIXTURE_H_
