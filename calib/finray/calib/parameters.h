#ifndef FINRAY_CALIB_PARAMETERS_H_
#define FINRAY_CALIB_PARAMETERS_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/calib/plan.h"
#include "finray/finger/finger.h"
#include "finray/residuals/frame_set.h"

namespace finray {

/// One number that a calibration may vary. Stiffness is varied as its
/// logarithm; `is_log` says so.
struct CalibrationParameter {
  std::string name;  ///< as in calibration.yaml, e.g. "rib_2_length_mm"
  std::string unit;
  ParameterFamily family;
  /// What of the finger it is; empty for the object's origin.
  std::optional<FingerParameter> of_finger;
  double* variable;  ///< where the solver finds it
  bool is_log = false;
  bool free = false;
  double initial = 0;               ///< of the variable
  std::optional<double> prior_std;  ///< of the variable
  /// A change that would matter, for scaling where there is no prior.
  double scale = 1;

  /// The user's number for a variable and the other way round.
  double Value(double at) const;
  double ValueStd(double at, double std) const;
};

/// The variables of a calibration, at fixed addresses, and their description.
class CalibrationParameters {
 public:
  CalibrationParameters(const Finger& finger, const Plan& plan);
  CalibrationParameters(const CalibrationParameters&) = delete;

  SharedParameters shared;
  std::vector<double> gains_V_per_rad, offsets_V;
  double object_origin_mm[2] = {0, 0};

  /// In the order of calibration.yaml.
  const std::vector<CalibrationParameter>& all() const { return all_; }
  /// Indices into all() of the free ones.
  const std::vector<int>& free() const { return free_; }

  /// The finger that the present values describe.
  Finger Apply(const Finger& finger) const;

 private:
  double* Variable(const FingerParameter& parameter);
  void AddOfFinger(const Plan& plan, const FingerParameter& parameter);
  void AddOrigin(const Plan& plan, const char* name, double* variable);
  void Add(const Plan& plan, CalibrationParameter parameter);

  std::vector<CalibrationParameter> all_;
  std::vector<int> free_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_PARAMETERS_H_
