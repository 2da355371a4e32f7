#ifndef FINRAY_CALIB_PROBLEM_PARAMETERS_H_
#define FINRAY_CALIB_PROBLEM_PARAMETERS_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/plan.h"
#include "finray/calib/problem/reading_terms.h"
#include "finray/finger/finger.h"
#include "finray/residuals/frame_set.h"

namespace finray {

/// One number that a calibration may vary. Stiffness and the force sensor's
/// scale are positive, and their logarithms are varied (`is_log`). Gains are
/// varied as they are: readings are linear in them, so that a start wrong by
/// any factor is one step away; their sign depends on the wiring, and the gain
/// of a dead gauge is zero.
struct CalibrationParameter {
  std::string name;  ///< as in calibration.yaml, e.g. "rib_2_length_mm"
  std::string unit;
  ParameterFamily family;
  /// The parameter of the finger that it is; empty if it belongs to logs.
  std::optional<FingerParameter> of_finger;
  double* variable;  ///< where the solver finds it
  double* block;     ///< the first of the variables that the solver has as one
  bool is_log = false;
  bool free = false;
  int gauge = -1;                   ///< of gains and offsets
  double initial = 0;               ///< where the variable starts
  std::optional<double> prior_std;  ///< of the variable
  /// A change that would matter, for scaling where there is no prior.
  double scale = 1;
  /// A prior wider than this is a guess: where the data say less than such a
  /// one, the parameter is not known.
  double vague_std = 0;

  /// The user's number for a variable and the other way round.
  double Value(double at) const;
  double ValueStd(double at, double std) const;
};

/// The variables of a calibration, at fixed addresses, and their description.
class CalibrationParameters {
 public:
  CalibrationParameters(const Finger& finger, const Plan& plan,
                        const CalibrationLogs& logs);
  CalibrationParameters(const CalibrationParameters&) = delete;

  SharedParameters shared;
  std::vector<double> gains_V_per_rad;
  ReadingTerms readings;
  /// The force sensor reads F = scale f + offset; offsets of the magnitude and
  /// of the components.
  double ln_force_scale = 0;
  double force_offset_N = 0, force_offset_xy_N[2] = {0, 0};
  /// Where positions of rib pins and the tip are counted from.
  double camera_origin_mm[2] = {0, 0};

  /// Where a log's object positions are counted from.
  double* object_origin_mm(int log) {
    return origins_mm_[origin_per_log_ ? log : 0].data();
  }

  /// The parameters that a frame's blocks depend on.
  FrameParameters Of(const CalibrationFrame& frame);

  /// The log whose offsets the finger has where they are per log.
  int last_fitted_log() const { return last_fitted_; }

  /// In the order of calibration.yaml: those of the finger and the origin, free
  /// or not, then others that are free.
  const std::vector<CalibrationParameter>& all() const { return all_; }
  /// Indices into all() of the free ones.
  const std::vector<int>& free() const { return free_; }
  /// The k-th free one.
  const CalibrationParameter& FreeParameter(std::size_t k) const {
    return all_[free_[k]];
  }

  /// By free one: the prior's std, or the scale where there is none.
  Eigen::VectorXd Units() const;
  /// By free one: 1 / std^2 of the prior, 0 where there is none.
  Eigen::VectorXd PriorInformation() const;

  /// The finger that the present values describe. Where offsets are per log it
  /// has those of the last log that was fitted, of the finger if there is one,
  /// else of the bench.
  Finger Apply(const Finger& finger) const;

  /// The logs as they would be of a finger with `calibrated`'s offsets, without
  /// drift, at the reference temperature, with a true force sensor and all
  /// positions in frame S.
  CalibrationLogs Corrected(const CalibrationLogs& logs,
                            const Finger& calibrated);

 private:
  void AddOfFinger(const Plan& plan, const CalibrationLogs& logs,
                   const FingerParameter& of_finger);
  void AddOrigins(const Plan& plan, const CalibrationLogs& logs);
  void AddForceSensor(const Plan& plan, const CalibrationLogs& logs);
  void AddTemperature(const Plan& plan);
  void AddCamera(const Plan& plan);
  void AddDrift(const Plan& plan, const CalibrationLogs& logs);
  // Appends the log's name to the parameter's.
  void AddOfLog(const Plan& plan, const CalibrationLogs& logs, int log,
                CalibrationParameter parameter);
  void Add(const Plan& plan, CalibrationParameter parameter,
           bool held_out = false);

  std::vector<bool> held_out_;  // by log: every row is
  int last_fitted_;             // the log whose offsets the finger has
  bool origin_per_log_;
  std::vector<std::array<double, 2>> origins_mm_;
  std::vector<CalibrationParameter> all_;
  std::vector<int> free_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_PARAMETERS_H_
