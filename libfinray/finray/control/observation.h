#ifndef FINRAY_CONTROL_OBSERVATION_H_
#define FINRAY_CONTROL_OBSERVATION_H_

#include <vector>

#include "finray/sensing/frame_estimate.h"

namespace finray {

/// The contact that a finger's estimator sees at a period's beginning.
struct SeenContact {
  double arc_mm = 0;
  double normal_N = 0;
  double normal_std_N = 0;
};

inline SeenContact Seen(const FrameEstimate& estimate) {
  return {estimate.contact[0].arc_mm, estimate.contact[0].normal_N,
          estimate.contact[0].normal_std_N};
}

/// The mean force of all fingers and its std, errors being independent.
struct SeenForce {
  double force_N = 0, std_N = 0;
};
SeenForce MeanForce(const std::vector<SeenContact>& contacts);

}  // namespace finray

#endif  // FINRAY_CONTROL_OBSERVATION_H_
