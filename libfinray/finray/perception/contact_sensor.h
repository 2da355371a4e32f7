#ifndef FINRAY_PERCEPTION_CONTACT_SENSOR_H_
#define FINRAY_PERCEPTION_CONTACT_SENSOR_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/sensing/frame_estimator.h"
#include "finray/statics/shape.h"

namespace finray {

/// One contact of a frame with what its noise leaves uncertain of z = (x, y,
/// theta, f_c), pose in frame S and normal force. From the covariance C of
/// (l_c, f_c) of all contacts of the frame,
///
///   cov z = s^2 (dz/d(l_c, f_c)) C (dz/d(l_c, f_c))',
///
/// s being FrameEstimate::noise_scale(). The calibration's part is not in it:
/// it is the same in all frames (finger_variations.h).
struct SensedContact {
  PointContact contact;
  Eigen::Vector3d pose;
  Eigen::Matrix4d covariance;
};

struct SensedFrame {
  FrameStatus status = FrameStatus::kBadInput;
  /// Base to tip; empty unless the status is ok.
  std::vector<SensedContact> contacts;
  /// Of both beams; with contacts.
  std::optional<Shape> shape;
};

/// FrameEstimator, and at its solution the equilibrium once more for the shape
/// and the covariance of what follows from the contact.
class ContactSensor {
 public:
  /// Throws InputError as FrameEstimator does.
  ContactSensor(const Finger& finger, const Scene& scene,
                const Discretization& discretization);

  SensedFrame Sense(const Measurements& readings);
  /// The same for contacts that are estimated already, with std of l_c and f_c.
  SensedFrame FromEstimate(const std::vector<PointContact>& contacts,
                           const std::vector<Eigen::Vector2d>& std);

 private:
  SensedFrame At(const std::vector<PointContact>& contacts,
                 const ContactMatrix& covariance);

  Finger finger_;
  Scene scene_;
  FrameEstimator estimator_;
  EquilibriumSolver solver_;
};

}  // namespace finray

#endif  // FINRAY_PERCEPTION_CONTACT_SENSOR_H_
