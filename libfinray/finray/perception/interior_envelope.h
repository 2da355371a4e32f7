#ifndef FINRAY_PERCEPTION_INTERIOR_ENVELOPE_H_
#define FINRAY_PERCEPTION_INTERIOR_ENVELOPE_H_

#include <vector>

#include "finray/perception/polygon.h"
#include "finray/perception/touch.h"

namespace finray {

/// The paper's outline (IV-B): the contour of the blank area that the pieces of
/// beam near the contacts enclose. Here by rays instead of an image: from the
/// mean of the contact points the first crossing with any piece, at `count`
/// equally spaced angles. Between angles at which no piece is met the contour
/// is straight.
Polygon InteriorEnvelope(const std::vector<Touch>& touches, double reach_mm,
                         int count = 1440);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_INTERIOR_ENVELOPE_H_
