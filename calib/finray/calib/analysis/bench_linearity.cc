#include "finray/calib/analysis/bench_linearity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>
#include <unsupported/Eigen/SpecialFunctions>

#include "finray/io/nan.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

struct Reading {
  double angle_rad, volts;
  int offset;  // index of the offset
};

// The least-squares fit of the columns of a model to the volts.
struct Fit {
  Eigen::VectorXd x;
  double squares;
  int dof;
  Eigen::MatrixXd inverse;  // x = inverse volts

  Fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& volts) {
    // The columns are of order one, and one may be a sum of others.
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> qr(columns.rows(),
                                                               columns.cols());
    qr.setThreshold(1e-9);
    qr.compute(columns);
    x = qr.solve(volts);
    squares = (volts - columns * x).squaredNorm();
    dof = static_cast<int>(volts.size() - qr.rank());
    inverse = qr.pseudoInverse();
  }
  // Returns the variance of a reading, but at least `least`: rounded readings
  // may agree better than they are known.
  double Variance(double least) const { return std::max(squares / dof, least); }
};

int LevelOf(const std::set<double>& levels, double value) {
  return static_cast<int>(std::distance(levels.begin(), levels.find(value)));
}

BenchLinearity Test(const std::vector<Reading>& readings,
                    const std::set<double>& angles, int offsets,
                    double reading_std_V) {
  const auto n = static_cast<Eigen::Index>(readings.size());
  const auto levels = static_cast<int>(angles.size());
  Eigen::VectorXd volts(n);
  Eigen::MatrixXd line = Eigen::MatrixXd::Zero(n, offsets + 1);
  Eigen::MatrixXd by_level = Eigen::MatrixXd::Zero(n, offsets + levels);
  Eigen::MatrixXd curve = Eigen::MatrixXd::Zero(n, offsets + 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Reading& reading = readings[i];
    volts[i] = reading.volts;
    line(i, reading.offset) = by_level(i, reading.offset) = 1;
    line(i, offsets) = reading.angle_rad;
    by_level(i, offsets + LevelOf(angles, reading.angle_rad)) = 1;
  }
  curve << line, line.col(offsets).cwiseAbs2();

  BenchLinearity found;
  found.readings = static_cast<int>(n);
  const double lowest = *angles.begin(), highest = *angles.rbegin();
  found.largest_angle_rad = std::max(std::abs(lowest), std::abs(highest));
  const Fit straight(line, volts), bent(curve, volts);
  const double q = bent.x[offsets + 1];
  const double reduction = straight.squares - bent.squares;
  const double least = reading_std_V * reading_std_V;
  const double variance = bent.Variance(least);
  const double t_squared = reduction / variance;
  found.quadratic_V_per_rad2 = q;
  found.quadratic_std =
      std::sqrt(variance) * bent.inverse.row(offsets + 1).norm();
  found.quadratic_p_value = FTail(t_squared, 1, bent.dof);
  found.first_gain_V_per_rad = bent.x[offsets] + 2 * q * lowest;
  found.last_gain_V_per_rad = bent.x[offsets] + 2 * q * highest;
  found.bow_V = std::abs(q) * std::pow(highest - lowest, 2) / 4;
  const Fit pure(by_level, volts);
  const int more = straight.dof - pure.dof;
  found.lack_of_fit_F =
      pure.dof > 0 && more > 0
          ? (straight.squares - pure.squares) / more / pure.Variance(least)
          : kNaN;
  found.lack_of_fit_p_value = FTail(found.lack_of_fit_F, more, pure.dof);
  return found;
}

}  // namespace

std::string BenchLinearity::Words() const {
  if (IsCurved()) {
    return FormatText(
        "gauge %d is not linear on the bench: from one end of the "
        "angles to the other its gain goes from %.3g to %.3g V/rad "
        "(quadratic term %.3g +- %.2g V/rad^2), so that readings "
        "leave a line by up to %.2g V",
        gauge + 1, first_gain_V_per_rad, last_gain_V_per_rad,
        quadratic_V_per_rad2, quadratic_std, bow_V);
  }
  return FormatText(
      "gauge %d is not linear on the bench: a line misses the "
      "repeated radii by more than they scatter (F = %.3g, p = "
      "%.1g), and a quadratic curve does not explain it",
      gauge + 1, lack_of_fit_F, lack_of_fit_p_value);
}

std::vector<BenchLinearity> TestBenchLinearity(const Finger& finger,
                                               const Plan& plan,
                                               const CalibrationLogs& logs) {
  const bool per_log = plan.family(ParameterFamily::kGaugeOffset).per_log;
  std::vector<BenchLinearity> all;
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    std::vector<Reading> readings;
    std::set<double> angles;
    std::set<double> offsets;  // the logs, if each has an offset
    for (const CalibrationFrame& frame : logs.frames) {
      if (!frame.IsBench() || frame.held_out) continue;
      if (!std::isfinite(frame.gauges_V[j])) continue;
      const double angle =
          finger.gauges[j].length_mm / frame.cylinder_radius_mm;
      readings.push_back({angle, frame.gauges_V[j], per_log ? frame.log : 0});
      angles.insert(angle);
      offsets.insert(readings.back().offset);
    }
    if (angles.size() < 3 || readings.size() < offsets.size() + 3) continue;
    for (Reading& reading : readings) {
      reading.offset = LevelOf(offsets, reading.offset);
    }
    all.push_back(Test(readings, angles, static_cast<int>(offsets.size()),
                       finger.gauges[j].noise_V));
    all.back().gauge = j;
  }
  return all;
}

double FTail(double f, int d1, int d2) {
  if (d1 < 1 || d2 < 1 || std::isnan(f)) return kNaN;
  if (f <= 0) return 1;
  return Eigen::numext::betainc(0.5 * d2, 0.5 * d1, d2 / (d2 + d1 * f));
}

}  // namespace finray
