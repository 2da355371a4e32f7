#include "finray/perception/compliance.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "finray/io/error.h"
#include "finray/perception/contact_sensor.h"

namespace finray {
namespace {

// Defaults of the forces to compare between, over the largest common force.
constexpr double kFrom = 0.2, kTo = 0.8;

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

// A text column, or one with the same text in all rows.
std::vector<std::string> TextOr(const FrameTable& table, const char* column,
                                const std::string& otherwise) {
  if (!table.Has(column)) {
    return std::vector<std::string>(table.rows(), otherwise);
  }
  FrameTable copy = table;
  return copy.MutableText(column);
}

// The trials of a log with their loads, in the order of their first rows.
struct TrialLoads {
  std::string object, name;
  SensedLoads loads;
};
std::vector<TrialLoads> SplitByTrial(const ComplianceLog& log,
                                     const SensedLoads& all) {
  const auto object = TextOr(log.tables[0], "object", log.name);
  const auto name = TextOr(log.tables[0], "trial", "1");
  std::vector<TrialLoads> trials;
  const auto trial_of = [&](std::size_t row) -> SensedLoads& {
    for (TrialLoads& trial : trials) {
      if (trial.object == object[row] && trial.name == name[row]) {
        return trial.loads;
      }
    }
    return trials.emplace_back(TrialLoads{object[row], name[row], {}}).loads;
  };
  for (std::size_t row = 0; row < all.rows; ++row) ++trial_of(row).rows;
  for (const SensedLoads::Load& load : all.loads) {
    trial_of(load.row).loads.push_back(load);
  }
  return trials;
}

// What each finger senses of a log.
std::vector<SensedLoads> SenseLog(const ComplianceLog& log,
                                  const std::vector<ComplianceFinger>& fingers,
                                  std::deque<ContactSensor>* sensors) {
  std::vector<SensedLoads> sensed;
  for (std::size_t f = 0; f < fingers.size(); ++f) {
    const FrameTable &table = log.tables[f], &first = log.tables[0];
    if (table.rows() != first.rows()) {
      throw InputError(table.path() + ": has " + std::to_string(table.rows()) +
                       " rows, " + first.path() + " has " +
                       std::to_string(first.rows()) +
                       "; both fingers need the same rows");
    }
    sensed.push_back(SenseLoads(table, &(*sensors)[f], fingers[f].finger));
  }
  return sensed;
}

std::vector<ComplianceTrial> Trials(
    const std::vector<ComplianceLog>& logs,
    const std::vector<ComplianceFinger>& fingers,
    const Discretization& discretization, const ComplianceSettings& settings) {
  std::deque<ContactSensor> sensors;
  for (const ComplianceFinger& f : fingers) {
    sensors.emplace_back(f.finger, f.scene, discretization);
  }
  const auto points_of = [&](const SensedLoads& loads, const Scene& scene,
                             const SliderDirection& direction) {
    return ForcePoints(loads, direction.angle_rad, RadiusOf(scene),
                       settings.stage_std_mm);
  };
  std::vector<ComplianceTrial> trials;
  for (const ComplianceLog& log : logs) {
    const std::vector<SensedLoads> sensed = SenseLog(log, fingers, &sensors);
    for (const auto& [object, name, loads] : SplitByTrial(log, sensed[0])) {
      ComplianceTrial& trial = trials.emplace_back();
      trial.object = object;
      trial.name = name;
      trial.rows = loads.rows;
      try {
        trial.direction = DirectionOf(loads, fingers[0].scene, settings);
        trial.points = points_of(loads, fingers[0].scene, trial.direction);
        for (std::size_t f = 1; f < fingers.size(); ++f) {
          const Scene& scene = fingers[f].scene;
          trial.points = SqueezePoints(
              trial.points, points_of(sensed[f], scene,
                                      DirectionOf(sensed[f], scene, settings)));
        }
        MarkDirections(settings.stage_std_mm, &trial.points);
        trial.fit = FitStiffness(trial.points, settings.most_degree);
      } catch (const InputError& error) {
        throw InputError(log.tables[0].path() + ": object '" + object +
                         "', trial '" + name + "': " + error.what());
      }
    }
  }
  return trials;
}

// The objects in the order of their first trials, compared between two forces.
std::vector<ObjectStiffness> Compare(double from_N, double to_N,
                                     std::vector<ComplianceTrial>* trials) {
  std::vector<ObjectStiffness> objects;
  for (ComplianceTrial& trial : *trials) {
    trial.stiffness = StiffnessBetween(trial.fit, from_N, to_N);
    auto object = std::find_if(
        objects.begin(), objects.end(),
        [&](const ObjectStiffness& o) { return o.name == trial.object; });
    if (object == objects.end()) {
      object = objects.insert(object, {trial.object, {}, {}, 0});
    }
    object->trials.push_back(trial.stiffness);
  }
  for (ObjectStiffness& object : objects) {
    object.mean = MeanStiffness(object.trials);
  }
  return objects;
}

}  // namespace

Stiffness MeanStiffness(const std::vector<Stiffness>& trials) {
  double weights = 0, sum = 0;
  for (const Stiffness& trial : trials) {
    const double weight = 1 / (trial.std * trial.std);
    weights += weight;
    sum += weight * trial.N_per_mm;
  }
  const double mean = sum / weights;
  double scatter = 0;
  for (const Stiffness& trial : trials) {
    const double off = (trial.N_per_mm - mean) / trial.std;
    scatter += off * off;
  }
  const auto count = static_cast<double>(trials.size());
  const double enlarged = count > 1 ? scatter / (count - 1) : 1;
  return {mean, std::sqrt(std::max(1.0, enlarged) / weights)};
}

std::vector<double> SortByStiffness(std::vector<ObjectStiffness>* objects) {
  std::stable_sort(objects->begin(), objects->end(),
                   [](const ObjectStiffness& a, const ObjectStiffness& b) {
                     return a.mean.N_per_mm > b.mean.N_per_mm;
                   });
  std::vector<double> confidence;
  for (std::size_t i = 0; i + 1 < objects->size(); ++i) {
    const Stiffness &a = (*objects)[i].mean, &b = (*objects)[i + 1].mean;
    const double off = (a.N_per_mm - b.N_per_mm) / std::hypot(a.std, b.std);
    confidence.push_back(0.5 * std::erfc(-off / std::sqrt(2.0)));
  }
  return confidence;
}

double OrderConfidence(const std::vector<ObjectStiffness>& objects,
                       std::uint64_t seed, int draws) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  int right = 0;
  for (int draw = 0; draw < draws; ++draw) {
    double before = 0;
    bool sorted = true;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const Stiffness& mean = objects[i].mean;
      const double drawn = mean.N_per_mm + mean.std * normal(generator);
      sorted = sorted && (i == 0 || drawn < before);
      before = drawn;
    }
    right += sorted;
  }
  return static_cast<double>(right) / draws;
}

Compliance MeasureCompliance(const std::vector<ComplianceLog>& logs,
                             const std::vector<ComplianceFinger>& fingers,
                             const Discretization& discretization,
                             const ComplianceSettings& settings) {
  Compliance result;
  result.trials = Trials(logs, fingers, discretization, settings);
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
  result.from_N = from;
  result.to_N = to;
  result.objects = Compare(from, to, &result.trials);
  // The changes of each object's stiffness add up over the variations of each
  // finger.
  for (std::size_t f = 0; f < fingers.size(); ++f) {
    std::vector<ComplianceFinger> varied = fingers;
    for (const Finger& finger : FingerVariations(fingers[f].finger)) {
      varied[f].finger = finger;
      auto trials = Trials(logs, varied, discretization, settings);
      const auto moved = Compare(from, to, &trials);
      for (std::size_t i = 0; i < moved.size(); ++i) {
        ObjectStiffness& object = result.objects[i];
        object.calibration_std =
            std::hypot(object.calibration_std,
                       moved[i].mean.N_per_mm - object.mean.N_per_mm);
      }
    }
  }
  result.pair_confidence = SortByStiffness(&result.objects);
  result.order_confidence = OrderConfidence(result.objects);
  return result;
}

}  // namespace finray
