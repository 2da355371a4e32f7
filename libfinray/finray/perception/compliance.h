#ifndef FINRAY_PERCEPTION_COMPLIANCE_H_
#define FINRAY_PERCEPTION_COMPLIANCE_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/perception/stiffness_order.h"

namespace finray {

/// One finger of a compliance experiment.
struct ComplianceFinger {
  Finger finger;
  Scene scene;
};

struct ComplianceSettings {
  double stage_std_mm = 0.02;
  /// From +x of frame S, where the object is pushed to; not given: the scene's
  /// spring has it, else it is estimated.
  std::optional<double> direction_rad;
  int most_degree = 3;
  /// Forces between which stiffness is compared; not given: 20 and 80 % of the
  /// largest force that all trials reach.
  std::optional<double> from_N, to_N;
};

/// One object pushed in (and withdrawn) once.
struct ComplianceTrial {
  std::string object, name;
  std::vector<ForcePoint> points;
  SliderDirection direction;
  StiffnessFit fit;
  Stiffness stiffness;
  std::size_t rows = 0;
};

struct Compliance {
  std::vector<ComplianceTrial> trials;
  std::vector<ObjectStiffness> objects;  ///< from stiff to soft
  std::vector<double> pair_confidence;   ///< of neighbours' order
  double order_confidence = 1;
  double from_N = 0, to_N = 0;
};

/// The table of a trial, or of several: rows with the same text in the columns
/// `object` and `trial`, where it has them, belong together. `second` is the
/// other finger's, row by row, if the object is squeezed between two.
struct ComplianceLog {
  std::string name;  ///< of the object, where there is no such column
  FrameTable first;
  std::optional<FrameTable> second;
};

/// Throws InputError naming the log for what cannot be used.
Compliance MeasureCompliance(const std::vector<ComplianceLog>& logs,
                             const ComplianceFinger& first,
                             const ComplianceFinger* second,
                             const Discretization& discretization,
                             const ComplianceSettings& settings);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_COMPLIANCE_H_
