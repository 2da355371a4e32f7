#ifndef FINRAY_PERCEPTION_CONTACT_SENSOR_H_
#define FINRAY_PERCEPTION_CONTACT_SENSOR_H_

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "finray/finger/finger.h"
#include "finray/io/frame_table.h"
#include "finray/scene/measurement_columns.h"
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
/// (FingerVariations).
struct SensedContact {
  PointContact contact;
  Eigen::Vector3d pose;
  Eigen::Matrix4d covariance;
};

struct SensedFrame {
  FrameStatus status;
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
  /// For contacts that have been estimated before, with the covariance of
  /// (l_c, f_c) of each.
  SensedFrame At(const std::vector<PointContact>& contacts,
                 const ContactMatrix& covariance);

 private:
  Scene scene_;
  FrameEstimator estimator_;
  EquilibriumSolver solver_;
};

/// Reads all rows of a table that records the object's place in each. Throws
/// InputError if a column is missing, and at the line of a row without a place.
std::vector<Measurements> ReadWithPlaces(
    const FrameTable& table, const Finger& finger,
    const MeasurementColumns::Options& options = {});

/// A finger and the change of the friction coefficient that goes with it.
struct FingerVariation {
  Finger finger;
  double friction = 0;
};

/// The finger and the friction moved by each principal error of what is known
/// of them: with C_pp = F F' the covariance of ForFriction's parameters p, one
/// variation for each column of F that is not zero. Empty if nothing is
/// uncertain. Their share in the error of any result y(p) is, to first order,
///
///   cov y = sum_k (y(p + F_k) - y(p)) (y(p + F_k) - y(p))'.
///
/// All frames share these errors, so y may be computed from any number of them.
inline std::vector<FingerVariation> FingerVariations(
    const Finger& finger, const KnownFriction& friction) {
  std::vector<FingerVariation> variations;
  const auto calibration = ForFriction(finger, friction).calibration;
  if (!calibration) return variations;
  const Eigen::MatrixXd factor = calibration->Factor();
  for (Eigen::Index k = 0; k < factor.cols(); ++k) {
    if (factor.col(k).isZero(0)) continue;
    FingerVariation varied{finger};
    for (std::size_t i = 0; i < calibration->parameters.size(); ++i) {
      const FingerParameter& parameter = calibration->parameters[i];
      const double change = factor(static_cast<Eigen::Index>(i), k);
      if (parameter.kind == FingerParameterKind::kFriction) {
        varied.friction = change;
        continue;
      }
      SetParameter(parameter, ParameterValue(finger, parameter) + change,
                   &varied.finger);
    }
    variations.push_back(varied);
  }
  return variations;
}

/// One contact as a constraint on an outline, in the object's own frame (mm,
/// rad):
///
///   point = R(-a) (r - p),   normal angle = theta - pi/2 - a.
///
/// r and theta are those of the front beam at the contact; p and a are position
/// and angle of the object in frame S. The outline passes through the point,
/// its outward normal there has that angle and points into the finger, and the
/// whole outline lies on one side of the beam.
struct Touch {
  std::size_t row;  ///< of the table, from 0
  Eigen::Vector2d point_mm;
  double normal_angle_rad;
  double normal_N;
  Eigen::Matrix3d covariance;  ///< of (x, y, normal angle)
  /// The front beam from base to tip, and the arc length of the contact on it.
  std::vector<Eigen::Vector2d> beam_mm;
  double contact_arc_mm;
  double beam_length_mm;

  Eigen::Vector2d Normal() const;
  /// The part of the beam within `reach_mm` of the contact.
  std::vector<Eigen::Vector2d> BeamNear(double reach_mm) const;
};

/// All touches of a table, and how many of its rows had which status.
struct Touches {
  std::vector<Touch> usable;
  std::map<FrameStatus, std::size_t> rows;

  std::size_t all_rows() const;
};

/// Senses every row of a table. A row needs object_x_mm and object_y_mm
/// (object_angle_deg defaults to 0), and its gauges. A table without gauge
/// columns needs contact_<c>_mm and normal_<c>_N with their std instead. Throws
/// InputError at the line of a row that lacks the object's place or a std.
Touches SenseTouches(const FrameTable& table, const Finger& finger,
                     const Scene& scene, const Discretization& discretization);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_CONTACT_SENSOR_H_
