#include "finray/control/experiment.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <variant>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

using Eigen::Vector2d;

enum Range { kAny, kNonNegative, kPositive };

// A value of an experiment with its key in the YAML. A number has a unit there,
// in the units of the program (1e-3 for a key in ms); a rate is stored as its
// period.
struct Field {
  std::string key;
  std::variant<double*, int*, bool*> value;
  Range range = kNonNegative;
  double unit = 1;
  bool required = false;
  bool is_rate = false;
  bool varies = false;  // its default depends on other values
};
using Fields = std::vector<Field>;

// Returns a number as it stands in the YAML.
double Written(const Field& field) {
  const double number = *std::get<double*>(field.value);
  return field.is_rate ? 1 / number : number / field.unit;
}

// Reads the fields of a mapping, which may have `other` keys too.
void Read(const YamlMap& map, const Fields& fields,
          std::vector<std::string> other = {}) {
  for (const Field& field : fields) other.push_back(field.key);
  map.AllowOnly(other);
  for (const Field& field : fields) {
    const std::string& key = field.key;
    // A default keeps its bits, which a change of its unit would round.
    if (!field.required && !map.Has(key)) continue;
    if (auto* flag = std::get_if<bool*>(&field.value)) {
      **flag = map.Boolean(key, **flag);
    } else if (auto* count = std::get_if<int*>(&field.value)) {
      **count = map.Integer(key, **count);
    } else {
      const auto read = [&](auto... fallback) {
        return field.range == kAny ? map.Number(key, fallback...)
               : field.range == kPositive
                   ? map.PositiveNumber(key, fallback...)
                   : map.NonNegativeNumber(key, fallback...);
      };
      const bool has_default = !field.required && !field.varies;
      const double number =
          field.unit * (has_default ? read(Written(field)) : read());
      *std::get<double*>(field.value) = field.is_rate ? 1 / number : number;
    }
  }
}

void Emit(const Fields& fields, YamlEmitter* yaml) {
  for (const Field& field : fields) {
    if (auto* flag = std::get_if<bool*>(&field.value)) {
      YamlPair(yaml, field.key, **flag);
    } else if (auto* count = std::get_if<int*>(&field.value)) {
      YamlPair(yaml, field.key, **count);
    } else {
      YamlPair(yaml, field.key, Written(field));
    }
  }
}

// Mappings of values by their keys. Speeds of a stage are in mm/s, those of a
// gripper's motor in deg/s.
std::map<std::string, Fields> Mappings(Experiment* e) {
  const std::string per_s = e->mechanism.is_gripper() ? "_deg_s" : "_mm_s";
  const double speed = e->mechanism.is_gripper() ? kDegree : 1;
  ActuatorSettings& actuation = e->actuation;
  Safety& safety = e->safety;
  ModelError& error = e->model_error;
  return {
      {"object_start",
       {{"y_mm", &e->start.y_mm, kAny, 1, true},
        {"gap_mm", &e->start.gap_mm},
        {"angle_deg", &e->start.angle_rad, kAny, kDegree}}},
      {"actuation",
       {{"rate_Hz", &actuation.period_s, kPositive, 1, true, true},
        {"delay_ms", &actuation.delay_s, kNonNegative, 1e-3, true},
        {"true_delay_ms", &e->true_delay_s, kNonNegative, 1e-3, false, false,
         true},
        {"time_constant_ms", &actuation.time_constant_s, kNonNegative, 1e-3},
        {"speed_limit" + per_s, &actuation.speed_limit, kPositive, speed, true},
        {"drive_is_measured", &e->drive_is_measured}}},
      {"safety",
       {{"force_std_limit_N", &safety.force_std_limit_N, kPositive},
        {"hold_s", &safety.hold_s},
        {"touch_N", &safety.touch_N, kPositive},
        {"approach_speed" + per_s, &safety.approach_speed, kPositive, speed}}},
      {"model_error",
       {{"stiffness_std_percent", &error.stiffness_percent},
        {"gauge_gain_std_percent", &error.gauge_gain_percent},
        {"gauge_offset_std_V", &error.gauge_offset_V},
        {"rib_length_std_mm", &error.rib_length_mm},
        {"delay_std_ms", &e->delay_std_s, kNonNegative, 1e-3}}},
      {"run",
       {{"zero_s", &e->zero_s},
        {"duration_s", &e->duration_s, kPositive, 1, true},
        {"measure_from_s", &e->measure_from_s},
        {"settled_after_s", &e->settled_after_s},
        {"draws", &e->draws}}}};
}

// Reads one of these mappings.
YamlMap ReadMapping(const YamlMap& yaml, const std::string& key,
                    Experiment* experiment) {
  YamlMap map = yaml.Map(key);
  Read(map, Mappings(experiment)[key]);
  return map;
}

Fields ControllerFields(ControllerSettings* controller) {
  if (controller->kind == ControllerKind::kNone) return {};
  const Field preview{"preview", &controller->preview};
  if (controller->kind == ControllerKind::kPi) {
    return {preview,
            {"tuned_at_mm", &controller->tuned_at_mm, kPositive, 1, false,
             false, true}};
  }
  ObjectPrior& prior = controller->prior;
  return {preview,
          {"object_acceleration_mm_s2", &prior.acceleration_mm_s2, kPositive},
          {"object_compliance_mm_per_N", &prior.compliance_mm_per_N}};
}

// In the order of ControllerKind.
constexpr const char* kControllerTypes[] = {"model", "pi", "none"};

Scene ReadLoopScene(const YamlMap& yaml) {
  const auto folder = std::filesystem::path(yaml.path()).parent_path();
  Scene scene = yaml.IsMap("scene")
                    ? ReadScene(yaml.Map("scene"))
                    : ReadScene((folder / yaml.Text("scene")).string());
  const char* missing = nullptr;
  if (!scene.object) missing = "an object";
  if (scene.contacts) missing = "contacts: auto";
  if (scene.object_std_mm) missing = "no measurements of the object";
  if (missing != nullptr) {
    yaml.Fail("scene", std::string("scene: a control loop needs ") + missing);
  }
  RefuseBackContacts(scene);
  scene.most_contacts = 1;
  return scene;
}

Trajectory ReadTrajectory(const YamlMap& yaml, const std::string& unit,
                          bool with_mean) {
  const std::string type =
      yaml.Choice("type", {"constant", "harmonic", "triangular", "steps"});
  if (type == "constant") {
    yaml.AllowOnly({"type", "value_" + unit});
    return {{yaml.Number("value_" + unit)}};
  }
  if (type == "steps") {
    yaml.AllowOnly({"type", "levels_" + unit, "hold_s", "ramp_s"});
    Trajectory steps{yaml.Numbers("levels_" + unit),
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
  return Trajectory::Wave(mean, amplitude, yaml.PositiveNumber("period_s"),
                          type == "triangular");
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
  const FourBar joints = {
      Point(map, "crank_pivot_mm"), Point(map, "crank_joint_mm"),
      Point(map, "rocker_pivot_mm"), Point(map, "rocker_joint_mm")};
  try {
    return Mechanism(joints);
  } catch (const std::invalid_argument& error) {
    yaml.Fail("gripper", std::string("gripper: ") + error.what());
  }
}

ControllerSettings ReadController(const YamlMap& map, const Finger& finger) {
  ControllerSettings settings;
  const std::vector<std::string> types(std::begin(kControllerTypes),
                                       std::end(kControllerTypes));
  const std::string type = map.Choice("type", types);
  settings.kind = static_cast<ControllerKind>(
      std::find(types.begin(), types.end(), type) - types.begin());
  settings.name = map.Text("name", type);
  if (settings.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMN"
                                      "OPQRSTUVWXYZ0123456789_-") !=
      std::string::npos) {
    map.Fail("name",
             "name: expected letters, digits, _ and -; files are named so");
  }
  settings.tuned_at_mm = 0.5 * finger.front_length_mm;
  Read(map, ControllerFields(&settings), {"type", "name"});
  if (!(settings.tuned_at_mm < finger.front_length_mm)) {
    map.Fail("tuned_at_mm", "tuned_at_mm: expected a height on the finger");
  }
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

std::optional<GaugeLoss> ReadGaugeLoss(const YamlMap& yaml,
                                       const Finger& finger) {
  if (!yaml.Has("gauge_loss")) return std::nullopt;
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
  return loss;
}

void ReadStart(const YamlMap& yaml, const Finger& finger,
               Experiment* experiment) {
  const YamlMap map = ReadMapping(yaml, "object_start", experiment);
  const double y_mm = experiment->start.y_mm;
  if (!(y_mm > 0 && y_mm < finger.front_length_mm)) {
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
  if (!ReadMapping(yaml, "actuation", &experiment).Has("true_delay_ms")) {
    experiment.true_delay_s = experiment.actuation.delay_s;
  }
  ReadControllers(yaml, finger, &experiment);
  const YamlMap run = ReadMapping(yaml, "run", &experiment);
  if (experiment.draws < 1 || experiment.draws > Experiment::kMostDraws) {
    run.Fail("draws",
             "draws: expected 1 to " + std::to_string(Experiment::kMostDraws));
  }
  if (!(experiment.measure_from_s < experiment.duration_s)) {
    run.Fail("measure_from_s", "measure_from_s: expected less than duration_s");
  }
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
  if (experiment.mechanism.is_gripper()) {
    experiment.safety.approach_speed = 4 * kDegree;
  }
  for (const char* key : {"safety", "model_error"}) {
    if (yaml.Has(key)) ReadMapping(yaml, key, &experiment);
  }
  experiment.gauge_loss = ReadGaugeLoss(yaml, finger);
  return experiment;
}

void EmitSettings(Experiment experiment, YamlEmitter* yaml) {
  std::map<std::string, Fields> mappings = Mappings(&experiment);
  const auto emit = [&](const char* key) {
    *yaml << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginMap;
    Emit(mappings[key], yaml);
    *yaml << YAML::EndMap;
  };
  *yaml << YAML::BeginMap;
  emit("object_start");
  emit("actuation");
  *yaml << YAML::Key << "controllers" << YAML::Value << YAML::BeginSeq;
  for (ControllerSettings& controller : experiment.controllers) {
    *yaml << YAML::Flow << YAML::BeginMap;
    YamlPairs(yaml, "type", kControllerTypes[static_cast<int>(controller.kind)],
              "name", controller.name);
    Emit(ControllerFields(&controller), yaml);
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndSeq;
  emit("safety");
  emit("model_error");
  emit("run");
  *yaml << YAML::EndMap;
}

}  // namespace finray
