#ifndef FINRAY_CALIB_ANALYSIS_CALIBRATION_COMPARISON_H_
#define FINRAY_CALIB_ANALYSIS_CALIBRATION_COMPARISON_H_

#include <string>
#include <vector>

#include "finray/calib/analysis/calibration_file.h"
#include "finray/calib/analysis/gate.h"
#include "finray/finger/discretization.h"
#include "finray/io/frame_table.h"

namespace finray {

/// Two calibrations a and b of a finger, and whether they agree.
///
/// For each parameter the difference d = b - a is compared with its std. If the
/// data of both are independent, that is s^2 = s_a^2 + s_b^2. All parameters
/// that either calibration has determined are compared together by
///
///   chi2 = d' (C_a + C_b)^-1 d.
///
/// Data or priors that both share make d smaller than that. The comparison is
/// then conservative and finds less than there is.
///
/// In the field, both calibrations sense what the gauges of a would read under
/// a contact (l_c, f_c). a finds that contact itself, and b is off by the
/// differences. The std of the differences follows from the covariances of both
/// (CalibrationErrors). It leaves out the noise of the readings, which
/// both share.
struct Comparison {
  struct Parameter {
    std::string name, unit;
    double a, b;
    double std;  ///< Of the difference; NaN if fixed in both or not determined.
    double sigma() const { return (b - a) / std; }
  };
  std::vector<Parameter> parameters;
  /// The names of parameters that are not compared: those that only one
  /// calibration has, and those of logs that have the same name and another
  /// SHA-256.
  std::vector<std::string> only_a, only_b, of_other_logs;
  double chi2 = 0;
  int dof = 0;
  double p_value() const;
  int shared_logs = 0;

  struct Point {
    double contact_mm, normal_N;
    /// NaN if b cannot tell the contact.
    double force_difference_N, contact_difference_mm;
    double force_std_N, contact_std_mm;  ///< NaN without covariances.
    bool told_by_a;  ///< a can tell the contact from its own readings.
  };
  std::vector<Point> grid;

  /// The largest magnitudes over the grid; NaN (0 for counts) where nothing is
  /// known.
  struct Largest {
    double force_N = 0, contact_mm = 0, force_over_std = 0,
           contact_over_std = 0;
    double force_rms_N = 0, contact_rms_mm = 0;
    int points = 0;  ///< Points that b can tell.
    int lost = 0;    ///< Points that a can tell and b cannot.
  };
  Largest largest() const;
  /// The parameter with the largest |sigma|; null if none has one.
  const Parameter* LargestSigma() const;
};

/// Throws InputError if there is nothing to compare.
Comparison Compare(const CalibrationFile& a, const CalibrationFile& b,
                   const Discretization& discretization);

/// Returns the table of comparison.csv, with a row for each point of the grid.
FrameTable ComparisonGrid(const Comparison& comparison);
/// Returns the text of comparison.yaml.
std::string ComparisonYaml(const Comparison& comparison,
                           const CalibrationFile& a, const CalibrationFile& b,
                           const std::vector<Gate>& gates);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_CALIBRATION_COMPARISON_H_
