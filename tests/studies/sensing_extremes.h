#ifndef FINRAY_TESTS_STUDIES_SENSING_EXTREMES_H_
#define FINRAY_TESTS_STUDIES_SENSING_EXTREMES_H_

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "finray/finger/geometry.h"
#include "studies/gauge_frames.h"
#include "test_finger.h"

namespace finray {

/// Where the gauges tell a contact well.
inline std::vector<PointContact> UsualPlaces() {
  std::vector<PointContact> places;
  for (const double arc : {25.0, 40.0, 61.0, 75.0, 90.0, 105.0}) {
    for (const double force : {0.5, 2.0, 6.0}) places.push_back({arc, force});
  }
  return places;
}

/// A finger and its loads in other units: lengths and forces times these.
inline Finger InUnits(Finger finger, double length, double force) {
  finger.front_length_mm *= length;
  finger.front_stiffness_N_mm2 *= force * length * length;
  finger.back_stiffness_N_mm2 *= force * length * length;
  for (Rib& rib : finger.ribs) {
    rib.front_mm *= length;
    rib.back_mm *= length;
    rib.length_mm *= length;
  }
  for (Gauge& gauge : finger.gauges) {
    gauge.start_mm *= length;
    gauge.length_mm *= length;
  }
  return finger;
}

/// What is simulated, and what the estimator makes of it. By default: what it
/// is told is true, and each gauge has the noise that its noise_V says.
struct SensingCase {
  Finger truth = PaperFinger();
  /// The finger that the estimator is given.
  Finger told = truth;
  /// Noise of all gauges, as a share of the rms of the cell's readings, rad.
  double noise_of_reading = -1;
  /// What comes between clean readings and the estimator.
  std::function<void(const Finger& told, std::mt19937_64*, Measurements*)>
      disturb = [](const Finger& told, std::mt19937_64* generator,
                   Measurements* readings) {
        *readings = WithNoise(*readings, told, generator);
      };
  std::vector<PointContact> places = UsualPlaces();
  /// Contacts are spread about their places, so that no two frames are alike.
  double arc_spread_mm = 2, force_spread = 0.05;
  bool automatic = false;  ///< `contacts: auto` instead of 1
};

struct SensingOutcome {
  int frames = 0, beyond_limit = 0;  ///< the latter have no truth
  std::array<int, 5> status{};
  int unexplained = 0;
  // Of status ok.
  std::vector<double> arc_error, force_error;       ///< over l_0 and over f_c
  std::array<int, 2> arc_within{}, force_within{};  ///< 1 and 1.96 std
  int over_6_std = 0, not_a_number = 0;
  int explained_over_6_std = 0;  ///< of those, with a p-value above 0.001
  std::vector<FrameEstimate> estimates;  ///< of all

  int ok() const { return status[static_cast<int>(FrameStatus::kOk)]; }
  int count(FrameStatus which) const { return status[static_cast<int>(which)]; }

  void Add(const PointContact& truth, double length_mm,
           const FrameEstimate& estimate) {
    ++frames;
    ++status[static_cast<int>(estimate.status)];
    unexplained += estimate.p_value() < FrameEstimate::kUnexplained;
    estimates.push_back(estimate);
    if (estimate.status != FrameStatus::kOk) return;
    const ContactEstimate& found = estimate.contact[0];
    const double arc = std::abs(found.arc_mm - truth.arc_mm);
    const double force = std::abs(found.normal_N - truth.normal_N);
    arc_error.push_back(arc / length_mm);
    force_error.push_back(force / truth.normal_N);
    const double limits[] = {1, 1.96};
    for (int k = 0; k < 2; ++k) {
      arc_within[k] += arc <= limits[k] * found.arc_std_mm;
      force_within[k] += force <= limits[k] * found.normal_std_N;
    }
    // Digits that a double has not got are no error.
    const bool over = arc > 6 * found.arc_std_mm + 1e-9 * length_mm ||
                      force > 6 * found.normal_std_N + 1e-9 * truth.normal_N;
    over_6_std += over;
    explained_over_6_std +=
        over && !(estimate.p_value() < FrameEstimate::kUnexplained);
    not_a_number += !std::isfinite(arc) || !std::isfinite(force) ||
                    !std::isfinite(found.arc_std_mm) ||
                    !std::isfinite(found.normal_std_N);
  }
};

inline double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  const auto at =
      values.begin() + static_cast<long>(share * (values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// `frames` at each place. Truths are from a finer mesh than the estimator's.
inline SensingOutcome RunSensing(const SensingCase& c, int frames,
                                 unsigned seed = 1) {
  Scene scene;
  if (!c.automatic) scene.contacts = 1;
  // Some cases press harder than is credible by default.
  scene.force_max_N = 160 * ForceUnit(c.told);
  EquilibriumSolver solver(c.truth, {Scheme::kTaylor, 96});
  std::unique_ptr<FrameEstimator> estimator;
  std::mt19937_64 generator(seed);
  SensingOutcome outcome;
  for (const PointContact& place : c.places) {
    Finger told = c.told;
    if (c.noise_of_reading >= 0) {
      solver.Solve({place});
      const Eigen::VectorXd angles = solver.outputs().head(told.gauges.size());
      const double rms = angles.norm() / std::sqrt(double(angles.size()));
      for (Gauge& gauge : told.gauges) {
        gauge.noise_V =
            c.noise_of_reading * rms * std::abs(gauge.gain_V_per_rad);
      }
      estimator.reset();
    }
    if (!estimator) {
      estimator =
          std::make_unique<FrameEstimator>(told, scene, Discretization());
    }
    std::uniform_real_distribution<double> about(-1, 1);
    for (int i = 0; i < frames; ++i) {
      PointContact contact = place;
      contact.arc_mm += c.arc_spread_mm * about(generator);
      contact.normal_N *= 1 + c.force_spread * about(generator);
      if (!solver.Solve({contact})) {
        ++outcome.beyond_limit;
        continue;
      }
      Measurements readings = CleanReadings(solver);
      c.disturb(told, &generator, &readings);
      outcome.Add(contact, c.truth.front_length_mm,
                  estimator->Estimate(readings));
    }
  }
  return outcome;
}

/// Of the gauges' slopes by l_c and f_c in units of their std, l_0 and f_c:
/// the ratio of the singular values, and how many std of a gauge a change of
/// l_0 or f_c along the weaker direction makes.
struct SensingCondition {
  double number = 0, least = 0;
};

inline SensingCondition ConditionOf(const Finger& finger,
                                    const PointContact& contact) {
  EquilibriumSolver solver(finger, {});
  if (!solver.SolveWithSensitivities({contact})) return {};
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  Eigen::MatrixXd slope = solver.d_outputs().topLeftCorner(gauges, 2);
  slope.col(0) *= finger.front_length_mm;
  slope.col(1) *= contact.normal_N;
  for (Eigen::Index j = 0; j < gauges; ++j) {
    slope.row(j) *= finger.gauges[j].AngleWeight();
  }
  const Eigen::VectorXd singular =
      Eigen::JacobiSVD<Eigen::MatrixXd>(slope).singularValues();
  return {singular[0] / singular[1], singular[1]};
}

inline void PrintSensingHeader(const char* varied) {
  std::printf(
      "| %s | l_c off by, of l_0: median, 99 %% | f_c off by, of f_c | l_c "
      "within 1, 1.96 std, %% | f_c | ok, unobservable, no contact, not "
      "converged, %% | unexplained, %% | ok, but over 6 std; explained; NaN "
      "|\n|---|---|---|---|---|---|---|---|\n",
      varied);
}

inline void PrintSensing(const std::string& name, const SensingOutcome& o) {
  const double ok = std::max(1, o.ok()), all = std::max(1, o.frames);
  std::printf("| %s | %.1e, %.1e | %.1e, %.1e | ", name.c_str(),
              Quantile(o.arc_error, 0.5), Quantile(o.arc_error, 0.99),
              Quantile(o.force_error, 0.5), Quantile(o.force_error, 0.99));
  std::printf("%.1f, %.1f | %.1f, %.1f | ", 100 * o.arc_within[0] / ok,
              100 * o.arc_within[1] / ok, 100 * o.force_within[0] / ok,
              100 * o.force_within[1] / ok);
  std::printf("%.1f, %.1f, %.1f, %.1f | %.2f | %d; %d; %d |\n",
              100 * o.ok() / all,
              100 * o.count(FrameStatus::kUnobservable) / all,
              100 * o.count(FrameStatus::kNoContact) / all,
              100 * o.count(FrameStatus::kNotConverged) / all,
              100 * o.unexplained / all, o.over_6_std, o.explained_over_6_std,
              o.not_a_number);
  std::fflush(stdout);
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_SENSING_EXTREMES_H_
