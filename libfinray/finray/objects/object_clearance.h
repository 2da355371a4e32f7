#ifndef FINRAY_OBJECTS_OBJECT_CLEARANCE_H_
#define FINRAY_OBJECTS_OBJECT_CLEARANCE_H_

#include <vector>

#include "finray/objects/outline.h"
#include "finray/statics/shape.h"

namespace finray {

/// A place where the front beam comes nearest to an object, or ends.
struct Approach {
  double arc_mm;
  double distance_mm;  ///< < 0 inside the object.
  bool at_end;         ///< The beam ends before the distance grows again.
};

/// The local minima of the front beam's distance d from an object, base to tip,
/// of those that lie below `below_mm` or are the least of all. Sampled densely,
/// also at and midway between `contacts`; between samples the minimum is where
/// d' = t . n_o passes through zero.
std::vector<Approach> FindApproaches(const Shape& shape, double length_mm,
                                     const std::vector<PointContact>& contacts,
                                     const Outline& outline,
                                     const ObjectPose& pose, double below_mm);

}  // namespace finray

#endif  // FINRAY_OBJECTS_OBJECT_CLEARANCE_H_
