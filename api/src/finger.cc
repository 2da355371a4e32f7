#include "finray/finger/finger_yaml.h"
#include "finray/io/atomic_file.h"
#include "inside.h"

namespace finray::v1 {
namespace {

const Gauge& GaugeOf(const finray::Finger& finger, int gauge) {
  if (gauge < 0 || gauge >= static_cast<int>(finger.gauges.size())) {
    throw InputError("gauge " + std::to_string(gauge) + ": the finger has " +
                     std::to_string(finger.gauges.size()) + ", counted from 0");
  }
  return finger.gauges[static_cast<std::size_t>(gauge)];
}

}  // namespace

Finger::Finger(std::shared_ptr<const Inside> inside)
    : inside_(std::move(inside)) {}

Finger Finger::Read(const std::string& path) {
  return Guarded([&] {
    return Finger(std::make_shared<Inside>(
        Inside{ReadFinger(path), YamlText(path), path}));
  });
}

Finger Finger::FromYaml(const std::string& text, const std::string& name) {
  return Guarded([&] {
    return Finger(std::make_shared<Inside>(
        Inside{ReadFinger(YamlMap::FromText(text, name)), text, name}));
  });
}

std::string Finger::ToYaml() const { return FingerToYaml(inside_->finger); }

void Finger::Write(const std::string& path) const {
  Guarded([&] { WriteFileAtomically(path, ToYaml()); });
}

std::string Finger::name() const { return inside_->finger.name; }
std::string Finger::path() const { return inside_->path; }
double Finger::front_length_mm() const {
  return inside_->finger.front_length_mm;
}
double Finger::back_angle_rad() const { return inside_->finger.back_angle_rad; }
double Finger::front_stiffness_N_mm2() const {
  return inside_->finger.front_stiffness_N_mm2;
}
double Finger::back_stiffness_N_mm2() const {
  return inside_->finger.back_stiffness_N_mm2;
}
int Finger::ribs() const {
  return static_cast<int>(inside_->finger.ribs.size());
}
int Finger::gauges() const {
  return static_cast<int>(inside_->finger.gauges.size());
}
bool Finger::calibrated() const {
  return inside_->finger.calibration.has_value();
}
double Finger::GaugeAngle_rad(int gauge, double volts) const {
  return GaugeOf(inside_->finger, gauge).Angle(volts);
}
double Finger::GaugeVolts(int gauge, double angle_rad) const {
  return GaugeOf(inside_->finger, gauge).Volts(angle_rad);
}

}  // namespace finray::v1
