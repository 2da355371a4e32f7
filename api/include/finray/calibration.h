#ifndef FINRAY_CALIBRATION_H_
#define FINRAY_CALIBRATION_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "finray/error.h"
#include "finray/export.h"
#include "finray/finger.h"
#include "finray/simulator.h"
#include "finray/table.h"

namespace finray::v1 {

/// What to calibrate, and from which measurements: a plan YAML
/// (docs/reference/formats.md).
class FINRAY_API Plan {
 public:
  /// Reads a plan YAML. Throws InputError (file:line:column).
  static Plan Read(const std::string& path);
  /// The same of a text. A scene that it names by a path counts from the folder
  /// of `name`, which stands for the path in messages.
  static Plan FromYaml(const std::string& text,
                       const std::string& name = "plan");

  /// The text that the plan was read from.
  std::string ToYaml() const;
  std::string path() const;

  struct Inside;
  const Inside& inside() const { return *inside_; }

 private:
  explicit Plan(std::shared_ptr<const Inside> inside);
  std::shared_ptr<const Inside> inside_;
};

struct CalibrationOptions {
  /// The parameters move until their gradient is below this, in std.
  double tolerance_std = 0.01;
  /// With several logs: repeats the solve without each, to see if they agree.
  bool leave_one_log_out = true;
  /// First frees effects that the plan leaves out while unseen frames are
  /// predicted better.
  bool explore = false;
  int threads = 0;  ///< 0 (all cores) to 1024.
  Discretization discretization;
  /// Receives a line whenever the solve has made a step, from any thread.
  std::function<void(const std::string&)> progress;
  /// Polled between steps; if it returns true, Interrupted is thrown.
  std::function<bool()> stop;
};

/// A parameter of a calibration, as in calibration.yaml.
struct CalibratedParameter {
  std::string name;  ///< "gauge_1_gain_V_per_rad"
  std::string unit;
  double initial, value, std;
  double prior_std;  ///< NaN if there is no prior.
  /// "estimated", "prior_dominated", "unidentifiable" or "fixed".
  std::string status;
};

/// Residuals of one kind of measurement.
struct ResidualNoise {
  std::string family;  ///< "gauge", "force", ...
  int residuals;
  double dof, chi2;
};

/// A combination of parameters that the data determine badly.
struct WeakDirection {
  std::string words, how_far, remedy;
};

/// The result of a calibration, as finray_calibrate makes it.
class FINRAY_API Calibration {
 public:
  /// Calibrates `finger`. Logs are CSV files, or tables in memory. Throws
  /// InputError for bad input; a result that is not good says so by verdict().
  static Calibration Run(const Finger& finger, const Plan& plan,
                         const std::vector<std::string>& logs,
                         const CalibrationOptions& options = {});
  static Calibration Run(const Finger& finger, const Plan& plan,
                         const std::vector<Table>& logs,
                         const CalibrationOptions& options = {});
  ~Calibration();
  Calibration(Calibration&&) noexcept;
  Calibration& operator=(Calibration&&) noexcept;

  /// The calibrated finger, with its covariance.
  const Finger& finger() const;
  /// The plan of the result; with explore, the one that it ended with, unless a
  /// warning `explored_not_adopted` says that the given one is better.
  const Plan& plan() const;
  /// "good", "doubtful", "unidentifiable", "unexplained", "starts_disagree" or
  /// "not_converged". Only the first may be used without a thought.
  std::string verdict() const;
  /// Why the result is doubtful, the likeliest cause first.
  std::vector<std::string> doubts() const;
  std::vector<Warning> warnings() const;
  bool converged() const;
  int iterations() const;
  std::vector<CalibratedParameter> parameters() const;
  /// Names of the parameters that were free, in the order of covariance().
  std::vector<std::string> free_names() const;
  /// Covariance of the free parameters by rows, in the square of their units.
  std::vector<double> covariance() const;
  std::vector<ResidualNoise> noise() const;
  std::vector<WeakDirection> weak_directions() const;
  /// Force from the gauges alone against the reference: rms over the fitted
  /// frames before and after, and over the held-out ones; NaN if not known.
  double force_rms_before_N() const;
  double force_rms_after_N() const;
  double force_rms_held_out_N() const;
  /// What to record next, in words.
  std::string next() const;

  /// A row for each frame: reference and estimate, residuals, why it was
  /// rejected (calibration.frames.csv).
  Table Frames() const;
  /// The text of calibration.yaml.
  std::string ToYaml() const;
  /// Writes finger.yaml, calibration.yaml, the tables beside it and, with
  /// `report`, report.html, as finray_calibrate does. Returns why there is no
  /// report.html, or "". Throws InputError if a file cannot be written.
  std::string Write(const std::string& out_dir, bool report = true) const;

 private:
  struct Inside;
  explicit Calibration(std::unique_ptr<Inside> inside);
  template <class Logs>
  static Calibration Solve(const Finger& finger, const Plan& plan,
                           const Logs& logs, const CalibrationOptions& options);
  std::unique_ptr<Inside> inside_;
};

}  // namespace finray::v1

#endif  // FINRAY_CALIBRATION_H_
