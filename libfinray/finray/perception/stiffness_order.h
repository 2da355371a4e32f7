#ifndef FINRAY_PERCEPTION_STIFFNESS_ORDER_H_
#define FINRAY_PERCEPTION_STIFFNESS_ORDER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "finray/perception/stiffness_fit.h"

namespace finray {

/// One object's stiffness, all trials together.
struct ObjectStiffness {
  std::string name;
  std::vector<Stiffness> trials;
  /// Mean weighted by the trials' std. The std is the larger of what these and
  /// what the scatter between trials say.
  Stiffness mean;
  /// What the finger's calibration leaves uncertain, common to all objects.
  double calibration_std = 0;
};

/// Mean and std of independent trials.
Stiffness MeanStiffness(const std::vector<Stiffness>& trials);

/// Sorts from stiff to soft. Entry i of the result is the probability that
/// object i is stiffer than object i + 1, their errors being independent and
/// normal; what is common to all does not change the order.
std::vector<double> SortByStiffness(std::vector<ObjectStiffness>* objects);

/// The probability that the whole order of sorted objects is right, from draws.
double OrderConfidence(const std::vector<ObjectStiffness>& objects,
                       std::uint64_t seed = 1, int draws = 20000);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_STIFFNESS_ORDER_H_
