#ifndef FINRAY_CONTROL_ACTUATOR_H_
#define FINRAY_CONTROL_ACTUATOR_H_

#include <deque>

namespace finray {

/// A drive's position is in mm (stage) or rad (motor).
struct ActuatorSettings {
  double period_s = 1.0 / 30;  ///< between commands
  double delay_s = 0.13;       ///< from a command until the drive knows of it
  double time_constant_s = 0;  ///< tau of its position servo; 0: none
  double speed_limit = 1e9;    ///< per s
};

/// A position drive behind a delay: with c(t) the last command that is older
/// than the delay,
///
///   du/dt = (c - u) / tau, at most the speed limit either way,
///
/// integrated exactly. The plant has one, and a controller another one, which
/// tells it where its own commands in flight will take the drive.
class Actuator {
 public:
  Actuator(const ActuatorSettings& settings, double start);

  const ActuatorSettings& settings() const { return settings_; }

  /// A command, not older than the one before.
  void Command(double time_s, double position);
  /// The last one given.
  double last_command() const { return last_command_; }

  /// Goes on to a time and returns the position there. Times do not decrease.
  double AdvanceTo(double time_s);
  /// Where the drive is, as it has been measured.
  void CorrectTo(double position) { position_ = position; }
  /// The position at a later time, if no further command comes.
  double PredictAt(double time_s) const;
  /// The command that, given at `time_s` and replaced a period later, takes the
  /// drive to `position` at time_s + delay + period, if its speed allows it.
  double CommandFor(double time_s, double position) const;

 private:
  struct InFlight {
    double arrives_s, position;
  };

  void Move(double seconds);

  ActuatorSettings settings_;
  double time_s_ = 0;
  double position_;
  double command_;  // the one in force
  double last_command_;
  std::deque<InFlight> in_flight_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_ACTUATOR_H_
