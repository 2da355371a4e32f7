#ifndef FINRAY_OBJECTS_APPROACHES_H_
#define FINRAY_OBJECTS_APPROACHES_H_

#include <vector>

#include "finray/objects/outline.h"
#include "finray/statics/shape.h"

namespace finray {

/// A local minimum of the front beam's distance from an object.
struct Approach {
  double arc_mm;
  double distance_mm;  ///< < 0 inside the object.
  bool at_end;         ///< The distance still falls at this end of the beam.
};

/// The local minima of the front beam's distance d from an object, base to tip,
/// that lie below `below_mm`, and the least of all. The beam is sampled
/// densely, also at `contacts` and midway between them, but not where samples
/// further off show that it lies higher. Between samples the minimum is where
/// d' = t . n_o passes through zero.
std::vector<Approach> FindApproaches(const Shape& shape, double length_mm,
                                     const std::vector<PointContact>& contacts,
                                     const Outline& outline,
                                     const ObjectPose& pose, double below_mm);

}  // namespace finray

#endif  // FINRAY_OBJECTS_APPROACHES_H_
