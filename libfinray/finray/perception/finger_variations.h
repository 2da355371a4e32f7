#ifndef FINRAY_PERCEPTION_FINGER_VARIATIONS_H_
#define FINRAY_PERCEPTION_FINGER_VARIATIONS_H_

#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// The finger as its calibration leaves it uncertain: with C_pp = F F', one
/// finger for each column of F, its parameters p moved by that column. What a
/// result y(p) of many frames owes to the calibration is, to first order,
///
///   cov y = sum_k (y(p + F_k) - y(p)) (y(p + F_k) - y(p))',
///
/// which holds however the frames go into y, as the errors of the parameters
/// are the same in all of them. Columns that change nothing are left out; no
/// finger at all if there is no calibration.
std::vector<Finger> FingerVariations(const Finger& finger);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_FINGER_VARIATIONS_H_
