#ifndef FINRAY_CONTROL_MODEL_ERROR_H_
#define FINRAY_CONTROL_MODEL_ERROR_H_

#include <random>

#include "finray/finger/finger.h"

namespace finray {

/// By how much a finger differs from what its model says: independent normal
/// errors with these std, in the size of what a calibration leaves.
struct ModelError {
  double stiffness_percent = 0;  ///< of each beam's EI
  double gauge_gain_percent = 0;
  double gauge_offset_V = 0;
  double rib_length_mm = 0;
};

/// A finger that differs from `finger` by errors drawn from `generator`.
Finger Perturbed(const Finger& finger, const ModelError& error,
                 std::mt19937_64* generator);

}  // namespace finray

#endif  // FINRAY_CONTROL_MODEL_ERROR_H_
