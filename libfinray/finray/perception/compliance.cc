#include "finray/perception/compliance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "finray/io/error.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr double kMoved = 3;  // std
constexpr int kDraws = 20000;

// Defaults of the forces to compare between, over the largest common force.
constexpr double kFrom = 0.2, kTo = 0.8;

double RadiusOf(const Scene& scene) {
  return scene.circle_radius_mm().value_or(0);
}

SliderDirection DirectionOf(const std::vector<SensedLoad>& loads,
                            const Scene& scene,
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

// The trials of a log in the order of their first rows.
std::vector<ComplianceTrial> SplitByTrial(
    const ComplianceLog& log, const std::vector<SensedLoad>& loads) {
  const auto object = TextOr(log.tables[0], "object", log.name);
  const auto name = TextOr(log.tables[0], "trial", "1");
  std::vector<ComplianceTrial> trials;
  const auto trial_of = [&](std::size_t row) -> ComplianceTrial& {
    for (ComplianceTrial& trial : trials) {
      if (trial.object == object[row] && trial.name == name[row]) return trial;
    }
    trials.emplace_back().object = object[row];
    trials.back().name = name[row];
    return trials.back();
  };
  for (std::size_t row = 0; row < object.size(); ++row) ++trial_of(row).rows;
  for (const SensedLoad& load : loads) {
    trial_of(load.row).loads.push_back(load);
  }
  return trials;
}

// The points of one trial.
std::vector<ForcePoint> ForcePoints(const std::vector<SensedLoad>& loads,
                                    double direction_rad, const Scene& scene,
                                    const ComplianceSettings& settings) {
  const double radius_mm = RadiusOf(scene),
               stage_std_mm = settings.stage_std_mm;
  const Vector2d e(std::cos(direction_rad), std::sin(direction_rad));
  std::vector<ForcePoint> points;
  for (const SensedLoad& load : loads) {
    const Eigen::Vector3d& pose = load.contact.pose;
    const Vector2d n(std::sin(pose[2]), -std::cos(pose[2]));
    const Vector2d t(std::cos(pose[2]), std::sin(pose[2]));  // dn/dtheta
    const double force = load.contact.contact.normal_N;
    ForcePoint& point = points.emplace_back();
    point.row = load.row;
    point.displacement_mm =
        e.dot(CircleCentre(pose, radius_mm) - load.place_mm);
    point.force_N = -force * n.dot(e);
    point.approach_mm = -e.dot(load.place_mm);
    Eigen::Matrix<double, 2, 4> slope;
    slope << e.x(), e.y(), -radius_mm * e.dot(t), 0, 0, 0, -force * e.dot(t),
        -e.dot(n);
    point.covariance = slope * load.contact.covariance * slope.transpose();
    point.covariance(0, 0) += stage_std_mm * stage_std_mm;
  }
  return points;
}

// The points of an object squeezed between two fingers, for the rows that both
// have: u is the sum of both displacements, F the mean of both forces. Each
// finger's points use the direction in its own frame S.
std::vector<ForcePoint> SqueezePoints(const std::vector<ForcePoint>& first,
                                      const std::vector<ForcePoint>& second) {
  std::vector<ForcePoint> points;
  std::size_t j = 0;
  for (const ForcePoint& a : first) {
    while (j < second.size() && second[j].row < a.row) ++j;
    if (j == second.size()) break;
    const ForcePoint& b = second[j];
    if (b.row != a.row) continue;
    const Eigen::DiagonalMatrix<double, 2> share(1, 0.5);
    ForcePoint& point = points.emplace_back(a);
    point.displacement_mm = a.displacement_mm + b.displacement_mm;
    point.force_N = 0.5 * (a.force_N + b.force_N);
    point.approach_mm = a.approach_mm + b.approach_mm;
    point.covariance = share * (a.covariance + b.covariance) * share;
  }
  return points;
}

std::vector<ComplianceTrial> Trials(
    const std::vector<ComplianceLog>& logs,
    const std::vector<ComplianceFinger>& fingers,
    const Discretization& discretization, const ComplianceSettings& settings) {
  std::deque<ContactSensor> sensors;
  for (const ComplianceFinger& f : fingers) {
    sensors.emplace_back(f.finger, f.scene, discretization);
  }
  std::vector<ComplianceTrial> trials;
  for (const ComplianceLog& log : logs) {
    std::vector<std::vector<SensedLoad>> sensed;  // by each finger
    const FrameTable& first = log.tables[0];
    for (std::size_t f = 0; f < fingers.size(); ++f) {
      const FrameTable& table = log.tables[f];
      if (table.rows() != first.rows()) {
        throw InputError(table.path() + ": has " +
                         std::to_string(table.rows()) + " rows, " +
                         first.path() + " has " + std::to_string(first.rows()) +
                         "; both fingers need the same rows");
      }
      sensed.push_back(SenseLoads(table, &sensors[f], fingers[f].finger));
    }
    for (ComplianceTrial& trial : SplitByTrial(log, sensed[0])) {
      try {
        trial.direction = DirectionOf(trial.loads, fingers[0].scene, settings);
        trial.points = ForcePoints(trial.loads, trial.direction.angle_rad,
                                   fingers[0].scene, settings);
        for (std::size_t f = 1; f < fingers.size(); ++f) {
          const Scene& scene = fingers[f].scene;
          const auto way = DirectionOf(sensed[f], scene, settings);
          trial.points = SqueezePoints(
              trial.points,
              ForcePoints(sensed[f], way.angle_rad, scene, settings));
        }
        MarkDirections(settings.stage_std_mm, &trial.points);
        trial.fit = FitStiffness(trial.points, settings.most_degree);
      } catch (const InputError& error) {
        throw InputError(first.path() + ": object '" + trial.object +
                         "', trial '" + trial.name + "': " + error.what());
      }
      trials.push_back(std::move(trial));
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

std::vector<SensedLoad> SenseLoads(const FrameTable& table,
                                   ContactSensor* sensor,
                                   const Finger& finger) {
  const std::vector<Measurements> rows = ReadWithPlaces(table, finger);
  std::vector<SensedLoad> loads;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const SensedFrame frame = sensor->Sense(rows[row]);
    if (frame.contacts.size() != 1) continue;
    loads.push_back({row, frame.contacts[0], rows[row].object_mm});
  }
  return loads;
}

SliderDirection EstimateDirection(const std::vector<SensedLoad>& loads,
                                  double radius_mm) {
  if (loads.size() < 3) {
    throw InputError(
        "the slider's direction needs 3 rows with one contact, found " +
        std::to_string(loads.size()));
  }
  const auto count = static_cast<double>(loads.size());
  std::vector<Vector2d> ways;
  Vector2d mean(0, 0), push(0, 0);
  for (const SensedLoad& load : loads) {
    const double theta = load.contact.pose[2];
    ways.push_back(CircleCentre(load.contact.pose, radius_mm) - load.place_mm);
    mean += ways.back() / count;
    push -= load.contact.contact.normal_N *
            Vector2d(std::sin(theta), -std::cos(theta));
  }
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Vector2d& way : ways) {
    scatter += (way - mean) * (way - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scatter);
  Vector2d along = eigen.eigenvectors().col(1);
  if (along.dot(push) < 0) along = -along;
  const double across = eigen.eigenvalues()[0] / (count - 2);
  return {std::atan2(along.y(), along.x()),
          std::sqrt(across / eigen.eigenvalues()[1])};
}

void MarkDirections(double stage_std_mm, std::vector<ForcePoint>* points) {
  std::vector<ForcePoint>& p = *points;
  int direction = 1;
  for (std::size_t i = 1; i < p.size(); ++i) {
    const double step = p[i].approach_mm - p[i - 1].approach_mm;
    if (std::abs(step) > kMoved * std::sqrt(2.0) * stage_std_mm) {
      direction = step > 0 ? 1 : -1;
    }
    p[i].direction = direction;
    if (i == 1) p[0].direction = direction;
  }
  // After a reversal the slider stands until it has left the turning point.
  std::size_t turn = 0;
  bool slides = true;
  for (std::size_t i = 1; i < p.size(); ++i) {
    if (p[i].direction != p[i - 1].direction) {
      turn = i - 1;
      slides = false;
    }
    const double way =
        p[i].direction * (p[i].displacement_mm - p[turn].displacement_mm);
    const double error =
        std::sqrt(p[i].covariance(0, 0) + p[turn].covariance(0, 0));
    slides = slides || way > kMoved * error;
    p[i].slides = slides;
  }
}

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

double OrderConfidence(const std::vector<ObjectStiffness>& objects) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  int right = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
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
  return static_cast<double>(right) / kDraws;
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
    for (const FingerVariation& moved :
         FingerVariations(fingers[f].finger, fingers[f].scene.friction())) {
      varied[f].finger = moved.finger;
      varied[f].scene.friction_coefficient =
          fingers[f].scene.friction_coefficient + moved.friction;
      auto trials = Trials(logs, varied, discretization, settings);
      const auto compared = Compare(from, to, &trials);
      for (std::size_t i = 0; i < compared.size(); ++i) {
        ObjectStiffness& object = result.objects[i];
        object.calibration_std =
            std::hypot(object.calibration_std,
                       compared[i].mean.N_per_mm - object.mean.N_per_mm);
      }
    }
  }
  result.pair_confidence = SortByStiffness(&result.objects);
  result.order_confidence = OrderConfidence(result.objects);
  return result;
}

}  // namespace finray
