#include "finray/perception/compliance.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "finray/io/error.h"
#include "finray/perception/finger_variations.h"

namespace finray {
namespace {

constexpr double kFrom = 0.2, kTo = 0.8;

// Loads of one finger in one log, and the text that says whose they are.
struct LogLoads {
  SensedLoads loads;
  std::vector<std::string> object, trial;  // of each row
};

std::vector<std::string> TextOr(const FrameTable& table, const char* column,
                                const std::string& otherwise) {
  if (!table.Has(column)) {
    return std::vector<std::string>(table.rows(), otherwise);
  }
  FrameTable copy = table;
  return copy.MutableText(column);
}

LogLoads Sense(const FrameTable& table, const std::string& name,
               const ComplianceFinger& finger, ContactSensor* sensor) {
  return {SenseLoads(table, sensor, finger.finger),
          TextOr(table, "object", name), TextOr(table, "trial", "1")};
}

double RadiusOf(const Scene& scene) {
  return scene.circle_radius_mm().value_or(0);
}

SliderDirection DirectionOf(const SensedLoads& loads, const Scene& scene,
                            const ComplianceSettings& settings) {
  if (settings.direction_rad) return {*settings.direction_rad, std::nan("")};
  if (scene.object && scene.object->spring) {
    return {scene.object->spring->direction_rad, std::nan("")};
  }
  return EstimateDirection(loads, RadiusOf(scene));
}

SensedLoads RowsOf(const LogLoads& log, const std::string& object,
                   const std::string& trial) {
  SensedLoads part;
  for (std::size_t row = 0; row < log.object.size(); ++row) {
    part.rows += log.object[row] == object && log.trial[row] == trial;
  }
  for (const SensedLoads::Load& load : log.loads.loads) {
    if (log.object[load.row] == object && log.trial[load.row] == trial) {
      part.loads.push_back(load);
    }
  }
  return part;
}

// Trials of a log in the order of their first rows.
std::vector<std::pair<std::string, std::string>> TrialsOf(const LogLoads& log) {
  std::vector<std::pair<std::string, std::string>> trials;
  for (std::size_t row = 0; row < log.object.size(); ++row) {
    const std::pair<std::string, std::string> key(log.object[row],
                                                  log.trial[row]);
    if (std::find(trials.begin(), trials.end(), key) == trials.end()) {
      trials.push_back(key);
    }
  }
  return trials;
}

std::vector<ComplianceTrial> Trials(const std::vector<ComplianceLog>& logs,
                                    const ComplianceFinger& first,
                                    const ComplianceFinger* second,
                                    const Discretization& discretization,
                                    const ComplianceSettings& settings) {
  ContactSensor sensor(first.finger, first.scene, discretization);
  std::optional<ContactSensor> other;
  if (second != nullptr) {
    other.emplace(second->finger, second->scene, discretization);
  }
  std::vector<ComplianceTrial> trials;
  for (const ComplianceLog& log : logs) {
    const LogLoads loads = Sense(log.first, log.name, first, &sensor);
    std::optional<LogLoads> opposite;
    if (log.second) {
      if (log.second->rows() != log.first.rows()) {
        throw InputError(log.second->path() + ": has " +
                         std::to_string(log.second->rows()) + " rows, " +
                         log.first.path() + " has " +
                         std::to_string(log.first.rows()) +
                         "; both fingers need the same rows");
      }
      opposite = Sense(*log.second, log.name, *second, &*other);
    }
    for (const auto& [object, name] : TrialsOf(loads)) {
      ComplianceTrial trial;
      trial.object = object;
      trial.name = name;
      const SensedLoads part = RowsOf(loads, object, name);
      trial.rows = part.rows;
      try {
        trial.direction = DirectionOf(part, first.scene, settings);
        trial.points =
            ForcePoints(part, trial.direction.angle_rad, RadiusOf(first.scene),
                        settings.stage_std_mm);
        if (opposite) {
          SensedLoads facing = opposite->loads;
          trial.points = SqueezePoints(
              trial.points,
              ForcePoints(
                  facing,
                  DirectionOf(facing, second->scene, settings).angle_rad,
                  RadiusOf(second->scene), settings.stage_std_mm));
        }
        MarkDirections(settings.stage_std_mm, &trial.points);
        trial.fit = FitStiffness(trial.points, settings.most_degree);
      } catch (const InputError& error) {
        throw InputError(log.first.path() + ": object '" + object +
                         "', trial '" + name + "': " + error.what());
      }
      trials.push_back(trial);
    }
  }
  return trials;
}

void Compare(double from_N, double to_N, Compliance* result) {
  result->from_N = from_N;
  result->to_N = to_N;
  std::vector<std::string> names;
  std::map<std::string, std::vector<Stiffness>> by_object;
  for (ComplianceTrial& trial : result->trials) {
    trial.stiffness = StiffnessBetween(trial.fit, from_N, to_N);
    auto& of_object = by_object[trial.object];
    if (of_object.empty()) names.push_back(trial.object);
    of_object.push_back(trial.stiffness);
  }
  for (const std::string& name : names) {
    ObjectStiffness object;
    object.name = name;
    object.trials = by_object[name];
    object.mean = MeanStiffness(object.trials);
    result->objects.push_back(object);
  }
  result->pair_confidence = SortByStiffness(&result->objects);
  result->order_confidence = OrderConfidence(result->objects);
}

// The change of every object's stiffness, finger by finger.
void AddCalibration(const std::vector<ComplianceLog>& logs,
                    const ComplianceFinger& first,
                    const ComplianceFinger* second, bool vary_second,
                    const Discretization& discretization,
                    const ComplianceSettings& settings, Compliance* result) {
  const ComplianceFinger& varying = vary_second ? *second : first;
  for (const Finger& finger : FingerVariations(varying.finger)) {
    const ComplianceFinger varied{finger, varying.scene};
    Compliance other;
    other.trials = vary_second
                       ? Trials(logs, first, &varied, discretization, settings)
                       : Trials(logs, varied, second, discretization, settings);
    Compare(result->from_N, result->to_N, &other);
    for (ObjectStiffness& object : result->objects) {
      for (const ObjectStiffness& moved : other.objects) {
        if (moved.name != object.name) continue;
        object.calibration_std = std::hypot(
            object.calibration_std, moved.mean.N_per_mm - object.mean.N_per_mm);
      }
    }
  }
}

}  // namespace

Compliance MeasureCompliance(const std::vector<ComplianceLog>& logs,
                             const ComplianceFinger& first,
                             const ComplianceFinger* second,
                             const Discretization& discretization,
                             const ComplianceSettings& settings) {
  Compliance result;
  result.trials = Trials(logs, first, second, discretization, settings);
  double common = result.trials.front().fit.largest_force_N;
  for (const ComplianceTrial& trial : result.trials) {
    common = std::min(common, trial.fit.largest_force_N);
  }
  const double from = settings.from_N.value_or(kFrom * common);
  const double to = settings.to_N.value_or(kTo * common);
  if (!(to > from)) {
    throw InputError("stiffness is compared between two forces, found " +
                     std::to_string(from) + " and " + std::to_string(to) +
                     " N; the second must be larger");
  }
  Compare(from, to, &result);
  AddCalibration(logs, first, second, false, discretization, settings, &result);
  if (second != nullptr) {
    AddCalibration(logs, first, second, true, discretization, settings,
                   &result);
  }
  return result;
}

}  // namespace finray
