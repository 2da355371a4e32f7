#include "finray/control/experiment_settings.h"

#include <cmath>
#include <string>

#include "finray/io/yaml_emitter.h"

namespace finray {
namespace {

// A mapping on one line, begun and ended.
class Line {
 public:
  Line(const char* key, YamlEmitter* yaml) : yaml_(yaml) {
    if (key != nullptr) *yaml_ << YAML::Key << key << YAML::Value;
    *yaml_ << YAML::Flow << YAML::BeginMap;
  }
  ~Line() { *yaml_ << YAML::EndMap; }

  template <class T>
  Line& With(const std::string& key, const T& value) {
    YamlPair(yaml_, key, value);
    return *this;
  }

 private:
  YamlEmitter* yaml_;
};

void EmitController(const ControllerSettings& controller, YamlEmitter* yaml) {
  Line line(nullptr, yaml);
  switch (controller.kind) {
    case ControllerKind::kModel:
      line.With("type", "model")
          .With("name", controller.name)
          .With("preview", controller.preview)
          .With("object_acceleration_mm_s2",
                controller.prior.acceleration_mm_s2)
          .With("object_compliance_mm_per_N",
                controller.prior.compliance_mm_per_N);
      break;
    case ControllerKind::kPi:
      line.With("type", "pi")
          .With("name", controller.name)
          .With("preview", controller.preview)
          .With("tuned_at_mm", controller.tuned_at_mm);
      break;
    case ControllerKind::kNone:
      line.With("type", "none").With("name", controller.name);
      break;
  }
}

}  // namespace

void EmitSettings(const Experiment& experiment, YamlEmitter* yaml) {
  const bool gripper = experiment.mechanism.is_gripper();
  const double unit = gripper ? 180 / M_PI : 1;
  const std::string speed = gripper ? "_deg_s" : "_mm_s";
  *yaml << YAML::BeginMap;
  Line("object_start", yaml)
      .With("y_mm", experiment.start.y_mm)
      .With("gap_mm", experiment.start.gap_mm)
      .With("angle_deg", experiment.start.angle_rad * 180 / M_PI);
  const ActuatorSettings& actuation = experiment.actuation;
  Line("actuation", yaml)
      .With("rate_Hz", 1 / actuation.period_s)
      .With("delay_ms", 1e3 * actuation.delay_s)
      .With("true_delay_ms", 1e3 * experiment.true_delay_s)
      .With("time_constant_ms", 1e3 * actuation.time_constant_s)
      .With("drive_is_measured", experiment.drive_is_measured)
      .With("speed_limit" + speed, unit * actuation.speed_limit);
  *yaml << YAML::Key << "controllers" << YAML::Value << YAML::BeginSeq;
  for (const ControllerSettings& controller : experiment.controllers) {
    EmitController(controller, yaml);
  }
  *yaml << YAML::EndSeq;
  const Safety& safety = experiment.safety;
  Line("safety", yaml)
      .With("force_std_limit_N", safety.force_std_limit_N)
      .With("hold_s", safety.hold_s)
      .With("touch_N", safety.touch_N)
      .With("approach_speed" + speed, unit * safety.approach_speed);
  const ModelError& error = experiment.model_error;
  Line("model_error", yaml)
      .With("stiffness_std_percent", error.stiffness_percent)
      .With("gauge_gain_std_percent", error.gauge_gain_percent)
      .With("gauge_offset_std_V", error.gauge_offset_V)
      .With("rib_length_std_mm", error.rib_length_mm)
      .With("delay_std_ms", 1e3 * experiment.delay_std_s);
  Line("run", yaml)
      .With("zero_s", experiment.zero_s)
      .With("duration_s", experiment.duration_s)
      .With("measure_from_s", experiment.measure_from_s)
      .With("settled_after_s", experiment.settled_after_s)
      .With("draws", experiment.draws);
  *yaml << YAML::EndMap;
}

}  // namespace finray
