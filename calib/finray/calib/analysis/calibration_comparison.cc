#include "finray/calib/analysis/calibration_comparison.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "finray/estimation/chi_squared.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/io/nan.h"

namespace finray {
namespace {

constexpr int kComparisonHeights = 9;
constexpr double kComparisonLoads[] = {1, 3, 6, 10};  // in EI / l_0^2
// An eigenvalue below this share of the largest one is rounding, because the
// correlations have six digits.
constexpr double kRank = 1e-6;

// Returns the log that a parameter belongs to, which its name has in brackets:
// `gauge_1_offset_V[a.csv]`. Empty if it belongs to none.
std::string LogOf(const std::string& parameter) {
  const auto open = parameter.find('[');
  if (open == std::string::npos || parameter.back() != ']') return "";
  return parameter.substr(open + 1, parameter.size() - open - 2);
}

// Returns the SHA-256 of the log whose path ends in this name, or an empty text
// if there is none.
std::string HashOfLog(const CalibrationFile& file, const std::string& log) {
  const std::string end = "/" + log;
  for (const CalibrationFile::Log& its : file.logs) {
    const std::string path = "/" + its.path;
    if (path.size() >= end.size() &&
        path.compare(path.size() - end.size(), end.size(), end) == 0) {
      return its.sha256;
    }
  }
  return "";
}

// Says whether a parameter belongs to the same log in both. Logs with the same
// name may be of different days and have other offsets.
bool IsOfOneLog(const CalibrationFile& a, const CalibrationFile& b,
                const std::string& parameter) {
  const std::string log = LogOf(parameter);
  if (log.empty()) return true;
  const std::string hash = HashOfLog(a, log);
  return !hash.empty() && hash == HashOfLog(b, log);
}

void ListUnshared(const CalibrationFile& a, const CalibrationFile& b,
                  std::vector<std::string>* names) {
  for (const CalibrationFile::Parameter& p : a.parameters) {
    if (b.Find(p.name) == nullptr) names->push_back(p.name);
  }
}

void CompareParameters(const CalibrationFile& a, const CalibrationFile& b,
                       Comparison* comparison) {
  std::vector<std::string> names;
  std::vector<double> difference;
  ListUnshared(a, b, &comparison->only_a);
  ListUnshared(b, a, &comparison->only_b);
  for (const CalibrationFile::Parameter& p : a.parameters) {
    const CalibrationFile::Parameter* q = b.Find(p.name);
    if (q == nullptr) continue;
    if (!IsOfOneLog(a, b, p.name)) {
      comparison->of_other_logs.push_back(p.name);
      continue;
    }
    const double std = std::hypot(p.std, q->std);
    const bool known = std > 0 && std::isfinite(std);
    comparison->parameters.push_back(
        {p.name, p.unit, p.value, q->value, known ? std : kNaN});
    if (!known) continue;
    names.push_back(p.name);
    difference.push_back(q->value - p.value);
  }
  if (names.empty()) {
    throw InputError(b.path + ": has no parameter in common with " + a.path +
                     " that either has determined");
  }
  const Eigen::MatrixXd covariance = a.Covariance(names) + b.Covariance(names);
  const Eigen::VectorXd std = covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation = std.cwiseInverse().asDiagonal() *
                                      covariance *
                                      std.cwiseInverse().asDiagonal();
  const Eigen::VectorXd d =
      Eigen::Map<Eigen::VectorXd>(difference.data(), std.size())
          .cwiseQuotient(std);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  for (int k = 0; k < d.size(); ++k) {
    const double value = eigen.eigenvalues()[k];
    if (value < kRank * eigen.eigenvalues()[d.size() - 1]) continue;
    const double along = eigen.eigenvectors().col(k).dot(d);
    comparison->chi2 += along * along / value;
    ++comparison->dof;
  }
}

// Senses readings with one finger, and gives the std that follows from its
// covariance.
class Sensor {
 public:
  Sensor(const Finger& finger, const Discretization& discretization)
      : solver_(finger, discretization),
        systematic_(finger, OneContact(), discretization),
        estimator_(WithoutCalibration(finger), OneContact(), discretization) {}

  // Returns the readings under a contact, or none if the finger cannot carry
  // it.
  std::vector<double> Read(const PointContact& contact) {
    solver_.Reset();
    std::vector<double> volts;
    if (!solver_.Solve({contact})) return volts;
    const std::vector<Gauge>& gauges = solver_.model().finger().gauges;
    for (std::size_t j = 0; j < gauges.size(); ++j) {
      volts.push_back(
          gauges[j].Volts(solver_.gauge_angle(static_cast<int>(j))));
    }
    return volts;
  }

  FrameEstimate Sense(const std::vector<double>& volts) {
    return estimator_.Estimate(RowOf(volts));
  }

  // Returns the variances of l_c and f_c.
  Eigen::Vector2d Variance(double arc, double force,
                           const std::vector<double>& volts) {
    if (systematic_.empty()) return {0, 0};
    return systematic_.Of({{arc, force, 0}}, RowOf(volts)).diagonal();
  }
  bool knows() const { return !systematic_.empty(); }

 private:
  static Measurements RowOf(const std::vector<double>& volts) {
    Measurements row;
    row.gauges_V = volts;
    return row;
  }
  static Scene OneContact() {
    Scene scene;
    scene.contacts = 1;
    return scene;
  }

  EquilibriumSolver solver_;
  CalibrationErrors systematic_;
  FrameEstimator estimator_;
};

void CompareGrid(const Finger& finger_a, const Finger& finger_b,
                 const Discretization& discretization, Comparison* comparison) {
  Sensor a(finger_a, discretization), b(finger_b, discretization);
  for (int i = 1; i <= kComparisonHeights; ++i) {
    const double arc = finger_a.front_length_mm * i / (kComparisonHeights + 1);
    for (const double load : kComparisonLoads) {
      const double force = load * ForceUnit(finger_a);
      const std::vector<double> volts = a.Read({arc, force, 0});
      if (volts.empty()) continue;
      Comparison::Point point = {arc, force, kNaN, kNaN, kNaN, kNaN, false};
      point.told_by_a = a.Sense(volts).status == FrameStatus::kOk;
      const FrameEstimate found = b.Sense(volts);
      if (found.status == FrameStatus::kOk) {
        const ContactEstimate& at = found.contact[0];
        point.contact_difference_mm = at.arc_mm - arc;
        point.force_difference_N = at.normal_N - force;
        if (a.knows() || b.knows()) {
          const Eigen::Vector2d variance =
              a.Variance(arc, force, volts) +
              b.Variance(at.arc_mm, at.normal_N, volts);
          point.contact_std_mm = std::sqrt(variance[0]);
          point.force_std_N = std::sqrt(variance[1]);
        }
      }
      comparison->grid.push_back(point);
    }
  }
}

}  // namespace

double Comparison::p_value() const { return ChiSquaredTail(chi2, dof); }

Comparison::Largest Comparison::largest() const {
  Largest most;
  const auto raise = [](double value, double* largest) {
    if (std::abs(value) > *largest) *largest = std::abs(value);
  };
  for (const Point& point : grid) {
    if (std::isnan(point.force_difference_N)) {
      most.lost += point.told_by_a;
      continue;
    }
    ++most.points;
    raise(point.force_difference_N, &most.force_N);
    raise(point.contact_difference_mm, &most.contact_mm);
    raise(point.force_difference_N / point.force_std_N, &most.force_over_std);
    raise(point.contact_difference_mm / point.contact_std_mm,
          &most.contact_over_std);
    most.force_rms_N += std::pow(point.force_difference_N, 2);
    most.contact_rms_mm += std::pow(point.contact_difference_mm, 2);
  }
  most.force_rms_N = std::sqrt(most.force_rms_N / most.points);
  most.contact_rms_mm = std::sqrt(most.contact_rms_mm / most.points);
  return most;
}

const Comparison::Parameter* Comparison::LargestSigma() const {
  const Parameter* most = nullptr;
  for (const Parameter& p : parameters) {
    if (std::isnan(p.std)) continue;
    if (most == nullptr || std::abs(p.sigma()) > std::abs(most->sigma())) {
      most = &p;
    }
  }
  return most;
}

Comparison Compare(const CalibrationFile& a, const CalibrationFile& b,
                   const Discretization& discretization) {
  if (a.finger.gauges.size() != b.finger.gauges.size()) {
    throw InputError(b.path + ": a finger of " +
                     std::to_string(b.finger.gauges.size()) +
                     " gauges, but that of " + a.path + " has " +
                     std::to_string(a.finger.gauges.size()));
  }
  Comparison comparison;
  CompareParameters(a, b, &comparison);
  for (const CalibrationFile::Log& log : a.logs) {
    comparison.shared_logs += std::any_of(
        b.logs.begin(), b.logs.end(),
        [&](const auto& other) { return other.sha256 == log.sha256; });
  }
  // A finger without gauges senses nothing.
  if (!a.finger.gauges.empty()) {
    CompareGrid(a.finger, b.finger, discretization, &comparison);
  }
  return comparison;
}

}  // namespace finray
