#ifndef FINRAY_CONTROL_DRIVE_H_
#define FINRAY_CONTROL_DRIVE_H_

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "finray/chain/se2.h"

namespace finray {

/// Positions of a drive are in mm (stage) or rad (motor).
struct ActuatorSettings {
  double period_s = 1.0 / 30;  ///< between commands
  double delay_s = 0.13;       ///< between a command and its effect
  double time_constant_s = 0;  ///< tau of the position servo; 0: none
  double speed_limit = 1e9;    ///< per second
};

/// A position drive behind a delay. With c(t) the last command that is older
/// than the delay,
///
///   du/dt = (c - u) / tau, limited to the speed limit in both directions,
///
/// integrated exactly. The plant has one. A controller has a copy, which
/// predicts where the commands in flight will take the drive.
class Actuator {
 public:
  Actuator(const ActuatorSettings& settings, double start);

  const ActuatorSettings& settings() const { return settings_; }

  /// Gives a command. Times do not decrease.
  void Command(double time_s, double position);
  double last_command() const { return last_command_; }

  /// Advances to a time and returns the position there. Times do not decrease.
  double AdvanceTo(double time_s);
  /// Replaces the position by a measured one.
  void CorrectTo(double position) { position_ = position; }
  /// The position at a later time without further commands.
  double PredictAt(double time_s) const;
  /// The command at `time_s`, to be replaced a period later, that takes the
  /// drive to `position` at time_s + delay + period if its speed allows that.
  double CommandFor(double time_s, double position) const;

 private:
  struct InFlight {
    double arrives_s, position;
  };

  void Move(double seconds);

  ActuatorSettings settings_;
  double time_s_ = 0;
  double position_;
  double command_;  // in force
  double last_command_;
  std::deque<InFlight> in_flight_;
};

/// The position problem of a four-bar linkage. At the crank angle q the crank's
/// joint is B = A + R(q) (B_0 - A). The rocker's joint C is an intersection of
/// two circles: about B with the coupler's length, and about the rocker's pivot
/// D with the rocker's length. It is on the same side of BD as C_0 of B_0 D.
/// The coupler moves with B and C.
struct FourBar {
  /// The joints at crank angle 0: the pivots of crank and rocker on the ground,
  /// and their joints with the coupler.
  Eigen::Vector2d crank_pivot_mm, crank_joint_mm, rocker_pivot_mm,
      rocker_joint_mm;

  /// The displacement of the coupler since angle 0; nothing where the linkage
  /// cannot close.
  std::optional<Pose<double>> Coupler(double crank_rad) const;
};

/// Moves a finger with a drive. The world frame is frame S of the finger at
/// drive 0. A growing drive u moves the finger along -x, towards the object.
///
///  - Linear stage: u in mm, the finger is at (-u, 0).
///  - Gripper: u in rad is the crank angle, positive when it closes, of a
///    linkage whose coupler carries the finger. The same motor drives a second
///    finger, the mirror image of the first in a mirrored world of its own.
class Mechanism {
 public:
  /// A linear stage.
  Mechanism() = default;
  /// A gripper. Throws std::invalid_argument for joints of one link that
  /// coincide, if coupler and rocker are in line at angle 0, where C has no
  /// side, and for a linkage that does not move the finger towards the object.
  explicit Mechanism(const FourBar& joints);

  bool is_gripper() const { return four_bar_.has_value(); }
  int fingers() const { return is_gripper() ? 2 : 1; }

  /// Frame S in the world; nothing where the linkage cannot close.
  std::optional<Pose<double>> FingerPose(double drive) const;

  /// -dx/du of the finger's point at (0, y_mm) of the world, in mm per unit of
  /// the drive, by a central difference.
  double ApproachPerDrive(double drive, double y_mm) const;

 private:
  std::optional<FourBar> four_bar_;
  double sense_ = 1;  // of the crank when it closes
};

}  // namespace finray

#endif  // FINRAY_CONTROL_DRIVE_H_
