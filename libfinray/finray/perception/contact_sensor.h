#ifndef FINRAY_PERCEPTION_CONTACT_SENSOR_H_
#define FINRAY_PERCEPTION_CONTACT_SENSOR_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/scene/measurement_columns.h"
#include "finray/sensing/frame_estimator.h"
#include "finray/statics/shape.h"

namespace finray {

/// One contact of a frame: its pose z_1..3 = (x, y, theta) in frame S (mm,
/// rad), its normal force z_4 (N) and their covariance. With C the covariance
/// of (l_c, f_c) of all contacts of the frame and s =
/// FrameEstimate::noise_scale(),
///
///   cov z = s^2 (dz/d(l_c, f_c)) C (dz/d(l_c, f_c))'.
///
/// It leaves out the error of the calibration, which all frames share
/// (finger_variations.h).
struct SensedContact {
  PointContact contact;
  Eigen::Vector3d pose;
  Eigen::Matrix4d covariance;
};

struct SensedFrame {
  FrameStatus status = FrameStatus::kBadInput;
  /// From base to tip; empty unless the status is ok.
  std::vector<SensedContact> contacts;
  /// Both beams; set together with the contacts.
  std::optional<Shape> shape;
};

/// Estimates the contacts of a frame, then solves the equilibrium there once
/// more for the shape of the finger and for the covariance of pose and force.
class ContactSensor {
 public:
  /// Throws InputError as FrameEstimator does.
  ContactSensor(const Finger& finger, const Scene& scene,
                const Discretization& discretization);

  SensedFrame Sense(const Measurements& readings);
  /// For contacts that have been estimated before, with the std of (l_c, f_c).
  SensedFrame FromEstimate(const std::vector<PointContact>& contacts,
                           const std::vector<Eigen::Vector2d>& std);

 private:
  SensedFrame At(const std::vector<PointContact>& contacts,
                 const ContactMatrix& covariance);

  Scene scene_;
  FrameEstimator estimator_;
  EquilibriumSolver solver_;
};

/// Reads all rows of a table that records the object's place in each. Throws
/// InputError if a column is missing, and at the line of a row without a place.
std::vector<Measurements> ReadWithPlaces(
    const FrameTable& table, const Finger& finger,
    const MeasurementColumns::Options& options = {});

}  // namespace finray

#endif  // FINRAY_PERCEPTION_CONTACT_SENSOR_H_
