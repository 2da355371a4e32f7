#ifndef FINRAY_FINGER_H_
#define FINRAY_FINGER_H_

#include <memory>
#include <string>
#include <vector>

#include "finray/export.h"

namespace finray::v1 {

/// A Fin-Ray finger: two beams that are clamped at their bases and meet in a
/// tip, ribs between them and strain gauges on them. It is described by a
/// finger YAML (docs/reference/formats.md) and does not change; a calibration
/// returns another one. Copies share their memory.
class FINRAY_API Finger {
 public:
  /// Reads a finger YAML. Throws InputError (file:line:column).
  static Finger Read(const std::string& path);
  /// The same of a text; `name` stands for the path in messages.
  static Finger FromYaml(const std::string& text,
                         const std::string& name = "finger");

  /// The finger YAML. It reads back as the same doubles.
  std::string ToYaml() const;
  void Write(const std::string& path) const;

  std::string name() const;
  /// The path that the finger was read from, or the name of its text.
  std::string path() const;
  double front_length_mm() const;
  double back_angle_rad() const;
  double front_stiffness_N_mm2() const;
  double back_stiffness_N_mm2() const;
  int ribs() const;
  int gauges() const;
  /// Says that the finger carries the covariance of a calibration.
  bool calibrated() const;
  /// The bending angle of a gauge for each reading of it, and back, in rad and
  /// V. The gauge counts from 0.
  double GaugeAngle_rad(int gauge, double volts) const;
  double GaugeVolts(int gauge, double angle_rad) const;

  struct Inside;
  const Inside& inside() const { return *inside_; }
  explicit Finger(std::shared_ptr<const Inside> inside);

 private:
  std::shared_ptr<const Inside> inside_;
};

}  // namespace finray::v1

#endif  // FINRAY_FINGER_H_
