#ifndef FINRAY_SCENE_STAGE_FRAME_H_
#define FINRAY_SCENE_STAGE_FRAME_H_

#include <Eigen/Geometry>
#include <cmath>

namespace finray {

/// The frame in which a stage or a camera gives the place of an object. A place
/// p of a log lies in frame S at
///
///   p_S = o + s R(a) p,
///
/// with the origin o (mm), the scale s (positive) and R a rotation by a. Length
/// in mm. The default leaves every place as it is.
struct StageFrame {
  Eigen::Vector2d origin_mm{0, 0};
  double rotation_deg = 0;
  double ln_scale = 0;

  /// s R(a) p, which is p_S without the origin.
  Eigen::Vector2d Turned(const Eigen::Vector2d& place_mm) const {
    return std::exp(ln_scale) *
           (Eigen::Rotation2Dd(rotation_deg * M_PI / 180) * place_mm);
  }
  Eigen::Vector2d InS(const Eigen::Vector2d& place_mm) const {
    return origin_mm + Turned(place_mm);
  }
  /// The place p of a log that lies at p_S.
  Eigen::Vector2d FromS(const Eigen::Vector2d& place_mm) const {
    return std::exp(-ln_scale) *
           (Eigen::Rotation2Dd(-rotation_deg * M_PI / 180) *
            (place_mm - origin_mm));
  }
};

}  // namespace finray

#endif  // FINRAY_SCENE_STAGE_FRAME_H_
