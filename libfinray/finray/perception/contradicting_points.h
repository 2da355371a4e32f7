#ifndef FINRAY_PERCEPTION_CONTRADICTING_POINTS_H_
#define FINRAY_PERCEPTION_CONTRADICTING_POINTS_H_

#include <cstddef>
#include <vector>

#include "finray/perception/force_displacement.h"

namespace finray {

/// Takes out points that contradict the law of most others (a light touch that
/// reads like a heavy one) and says of which rows they are. With c_i the
/// squared distance of point i across the law of degree `degree`, in units of
/// its variance,
///
///   s^2 = median(c) / median of chi2 with one degree of freedom,
///
/// at least 1, and P(chi2 > c_i / s^2) < 0.01 / points takes it out. Nothing is
/// taken out where more than a quarter would be, or fewer than `least` left.
std::vector<std::size_t> TakeOutContradicting(int degree, bool friction,
                                              std::size_t least,
                                              std::vector<ForcePoint>* points);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_CONTRADICTING_POINTS_H_
