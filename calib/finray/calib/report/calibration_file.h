#ifndef FINRAY_CALIB_REPORT_CALIBRATION_FILE_H_
#define FINRAY_CALIB_REPORT_CALIBRATION_FILE_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// The parameters of a calibration.yaml and the finger beside it.
struct CalibrationFile {
  struct Parameter {
    std::string name, unit;
    double value;
    double std;  ///< infinite: not determined; 0: fixed
    bool fixed;
  };
  std::string path;  ///< of calibration.yaml
  std::vector<Parameter> parameters;
  std::vector<std::string> log_hashes;  ///< SHA-256 of its logs
  Finger finger;

  /// nullptr if there is no such parameter.
  const Parameter* Find(const std::string& name) const;
  /// std_i std_j correlation_ij over these names; 0 for those that are fixed or
  /// that it does not have.
  Eigen::MatrixXd Covariance(const std::vector<std::string>& names) const;

 private:
  friend CalibrationFile ReadCalibration(const std::string& path);
  std::vector<std::string> correlated_;  // of the matrix
  Eigen::MatrixXd correlations_;
};

/// Reads a result folder of finray_calibrate, or the calibration.yaml in it.
/// Throws InputError.
CalibrationFile ReadCalibration(const std::string& path);

}  // namespace finray

#endif  // FINRAY_CALIB_REPORT_CALIBRATION_FILE_H_
