#include "finray/control/experiment_yaml.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

using Eigen::Vector2d;

Scene ReadLoopScene(const YamlMap& yaml) {
  const auto file = [&] {
    const auto folder = std::filesystem::path(yaml.path()).parent_path();
    return ReadScene((folder / yaml.Text("scene")).string());
  };
  Scene scene = yaml.IsMap("scene") ? ReadScene(yaml.Map("scene")) : file();
  const char* missing = nullptr;
  if (!scene.object) missing = "an object";
  if (scene.contacts) missing = "contacts: auto, one or none being decided";
  if (scene.object_std_mm) missing = "no measurements: nobody sees the object";
  if (missing != nullptr) {
    yaml.Fail("scene", std::string("scene: a control loop needs ") + missing);
  }
  RefuseBackContacts(scene);
  scene.most_contacts = 1;
  return scene;
}

Trajectory::Shape ReadTrajectory(const YamlMap& yaml, const std::string& unit,
                                 bool with_mean) {
  const std::string type =
      yaml.Choice("type", {"constant", "harmonic", "triangular", "steps"});
  if (type == "constant") {
    yaml.AllowOnly({"type", "value_" + unit});
    return ConstantTrajectory{yaml.Number("value_" + unit)};
  }
  if (type == "steps") {
    yaml.AllowOnly({"type", "levels_" + unit, "hold_s", "ramp_s"});
    StepTrajectory steps{yaml.Numbers("levels_" + unit),
                         yaml.PositiveNumber("hold_s"),
                         yaml.NonNegativeNumber("ramp_s", 0)};
    if (steps.ramp_s > steps.hold_s) {
      yaml.Fail("ramp_s", "ramp_s: expected hold_s at most");
    }
    if (steps.levels.empty()) {
      yaml.Fail("levels_" + unit, "levels_" + unit + ": expected a level");
    }
    return steps;
  }
  std::vector<std::string> keys = {"type", "amplitude_" + unit, "period_s"};
  if (with_mean) keys.push_back("mean_" + unit);
  yaml.AllowOnly(keys);
  const double mean = with_mean ? yaml.Number("mean_" + unit) : 0;
  const double amplitude = yaml.Number("amplitude_" + unit);
  const double period = yaml.PositiveNumber("period_s");
  if (type == "harmonic") return HarmonicTrajectory{mean, amplitude, period};
  return TriangularTrajectory{mean, amplitude, period};
}

double Least(const Trajectory& trajectory, double duration_s) {
  double least = trajectory.At(0);
  for (int i = 0; i <= 1000; ++i) {
    least = std::min(least, trajectory.At(duration_s * i / 1000));
  }
  return least;
}

Vector2d Point(const YamlMap& yaml, const std::string& key) {
  const std::vector<double> numbers = yaml.Numbers(key);
  if (numbers.size() != 2) yaml.Fail(key, key + ": expected [x, y]");
  return {numbers[0], numbers[1]};
}

Mechanism ReadMechanism(const YamlMap& yaml) {
  if (!yaml.Has("gripper")) return {};
  const YamlMap map = yaml.Map("gripper");
  map.AllowOnly({"crank_pivot_mm", "crank_joint_mm", "rocker_pivot_mm",
                 "rocker_joint_mm"});
  const FourBarJoints joints = {
      Point(map, "crank_pivot_mm"), Point(map, "crank_joint_mm"),
      Point(map, "rocker_pivot_mm"), Point(map, "rocker_joint_mm")};
  try {
    return Mechanism(FourBar(joints));
  } catch (const std::invalid_argument& error) {
    yaml.Fail("gripper", std::string("gripper: ") + error.what());
  }
}

// Speeds of a stage are in mm/s, those of a gripper's motor in deg/s.
double Speed(const YamlMap& yaml, const std::string& key, bool gripper) {
  return gripper ? kDegree * yaml.PositiveNumber(key + "_deg_s")
                 : yaml.PositiveNumber(key + "_mm_s");
}
std::string SpeedKey(const std::string& key, bool gripper) {
  return key + (gripper ? "_deg_s" : "_mm_s");
}

void ReadActuation(const YamlMap& map, Experiment* experiment) {
  const bool gripper = experiment->mechanism.is_gripper();
  map.AllowOnly({"rate_Hz", "delay_ms", "true_delay_ms", "time_constant_ms",
                 "drive_is_measured", SpeedKey("speed_limit", gripper)});
  ActuatorSettings& actuation = experiment->actuation;
  actuation.period_s = 1 / map.PositiveNumber("rate_Hz");
  actuation.delay_s = 1e-3 * map.NonNegativeNumber("delay_ms");
  actuation.time_constant_s =
      1e-3 * map.NonNegativeNumber("time_constant_ms", 0);
  experiment->drive_is_measured =
      map.Boolean("drive_is_measured", experiment->drive_is_measured);
  actuation.speed_limit = Speed(map, "speed_limit", gripper);
  experiment->true_delay_s =
      1e-3 * map.NonNegativeNumber("true_delay_ms", 1e3 * actuation.delay_s);
}

ControllerSettings ReadController(const YamlMap& map, const Finger& finger) {
  ControllerSettings settings;
  const std::string type = map.Choice("type", {"model", "pi", "none"});
  settings.name = map.Text("name", type);
  if (settings.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMN"
                                      "OPQRSTUVWXYZ0123456789_-") !=
      std::string::npos) {
    map.Fail("name", "name: expected letters, digits, _ and -: files get it");
  }
  if (type == "none") {
    map.AllowOnly({"type", "name"});
    settings.kind = ControllerKind::kNone;
    return settings;
  }
  settings.preview = map.Boolean("preview", false);
  if (type == "pi") {
    map.AllowOnly({"type", "name", "preview", "tuned_at_mm"});
    settings.kind = ControllerKind::kPi;
    settings.tuned_at_mm =
        map.PositiveNumber("tuned_at_mm", 0.5 * finger.front_length_mm);
    if (!(settings.tuned_at_mm < finger.front_length_mm)) {
      map.Fail("tuned_at_mm", "tuned_at_mm: expected a height on the finger");
    }
    return settings;
  }
  map.AllowOnly({"type", "name", "preview", "object_acceleration_mm_s2",
                 "object_compliance_mm_per_N"});
  ObjectPrior& prior = settings.prior;
  prior.acceleration_mm_s2 =
      map.PositiveNumber("object_acceleration_mm_s2", prior.acceleration_mm_s2);
  prior.compliance_mm_per_N = map.NonNegativeNumber(
      "object_compliance_mm_per_N", prior.compliance_mm_per_N);
  return settings;
}

void ReadControllers(const YamlMap& yaml, const Finger& finger,
                     Experiment* experiment) {
  std::set<std::string> names;
  for (const YamlMap& map : yaml.Maps("controllers")) {
    experiment->controllers.push_back(ReadController(map, finger));
    const std::string& name = experiment->controllers.back().name;
    if (!names.insert(name).second) {
      map.Fail("type", "two controllers are called '" + name +
                           "'; give one a name: of its own");
    }
  }
  if (experiment->controllers.empty()) {
    yaml.Fail("controllers", "controllers: expected one or more");
  }
}

void ReadSafety(const YamlMap& yaml, Experiment* experiment) {
  const bool gripper = experiment->mechanism.is_gripper();
  Safety& safety = experiment->safety;
  if (gripper) safety.approach_speed = 4 * kDegree;
  if (!yaml.Has("safety")) return;
  const YamlMap map = yaml.Map("safety");
  const std::string speed = SpeedKey("approach_speed", gripper);
  map.AllowOnly({"force_std_limit_N", "hold_s", "touch_N", speed});
  safety.force_std_limit_N =
      map.PositiveNumber("force_std_limit_N", safety.force_std_limit_N);
  safety.hold_s = map.NonNegativeNumber("hold_s", safety.hold_s);
  safety.touch_N = map.PositiveNumber("touch_N", safety.touch_N);
  if (map.Has(speed)) {
    safety.approach_speed = Speed(map, "approach_speed", gripper);
  }
}

void ReadModelError(const YamlMap& yaml, Experiment* experiment) {
  if (!yaml.Has("model_error")) return;
  const YamlMap map = yaml.Map("model_error");
  map.AllowOnly({"stiffness_std_percent", "gauge_gain_std_percent",
                 "gauge_offset_std_V", "rib_length_std_mm", "delay_std_ms"});
  experiment->model_error = {map.NonNegativeNumber("stiffness_std_percent", 0),
                             map.NonNegativeNumber("gauge_gain_std_percent", 0),
                             map.NonNegativeNumber("gauge_offset_std_V", 0),
                             map.NonNegativeNumber("rib_length_std_mm", 0)};
  experiment->delay_std_s = 1e-3 * map.NonNegativeNumber("delay_std_ms", 0);
}

void ReadGaugeLoss(const YamlMap& yaml, const Finger& finger,
                   Experiment* experiment) {
  if (!yaml.Has("gauge_loss")) return;
  const YamlMap map = yaml.Map("gauge_loss");
  map.AllowOnly({"from_s", "to_s", "gauges"});
  GaugeLoss loss{map.Number("from_s"), map.Number("to_s"), {}};
  if (!(loss.to_s > loss.from_s)) {
    map.Fail("to_s", "to_s: expected more than from_s");
  }
  const double most = static_cast<double>(finger.gauges.size());
  for (const double gauge : map.Numbers("gauges")) {
    if (!(gauge >= 1 && gauge <= most && gauge == std::floor(gauge))) {
      map.Fail("gauges", "gauges: expected numbers from 1 to " +
                             std::to_string(finger.gauges.size()));
    }
    loss.gauges.push_back(static_cast<int>(gauge) - 1);
  }
  experiment->gauge_loss = loss;
}

void ReadStart(const YamlMap& yaml, const Finger& finger,
               Experiment* experiment) {
  const YamlMap map = yaml.Map("object_start");
  map.AllowOnly({"y_mm", "gap_mm", "angle_deg"});
  ObjectStart& start = experiment->start;
  start = {map.Number("y_mm"), kDegree * map.Number("angle_deg", 0),
           map.NonNegativeNumber("gap_mm", start.gap_mm)};
  if (!(start.y_mm > 0 && start.y_mm < finger.front_length_mm)) {
    map.Fail("y_mm", "y_mm: expected a height between the front beam's ends");
  }
  if (experiment->mechanism.is_gripper()) {
    const RigidObject& object = *experiment->scene.object;
    if (object.spring ||
        std::holds_alternative<RoundedPolygonOutline>(object.outline.shape())) {
      yaml.Fail("scene",
                "scene: between two fingers the object is a circle or an "
                "ellipse without a spring");
    }
    if (yaml.Has("object_motion")) {
      yaml.Fail("object_motion",
                "object_motion: between two fingers the object shifts freely");
    }
  }
}

void ReadRun(const YamlMap& yaml, Experiment* experiment) {
  const YamlMap map = yaml.Map("run");
  map.AllowOnly(
      {"zero_s", "duration_s", "measure_from_s", "settled_after_s", "draws"});
  experiment->zero_s = map.NonNegativeNumber("zero_s", experiment->zero_s);
  experiment->duration_s = map.PositiveNumber("duration_s");
  experiment->measure_from_s =
      map.NonNegativeNumber("measure_from_s", experiment->measure_from_s);
  experiment->settled_after_s =
      map.NonNegativeNumber("settled_after_s", experiment->settled_after_s);
  if (map.Has("draws")) experiment->draws = map.Integer("draws");
  if (experiment->draws < 1) map.Fail("draws", "draws: expected 1 or more");
  if (!(experiment->measure_from_s < experiment->duration_s)) {
    map.Fail("measure_from_s", "measure_from_s: expected less than duration_s");
  }
}

std::optional<PaperFigure> ReadPaper(const YamlMap& yaml) {
  if (!yaml.Has("paper")) return std::nullopt;
  const YamlMap map = yaml.Map("paper");
  map.AllowOnly({"figure", "rms_N", "max_N"});
  return PaperFigure{map.Integer("figure"), map.PositiveNumber("rms_N"),
                     map.PositiveNumber("max_N")};
}

}  // namespace

Experiment ReadExperiment(const std::string& path, const Finger& finger) {
  const YamlMap yaml = YamlMap::FromFile(path);
  yaml.AllowOnly({"schema_version", "name", "paper", "scene", "object_start",
                  "object_motion", "gripper", "actuation", "set_point",
                  "controllers", "safety", "model_error", "gauge_loss", "run"});
  if (yaml.Integer("schema_version") != 1) {
    yaml.Fail("schema_version", "expected 1");
  }
  Experiment experiment;
  experiment.name = yaml.Text("name");
  experiment.paper = ReadPaper(yaml);
  experiment.scene = ReadLoopScene(yaml);
  experiment.mechanism = ReadMechanism(yaml);
  ReadStart(yaml, finger, &experiment);
  if (yaml.Has("object_motion")) {
    experiment.motion = ReadTrajectory(yaml.Map("object_motion"), "mm", false);
  }
  ReadActuation(yaml.Map("actuation"), &experiment);
  ReadControllers(yaml, finger, &experiment);
  ReadRun(yaml, &experiment);
  const auto& all = experiment.controllers;
  const bool sensing_only =
      std::all_of(all.begin(), all.end(), [](const ControllerSettings& c) {
        return c.kind == ControllerKind::kNone;
      });
  if (!sensing_only || yaml.Has("set_point")) {
    const YamlMap map = yaml.Map("set_point");
    experiment.set_point = ReadTrajectory(map, "N", true);
    if (!(Least(experiment.set_point, experiment.duration_s) > 0)) {
      map.Fail("type", "set_point: expected forces above 0 all the time");
    }
  }
  ReadSafety(yaml, &experiment);
  ReadModelError(yaml, &experiment);
  ReadGaugeLoss(yaml, finger, &experiment);
  return experiment;
}

}  // namespace finray
