#ifndef FINRAY_CALIB_ANALYSIS_CALIBRATION_FILE_H_
#define FINRAY_CALIB_ANALYSIS_CALIBRATION_FILE_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// The parameters of a calibration.yaml, and the finger beside it.
struct CalibrationFile {
  struct Parameter {
    std::string name, unit;
    double value;
    double std;  ///< Infinite if not determined, 0 if fixed.
  };
  std::string path;  ///< The path of calibration.yaml.
  std::vector<Parameter> parameters;
  struct Log {
    std::string path, sha256;
  };
  std::vector<Log> logs;
  Finger finger;

  /// Returns null if there is no such parameter.
  const Parameter* Find(const std::string& name) const;
  /// Returns std_i std_j correlation_ij for these names. The rows of parameters
  /// that are fixed or missing are 0.
  Eigen::MatrixXd Covariance(const std::vector<std::string>& names) const;

 private:
  friend CalibrationFile ReadCalibration(const std::string& path);
  std::vector<std::string> correlated_;  // the names of the matrix's rows
  Eigen::MatrixXd correlations_;
};

/// Reads a result folder of finray_calibrate, or the calibration.yaml in it.
/// Throws InputError if that fails.
CalibrationFile ReadCalibration(const std::string& path);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_CALIBRATION_FILE_H_
