#ifndef FINRAY_CONTROL_MODEL_CONTROLLER_H_
#define FINRAY_CONTROL_MODEL_CONTROLLER_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/chain/se2.h"
#include "finray/control/controller.h"
#include "finray/control/drive.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// A circle pressed against a finger.
struct Push {
  double object_x_mm;         ///< of the circle's centre, in the world
  double arc_mm;              ///< l_c
  double stiffness_N_per_mm;  ///< df/dx of the contact, the circle's y held
};

/// The contact stiffness of a finger: the x at which a circle of radius R
/// causes a given force f. In frame S the circle that touches at l_c has the
/// centre
///
///   c(l_c, f) = r - R n,    n = (sin(theta), -cos(theta)),
///
/// with r and theta of the front beam at l_c. For a finger whose base is at T
/// and a circle at the height y, Newton's method solves [T c(l_c, f)]_y = y for
/// l_c. Then x = [T c]_x and, at constant y,
///
///   dx/df = x_f - x_l y_f / y_l
///
/// with the sensitivities of the statics. An object of unknown shape has the
/// radius 0, a point that slides along the finger.
class PushModel {
 public:
  PushModel(const Finger& finger, double radius_mm, double friction,
            const Discretization& discretization);

  /// The circle's centre in the world under a contact; nothing if there is no
  /// equilibrium.
  std::optional<Eigen::Vector2d> Centre(const Pose<double>& base, double arc_mm,
                                        double normal_N);

  /// The push with a given force at the height y, found from `arc_mm` on;
  /// nothing if the beam has no such contact.
  std::optional<Push> At(const Pose<double>& base, double y_mm, double normal_N,
                         double arc_mm);

 private:
  EquilibriumSolver solver_;
  double radius_mm_, friction_;
  // Slopes of the last centre, in the world.
  Eigen::Vector2d by_arc_, by_force_;
};

/// Assumptions about an unknown object.
struct ObjectPrior {
  /// Std of the acceleration of its motion, independent in every period.
  double acceleration_mm_s2 = 10;
  /// Std of its compliance; 0 for an object that is held rigidly.
  double compliance_mm_per_N = 0.5;
  /// Std of the time between a reading and the drive's position. The drive's
  /// motion in that time adds to the std of the place.
  double timing_std_s = 0.01;
};

/// Tracks an object that only the finger senses. PushModel turns an estimated
/// force F into the object's place z along x. An object on a spring of
/// compliance c yields to the force,
///
///   z = o - c F + noise,
///
/// with o its place without the force. A Kalman filter estimates x = (o, v, c),
///
///   o += v T + a T^2 / 2,    v += a T,    a ~ N(0, acceleration^2),    c >= 0.
///
/// It is linear, because F is known apart from its noise. A constant force does
/// not separate c from o; the control does not need it then.
class ObjectFilter {
 public:
  ObjectFilter(const ObjectPrior& prior, double period_s);

  bool started() const { return started_; }
  /// Forgets everything but the compliance.
  void Restart() { started_ = false; }

  /// Advances by a period.
  void Predict();
  /// Takes a place seen under a force, with its std.
  void Update(double place_mm, double force_N, double std_mm);

  /// o after `seconds` from now.
  double PlaceIn(double seconds) const { return x_[0] + seconds * x_[1]; }
  double velocity_mm_s() const { return x_[1]; }
  double compliance_mm_per_N() const { return x_[2]; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  ObjectPrior prior_;
  double period_s_;
  bool started_ = false;
  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

/// Force control with the finger's own model. In each period of length T
///
///  1. the present drive u is measured or follows from the commands so far;
///  2. the estimated force F tells the place of the object, z = X(F; u): the
///     mean of PushModel over the fingers, at the mean of the estimated
///     heights;
///  3. ObjectFilter predicts the object at the time h = delay + T, when this
///     period's command will have had its effect;
///  4. the wanted drive u* gives the force of the set-point there,
///     X(F_ref; u*) = o(h) - c F_ref;
///  5. the command takes the drive to u* (Actuator::CommandFor), with the
///     commands in flight taken into account.
///
/// Like Smith's predictor the loop acts on predicted errors, so with a right
/// model it contains no delay. It has no gain to tune: ObjectPrior and the
/// estimator's std decide how much one reading counts. With `preview` F_ref is
/// the set-point at the time h from now, otherwise the present one.
class ModelController : public Controller {
 public:
  /// `models` has one entry for each finger.
  ModelController(std::vector<PushModel> models, const Mechanism& mechanism,
                  const ObjectPrior& prior, double period_s, bool preview);

  double Next(double time_s, const std::vector<ContactEstimate>& contacts,
              const Trajectory& set_point, const Actuator& drive) override;
  void Skip() override { filter_.Predict(); }
  void Lost() override;

  const ObjectFilter& filter() const { return filter_; }

 private:
  struct MeanPush {
    double object_x_mm = 0, compliance_mm_per_N = 0;
    double variance_mm2 = 0;  // of object_x_mm, from those of the forces
  };

  bool SeeHeights(double drive, const std::vector<ContactEstimate>& contacts);
  // The mean push of all fingers under these forces.
  std::optional<MeanPush> PushAt(double drive,
                                 const std::vector<ContactEstimate>& contacts);
  std::optional<double> DriveFor(double force_N, double place_mm, double drive);

  std::vector<PushModel> models_;
  Mechanism mechanism_;
  ObjectFilter filter_;
  double period_s_, timing_std_s_;
  bool preview_;
  // Height of the object in each finger's world and the last contact there.
  std::vector<double> y_mm_, arc_mm_;
  int seen_ = 0;  // number of estimates in the mean height
  std::optional<double> last_drive_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_MODEL_CONTROLLER_H_
