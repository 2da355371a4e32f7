#ifndef FINRAY_CONTROL_MODEL_ERROR_H_
#define FINRAY_CONTROL_MODEL_ERROR_H_

#include <random>

#include "finray/finger/finger.h"

namespace finray {

/// The std by which a finger differs from its model. The errors are normal and
/// independent.
struct ModelError {
  double stiffness_percent = 0;  ///< of each beam's EI
  double gauge_gain_percent = 0;
  double gauge_offset_V = 0;
  double rib_length_mm = 0;
};

/// `finger` with errors drawn from `generator`.
Finger Perturbed(const Finger& finger, const ModelError& error,
                 std::mt19937_64* generator);

}  // namespace finray

#endif  // FINRAY_CONTROL_MODEL_ERROR_H_
