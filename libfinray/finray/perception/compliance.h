#ifndef FINRAY_PERCEPTION_COMPLIANCE_H_
#define FINRAY_PERCEPTION_COMPLIANCE_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "finray/perception/contact_sensor.h"
#include "finray/perception/stiffness_fit.h"

namespace finray {

/// One finger of a compliance experiment.
struct ComplianceFinger {
  Finger finger;
  Scene scene;
};

struct ComplianceSettings {
  double stage_std_mm = 0.02;
  /// Direction in which the object is pushed, from +x of frame S. By default it
  /// is that of the scene's spring; without a spring it is estimated.
  std::optional<double> direction_rad;
  int most_degree = 3;
  /// Stiffness is compared between these forces. Defaults: 20 and 80 % of the
  /// largest force that all trials reach.
  std::optional<double> from_N, to_N;
};

/// The load that one finger senses in a row with one contact.
struct SensedLoad {
  std::size_t row;  ///< of its table, from 0
  SensedContact contact;
  Eigen::Vector2d place_mm;  ///< p of ForcePoint
};

/// The direction in which an object is pushed, from +x of frame S.
struct SliderDirection {
  double angle_rad;
  double std_rad;  ///< NaN for a given direction
};

/// One object, pushed in (and withdrawn) once.
struct ComplianceTrial {
  std::string object, name;
  std::vector<SensedLoad> loads;  ///< of the first finger
  std::vector<ForcePoint> points;
  SliderDirection direction;
  StiffnessFit fit;
  Stiffness stiffness;
  std::size_t rows = 0;
};

/// The stiffness of one object, from all its trials.
struct ObjectStiffness {
  std::string name;
  std::vector<Stiffness> trials;
  Stiffness mean;  ///< MeanStiffness of the trials
  /// Std from the finger's calibration. All objects share this error.
  double calibration_std = 0;
};

struct Compliance {
  std::vector<ComplianceTrial> trials;
  std::vector<ObjectStiffness> objects;  ///< from stiff to soft
  /// Of the order of neighbours, and of the whole order.
  std::vector<double> pair_confidence;
  double order_confidence = 1;
  double from_N = 0, to_N = 0;
};

/// The log of one trial or of several: rows with the same text in the columns
/// `object` and `trial` of the first table belong together.
struct ComplianceLog {
  std::string name;  ///< of the object, for a table without that column
  std::vector<FrameTable> tables;  ///< one for each finger, with the same rows
};

/// Senses all logs, fits a force law to every trial and sorts the objects by
/// stiffness. Takes one finger, or two that squeeze the objects. Throws
/// InputError, which names the log and the trial.
Compliance MeasureCompliance(const std::vector<ComplianceLog>& logs,
                             const std::vector<ComplianceFinger>& fingers,
                             const Discretization& discretization,
                             const ComplianceSettings& settings);

/// Throws InputError for a row without object_x_mm, object_y_mm.
std::vector<SensedLoad> SenseLoads(const FrameTable& table,
                                   ContactSensor* sensor, const Finger& finger);

/// Estimates the direction as the line about which the path of the object's
/// centre against the stage scatters least. Throws InputError for fewer than
/// three loads.
SliderDirection EstimateDirection(const std::vector<SensedLoad>& loads,
                                  double radius_mm);

/// Sets `direction` and `slides` of each point from the approaches.
void MarkDirections(double stage_std_mm, std::vector<ForcePoint>* points);

/// The mean of independent trials, weighted by their std. If the trials scatter
/// more than their std, the std of the mean grows with the scatter.
Stiffness MeanStiffness(const std::vector<Stiffness>& trials);

/// Sorts objects from stiff to soft. Entry i of the result is the probability
/// that object i is stiffer than object i + 1, for independent normal errors.
/// The calibration's error is left out: it hardly changes the order.
std::vector<double> SortByStiffness(std::vector<ObjectStiffness>* objects);

/// The probability, from random draws, that sorted objects are in their true
/// order.
double OrderConfidence(const std::vector<ObjectStiffness>& objects);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_COMPLIANCE_H_
