#ifndef FINRAY_CALIB_PROBLEM_PARAMETERS_H_
#define FINRAY_CALIB_PROBLEM_PARAMETERS_H_

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/plan.h"
#include "finray/calib/problem/reading_terms.h"
#include "finray/finger/finger.h"
#include "finray/residuals/frame_set.h"
#include "finray/scene/stage_frame.h"

namespace finray {

/// One number that a calibration may vary. Stiffness and the scales of force
/// sensor and stage are positive, so their logarithms are varied (`is_log`).
/// Gains are
/// varied as they are. Readings are linear in gains, so a start that is wrong
/// by any factor is one step away. The sign of a gain depends on the wiring,
/// and the gain of a dead gauge is zero.
struct CalibrationParameter {
  std::string name;  ///< As in calibration.yaml, e.g. "rib_2_length_mm".
  std::string unit;
  ParameterFamily family;
  /// The parameter of the finger that this is; empty if it belongs to logs.
  std::optional<FingerParameter> of_finger;
  double* variable;  ///< The solver finds the variable here.
  double* block;     ///< The first variable of the solver's parameter block.
  bool is_log = false;
  bool free = false;
  int gauge = -1;      ///< The gauge of a gain or an offset.
  double initial = 0;  ///< The start of the variable, and the prior's mean.
  std::optional<double> prior_std;  ///< Std of the variable in the prior.
  /// A change of the variable that matters. It is the unit where there is no
  /// prior.
  double scale = 1;
  /// A prior with a larger std is only a guess. If the data say less than such
  /// a prior, the parameter is not known.
  double vague_std = 0;

  /// Return what the user sees of the variable at `at`, and of its std there.
  double Value(double at) const;
  double ValueStd(double at, double std) const;
  /// The residual of the prior, which is 0 without one.
  double PriorResidual() const {
    return prior_std ? (*variable - initial) / *prior_std : 0;
  }
};

/// Returns the std of the variable in a prior that has this std in a plan.
double PriorStdOf(const CalibrationParameter& parameter, double in_plan);

/// The variables of a calibration, at fixed addresses, and their description.
class CalibrationParameters {
 public:
  CalibrationParameters(const Finger& finger, const Plan& plan,
                        const CalibrationLogs& logs);
  CalibrationParameters(const CalibrationParameters&) = delete;

  SharedParameters shared;
  std::vector<double> gains_V_per_rad, curvatures_per_rad;
  std::vector<double> creep_shares, ln_creep_times, hystereses_rad;
  std::vector<double> flat_shares, ln_flat_widths;
  ReadingTerms readings;
  /// The force sensor reads F = scale f + offset. The magnitude has one offset,
  /// and each component has one.
  double ln_force_scale = 0;
  double force_offset_N = 0, force_offset_xy_N[2] = {0, 0};
  /// The force of a row is what its log reads so much later. Of the components
  /// also: the turn of the sensor's axes, and the weight of what it carries,
  /// which turns with the object (ReferenceForceVectorResidual).
  double force_time_offset_s = 0, force_tilt_deg = 0,
         force_weight_N[2] = {0, 0};
  /// Positions of rib pins and the tip count from here.
  double camera_origin_mm[2] = {0, 0};

  /// The frame of a log's object positions, and the radius of the circle.
  double* object_origin_mm(int log) {
    return origins_mm_[origin_per_log_ ? log : 0].data();
  }
  double* object_rotation_deg(int log) {
    return &rotations_deg_[rotation_per_log_ ? log : 0];
  }
  /// The friction coefficient of all contacts, free or not.
  double friction() const {
    return shared.friction_varies ? shared.effect_values.back() : friction_;
  }
  double ln_object_scale = 0;
  double object_radius_mm = 0;
  StageFrame Stage(int log) {
    return {Eigen::Map<const Eigen::Vector2d>(object_origin_mm(log)),
            *object_rotation_deg(log), ln_object_scale};
  }

  /// The parameters that a frame's blocks depend on.
  FrameParameters Of(const CalibrationFrame& frame);

  /// The log whose offsets the finger gets if offsets are per log: the last
  /// fitted log with rows of the finger, or of the bench if there is none.
  int last_fitted_log() const { return last_fitted_; }

  /// All parameters in the order of calibration.yaml: first those of the finger
  /// and the origin, free or not, then all others that are free.
  const std::vector<CalibrationParameter>& all() const { return all_; }
  /// Indices of the free parameters in all().
  const std::vector<int>& free() const { return free_; }
  /// The k-th free parameter.
  const CalibrationParameter& FreeParameter(std::size_t k) const {
    return all_[free_[k]];
  }

  /// Removes the prior of the k-th free parameter.
  void DropPrior(std::size_t k) { all_[free_[k]].prior_std.reset(); }

  /// The unit of each free parameter: the std of its prior, or its scale if it
  /// has none.
  Eigen::VectorXd Units() const;

  /// Computes creep and hysteresis in all rows at the present values, on the
  /// threads of the caller's arena. Frames that need them first would wait for
  /// each other.
  void FollowHistories() const;
  /// What creep and hysteresis add to the reading of a frame, V.
  double OfHistory(const CalibrationFrame& frame, int gauge);
  /// Keeps for all that follows, at the present values: the signals that drive
  /// hysteresis (ReadingHistory::Drive), V, gauges x frames of the logs, and
  /// what the rows before leave unknown of each reading. Returns whether that
  /// changes it by more than a few percent of the noise. `finger` is that of
  /// the problem.
  bool KeepHistory(std::shared_ptr<const Eigen::MatrixXd> signals_V,
                   const Finger& finger, const CalibrationLogs& logs);
  /// Keeps the same as another set of parameters for the same logs.
  void KeepHistoryOf(const CalibrationParameters& other, const Finger& finger,
                     const CalibrationLogs& logs);
  /// What is kept for a frame, one number a gauge; empty if nothing is.
  std::vector<double> HistoryStd_V(const CalibrationFrame& frame) const;
  /// How the friction of a frame's contact follows from the coefficient.
  RowFriction FrictionOf(const CalibrationFrame& frame) const {
    return frictions_.empty() || frame.IsBench()
               ? RowFriction{}
               : frictions_[frame.log][frame.row];
  }
  /// Finds it from how the object moves in the logs, at the present values, and
  /// keeps it for all that follows. Does nothing without a circle or without
  /// friction. `finger` is that of the problem. Returns whether it has changed
  /// by much.
  bool KeepFriction(const Finger& finger, const Plan& plan,
                    const CalibrationLogs& logs,
                    const Discretization& discretization);
  /// Keeps the same as another set of parameters for the same logs.
  void KeepFrictionOf(const CalibrationParameters& other) {
    frictions_ = other.frictions_;
  }
  /// The gauge with the present gain and curve.
  Gauge Present(const Finger& finger, int gauge) const;
  /// Returns the finger with the present values. If offsets are per log, it
  /// gets those of last_fitted_log().
  Finger Apply(const Finger& finger) const;

  /// Returns the plan with the present friction and radius of the circle, for
  /// logs that are Corrected.
  Plan Corrected(const Plan& plan) const;
  /// Returns the logs as a perfect setup would have recorded them: with the
  /// offsets of `calibrated`, without drift, creep and hysteresis, at
  /// the reference temperature, with a true force sensor, and with all
  /// positions in frame S.
  CalibrationLogs Corrected(const CalibrationLogs& logs,
                            const Finger& calibrated);

 private:
  void ReadHistories(const Finger& finger, const CalibrationLogs& logs);
  void DriveHistories(std::shared_ptr<const Eigen::MatrixXd> signals_V,
                      const Finger& finger, const CalibrationLogs& logs);
  void ReadForces(const CalibrationLogs& logs);
  void CorrectForce(CalibrationFrame* frame) const;
  HistoryTerm HistoryOf(const CalibrationFrame& frame, int gauge);
  ReadingHistory::Values HistoryValues(int gauge) const;
  void KeepHistoryStdAt(const std::vector<ReadingHistory::Values>& values);
  void AddOfFinger(const Finger& finger, const Plan& plan,
                   const CalibrationLogs& logs,
                   const FingerParameter& of_finger);
  void AddFriction(const Plan& plan);
  void AddOrigins(const Plan& plan, const CalibrationLogs& logs);
  void AddStage(const Plan& plan, const CalibrationLogs& logs);
  void AddForceSensor(const Plan& plan, const CalibrationLogs& logs);
  void AddTemperature(const Plan& plan);
  void AddCamera(const Plan& plan);
  void AddDrift(const Plan& plan, const CalibrationLogs& logs);
  // Appends the log's name to the parameter's.
  void AddOfLog(const Plan& plan, const CalibrationLogs& logs, int log,
                CalibrationParameter parameter);
  void Add(const Plan& plan, CalibrationParameter parameter,
           bool held_out = false);

  // By log and gauge; empty if no gauge creeps or has hysteresis.
  std::vector<std::vector<ReadingHistory>> histories_;
  // What drives them; null: the readings.
  std::shared_ptr<const Eigen::MatrixXd> signals_V_;
  // Where their std was kept, by gauge; empty if it was not.
  std::vector<ReadingHistory::Values> kept_;
  bool flat_ = false;  // a gauge is less sensitive when flat, or may be
  // By log; empty if the force sensor is not late.
  std::vector<std::array<LinearSignal, 3>> forces_N_;
  double friction_;  // of the plan's scene
  // By log and row; empty if the object's motion tells nothing.
  std::vector<std::vector<RowFriction>> frictions_;
  std::vector<bool> held_out_;  // by log: whether all its rows are held out
  int last_fitted_;
  bool origin_per_log_, rotation_per_log_;
  std::vector<std::array<double, 2>> origins_mm_;
  std::vector<double> rotations_deg_;
  std::vector<CalibrationParameter> all_;
  std::vector<int> free_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_PARAMETERS_H_
