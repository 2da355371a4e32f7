#ifndef FINRAY_APPS_FINGER_PICTURE_H_
#define FINRAY_APPS_FINGER_PICTURE_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// Writes an SVG of the finger to scale, by calib/report/draw_finger.py, with a
/// dot at each of the places (mm, frame S). It warns if the picture cannot be
/// drawn, and returns whether it was.
bool DrawFinger(const Finger& finger, const std::string& path,
                const std::vector<Eigen::Vector2d>& places = {});

}  // namespace finray

#endif  // FINRAY_APPS_FINGER_PICTURE_H_
