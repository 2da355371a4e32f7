#ifndef FINRAY_TESTS_STUDIES_TEN_OBJECTS_H_
#define FINRAY_TESTS_STUDIES_TEN_OBJECTS_H_

#include <cmath>
#include <string>
#include <vector>

#include "finray/objects/outline.h"
#include "finray/perception/polygon.h"
#include "perception/simulated_touches.h"

namespace finray {

/// An object of the reconstruction experiments.
struct NamedObject {
  std::string name;
  std::string kind;  ///< smooth, filleted, concave
  Outline touched;   ///< what a finger meets: the convex hull
  Polygon truth;     ///< the outline itself
};

/// A regular polygon whose filleted corners are `radius_mm` from its centre.
inline RoundedPolygonOutline RegularPolygon(int corners, double radius_mm,
                                            double fillet_mm) {
  RoundedPolygonOutline polygon{{}, fillet_mm};
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners + 0.1;
    polygon.vertices_mm.emplace_back(
        (radius_mm - fillet_mm) *
        Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

/// Two circles of radius R at (-a, 0) and (a, 0), joined by necks: arcs of
/// radius r that touch both from outside. Its hull is a stadium.
inline Polygon Dumbbell(double a, double R, double r) {
  const double height = std::sqrt((R + r) * (R + r) - a * a);
  const double half = std::atan2(a, height);  // of a neck's arc
  Polygon points;
  const auto arc = [&](double x, double y, double radius, double from,
                       double to) {
    for (int i = 0; i < 400; ++i) {
      const double at = from + (to - from) * i / 400;
      points.emplace_back(x + radius * std::cos(at), y + radius * std::sin(at));
    }
  };
  const double lift = M_PI / 2 - half;  // where an arc leaves its circle
  arc(a, 0, R, -M_PI + lift, M_PI - lift);
  arc(0, height, r, -lift, -M_PI + lift);
  arc(-a, 0, R, lift, 2 * M_PI - lift);
  arc(0, -height, r, M_PI - lift, lift);
  return EvenlySpaced(points, 1440);
}

/// Five smooth objects, five with filleted corners, as in Figs. 14 and 16 of
/// the paper (which gives no sizes), and a mildly concave one.
inline std::vector<NamedObject> StudyObjects() {
  std::vector<NamedObject> objects;
  const auto add = [&](const char* name, const char* kind,
                       const Outline::Shape& shape) {
    const Outline outline(shape);
    objects.push_back({name, kind, outline, SampledOutline(outline)});
  };
  add("circle", "smooth", CircleOutline{18});
  add("ellipse", "smooth", EllipseOutline{23, 15});
  add("egg", "smooth", SupportOutline{18, {{0, 0}, {1.2, 0}, {0.8, 0}}});
  add("rounded triangle", "smooth",
      SupportOutline{18, {{0, 0}, {0, 0}, {1.4, 0.3}}});
  add("rounded square", "smooth",
      SupportOutline{18, {{0, 0}, {0, 0}, {0, 0}, {0.75, 0.2}}});
  add("square", "filleted",
      RoundedPolygonOutline{{{-14, -14}, {14, -14}, {14, 14}, {-14, 14}}, 4});
  add("rectangle", "filleted",
      RoundedPolygonOutline{{{-18, -10}, {18, -10}, {18, 10}, {-18, 10}}, 4});
  add("triangle", "filleted", RegularPolygon(3, 24, 5));
  add("pentagon", "filleted", RegularPolygon(5, 20, 4));
  add("trapezoid", "filleted",
      RoundedPolygonOutline{{{-16, -11}, {16, -11}, {9, 11}, {-9, 11}}, 5});
  objects.push_back({"dumbbell", "concave",
                     Outline(RoundedPolygonOutline{{{-9, 0}, {9, 0}}, 14}),
                     Dumbbell(9, 14, 40)});
  return objects;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_TEN_OBJECTS_H_
