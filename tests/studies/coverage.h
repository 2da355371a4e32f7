#ifndef FINRAY_TESTS_STUDIES_COVERAGE_H_
#define FINRAY_TESTS_STUDIES_COVERAGE_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "studies/ambiguity.h"
#include "studies/gauge_frames.h"
#include "test_finger.h"

namespace finray {

/// Errors of one number over many frames, against the std that each frame
/// reports and against the Cramer-Rao bound at the truth.
struct ErrorTally {
  int frames = 0, within_1 = 0, within_196 = 0;
  double sum = 0, squares = 0;  // of error over bound

  void Add(double error, double std, double bound) {
    ++frames;
    within_1 += std::abs(error) < std;  // false for NaN
    within_196 += std::abs(error) < 1.96 * std;
    sum += error / bound;
    squares += error * error / (bound * bound);
  }
  void Add(const ErrorTally& other) {
    frames += other.frames;
    within_1 += other.within_1;
    within_196 += other.within_196;
    sum += other.sum;
    squares += other.squares;
  }
  double share_1() const { return double(within_1) / frames; }
  double share_196() const { return double(within_196) / frames; }
  double bias() const { return sum / frames; }
  double spread() const {
    return std::sqrt(squares / frames - bias() * bias());
  }
};

/// Noisy repeats at one place and force.
struct CoverageCell {
  double arc_mm = 0, force_N = 0, arc_bound_mm = 0, force_bound_N = 0;
  ErrorTally arc, force;
  int not_ok = 0;  ///< frames with any other status than ok
  int far = 0;     ///< frames with l_c more than 5 bounds off
  std::vector<double> p_values;

  /// Of the readings at the truth from those of other places, in std
  /// (Ambiguity).
  double distance = 0;

  /// Whether the bounds say what noise does: they are within the limits beyond
  /// which a frame is called unobservable, and no contact elsewhere reads
  /// alike. All of it is known before any frame is drawn, so that leaving out
  /// the other cells selects no errors.
  bool local(double length_mm) const {
    return arc_bound_mm <= FrameEstimator::kLargestArcStd * length_mm &&
           force_bound_N <= FrameEstimator::kLargestForceStd * force_N &&
           distance >= kDistance;
  }
  static constexpr double kDistance = 8;
};

/// Every frame of every cell, whatever its status, with one contact known to be
/// there.
inline std::vector<CoverageCell> CoverageStudy(
    const Finger& finger, const std::vector<double>& arcs_mm,
    const std::vector<double>& forces_N, int repeats, unsigned seed) {
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(finger, scene, {});
  EquilibriumSolver solver(finger, {});
  const Ambiguity ambiguity(finger);
  std::mt19937_64 generator(seed);
  std::vector<CoverageCell> cells;
  for (const double arc : arcs_mm) {
    for (const double force : forces_N) {
      const Eigen::MatrixXd bound =
          CramerRaoCovariance({{arc, force, 0}}, &solver);
      cells.emplace_back();
      CoverageCell& cell = cells.back();
      cell.arc_mm = arc;
      cell.force_N = force;
      cell.arc_bound_mm = std::sqrt(bound(0, 0));
      cell.force_bound_N = std::sqrt(bound(1, 1));
      solver.Solve({{arc, force, 0}});
      cell.distance = ambiguity.Distance(solver, arc, cell.arc_bound_mm);
      const Measurements clean = CleanReadings(solver);
      for (int i = 0; i < repeats; ++i) {
        const FrameEstimate estimate =
            estimator.Estimate(WithNoise(clean, finger, &generator));
        const ContactEstimate& found = estimate.contact[0];
        cell.arc.Add(found.arc_mm - arc, found.arc_std_mm, cell.arc_bound_mm);
        cell.force.Add(found.normal_N - force, found.normal_std_N,
                       cell.force_bound_N);
        cell.far += std::abs(found.arc_mm - arc) > 5 * cell.arc_bound_mm;
        cell.not_ok += estimate.status != FrameStatus::kOk;
        cell.p_values.push_back(estimate.p_value());
      }
    }
  }
  return cells;
}

/// The Kolmogorov-Smirnov distance of numbers from the uniform distribution
/// over 0..1, times the root of their count: above 1.63 for one in a hundred
/// samples that are uniform.
inline double KolmogorovSmirnov(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  double distance = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    distance = std::max({distance, (i + 1) / n - values[i], values[i] - i / n});
  }
  return distance * std::sqrt(n);
}

/// The paper's finger with another noise of its gauges.
inline Finger PaperFingerWithNoise(double noise_rad) {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = noise_rad;
  return finger;
}

inline std::vector<double> Range(double first, double last, int count) {
  std::vector<double> values(count);
  for (int i = 0; i < count; ++i) {
    values[i] = first + (last - first) * i / (count - 1);
  }
  return values;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_COVERAGE_H_
