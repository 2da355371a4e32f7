#ifndef FINRAY_CONTROL_ACTUATOR_H_
#define FINRAY_CONTROL_ACTUATOR_H_

#include <deque>

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

}  // namespace finray

#endif  // FINRAY_CONTROL_ACTUATOR_H_
