#ifndef FINRAY_CALIB_ANALYSIS_CALIBRATION_COMPARISON_H_
#define FINRAY_CALIB_ANALYSIS_CALIBRATION_COMPARISON_H_

#include <string>
#include <vector>

#include "finray/calib/report/calibration_file.h"
#include "finray/finger/discretization.h"
#include "finray/io/frame_table.h"

namespace finray {

/// Two calibrations of a finger, a and b, and whether they agree.
///
/// Per parameter the difference d = b - a is held against the std that it has
/// if the data of both are independent, s^2 = s_a^2 + s_b^2; over all that
/// either has determined,
///
///   chi2 = d' (C_a + C_b)^-1 d.
///
/// Data, or priors, that both share make d smaller than that: the comparison
/// is then conservative, finding less than there is.
///
/// In the field: what the gauges of a would read of a contact (l_c, f_c) is
/// sensed by both. a finds the contact itself, b is off by the differences; the
/// std of those is what the covariances of both say (CalibrationUncertainty),
/// without the noise of the readings, which both share.
struct Comparison {
  struct Parameter {
    std::string name, unit;
    double a, b;
    double std;  ///< of the difference; NaN if fixed in both or not determined
    double sigma() const { return (b - a) / std; }
  };
  std::vector<Parameter> parameters;
  /// Names that only one has, and those of one log, by its name, that are of
  /// different ones by SHA-256: none of them is compared.
  std::vector<std::string> only_a, only_b, of_other_logs;
  double chi2 = 0;
  int dof = 0;
  double p_value() const;
  int shared_logs = 0;

  struct Point {
    double contact_mm, normal_N;
    /// NaN where b cannot tell the contact.
    double force_difference_N, contact_difference_mm;
    double force_std_N, contact_std_mm;  ///< NaN without covariances
    bool told_by_a;  ///< a itself can tell the contact from its readings
  };
  std::vector<Point> grid;

  /// Over the grid; NaN, or 0 for count, where nothing is known.
  struct Largest {
    double force_N = 0, contact_mm = 0, force_over_std = 0,
           contact_over_std = 0;
    double force_rms_N = 0, contact_rms_mm = 0;
    int points = 0;  ///< that b tells
    int lost = 0;    ///< that a tells, but b does not
  };
  Largest largest() const;
  /// The parameter with the largest |sigma|; nullptr if none has one.
  const Parameter* LargestSigma() const;
};

/// Throws InputError if there is nothing to compare.
Comparison Compare(const CalibrationFile& a, const CalibrationFile& b,
                   const Discretization& discretization);

/// The grid as rows, and all as the text of comparison.yaml.
FrameTable ComparisonGrid(const Comparison& comparison);
struct ComparisonGate {
  std::string name;
  double bound, value;
  bool passed;
};
std::string ComparisonYaml(const Comparison& comparison,
                           const CalibrationFile& a, const CalibrationFile& b,
                           const std::vector<ComparisonGate>& gates);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_CALIBRATION_COMPARISON_H_
