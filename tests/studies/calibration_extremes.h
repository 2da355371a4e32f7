#ifndef FINRAY_TESTS_STUDIES_CALIBRATION_EXTREMES_H_
#define FINRAY_TESTS_STUDIES_CALIBRATION_EXTREMES_H_

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "calib/standard_log.h"
#include "finray/calib/analysis/plausibility.h"
#include "finray/calib/report/calibration_result.h"
#include "finray/io/error.h"
#include "finray/scene/frame_columns.h"

namespace finray {

inline Plan WithoutPriors(Plan plan) {
  for (FamilyPlan& family : plan.families) family.prior_std.reset();
  return plan;
}

/// The nominal finger with unit gains and the gauges' noise of another one.
inline Finger NominalWithNoiseOf(const Finger& truth) {
  const Finger paper = PaperFinger();
  Finger start = truth;
  start.front_stiffness_N_mm2 = paper.front_stiffness_N_mm2;
  start.back_stiffness_N_mm2 = paper.back_stiffness_N_mm2;
  for (std::size_t i = 0; i < start.ribs.size(); ++i) {
    start.ribs[i].length_mm = paper.ribs[i].length_mm;
  }
  for (Gauge& gauge : start.gauges) {
    gauge.gain_V_per_rad = 1;
    gauge.offset_V = 0;
  }
  return start;
}

/// The standard log (200 frames with contact, 10 free) of a finger, with its
/// gauges' noise, and how it is calibrated.
struct CalibrationCase {
  Finger truth = HiddenFinger();
  Finger start = NominalWithNoiseOf(truth);
  Plan plan = StandardPlan();
  double force_std_N = 0.02, object_std_mm = 0.05;  ///< of the log
  bool noisy_gauges = true;
  /// What else comes into the log.
  std::function<void(FrameTable* log)> disturb = [](FrameTable*) {};
};

/// The worst of some seeds.
struct CalibrationOutcome {
  double worst_std = 0;
  std::string worst_name;
  double stiffness = 0, gain = 0;            ///< relative errors
  double rib_mm = 0, offset_V = 0;           ///< errors
  double chi2_per_dof = 0;                   ///< of the first seed
  double condition_data = 0, condition = 0;  ///< of S, S + P, first seed
  double seconds = 0;                        ///< the longest
  int rejected = 0, agree = std::numeric_limits<int>::max();
  std::vector<std::string> said;    ///< by seed: verdict, exit code
  std::vector<double> values, std;  ///< of the last one's free parameters
};

inline double ConditionNumber(const Eigen::MatrixXd& symmetric) {
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues();
  const double largest = values[values.size() - 1];
  return values[0] > 0 ? largest / values[0]
                       : std::numeric_limits<double>::infinity();
}

inline void AddParameters(const CalibrationCase& c, CalibrationProblem& problem,
                          const Identifiability& found,
                          CalibrationOutcome* outcome) {
  const CalibrationParameters& parameters = problem.parameters();
  outcome->values.clear();
  outcome->std.clear();
  for (std::size_t i = 0; i < parameters.free().size(); ++i) {
    const CalibrationParameter& p = parameters.FreeParameter(i);
    const double truth = ParameterValue(c.truth, *p.of_finger);
    const double value = p.Value(*p.variable);
    const double off = std::abs(value - truth);
    const double std = p.ValueStd(*p.variable, found.std[i]);
    outcome->values.push_back(value);
    outcome->std.push_back(std);
    if (!(off / std <= outcome->worst_std)) {
      outcome->worst_std = off / std;
      outcome->worst_name = p.name;
    }
    double* worst = &outcome->rib_mm;
    double error = off;
    if (p.is_log) {
      worst = &outcome->stiffness;
      error /= truth;
    } else if (p.family == ParameterFamily::kGaugeGain) {
      worst = &outcome->gain;
      error /= std::abs(truth);
    } else if (p.family == ParameterFamily::kGaugeOffset) {
      worst = &outcome->offset_V;
    }
    *worst = std::max(*worst, error);
  }
}

/// As finray_calibrate does it, its exit code included.
inline void CalibrateOnce(const CalibrationCase& c, unsigned seed,
                          CalibrationOutcome* outcome) {
  const TempFolder folder;
  Finger recorded = c.truth;
  if (!c.noisy_gauges) {
    for (Gauge& gauge : recorded.gauges) gauge.noise_V = 0;
  }
  FrameTable log = MakeLog(recorded, StandardFrames(c.truth, seed),
                           {c.force_std_N, c.object_std_mm, seed});
  c.disturb(&log);
  log.Write(folder.Path("log.csv"));
  try {
    CalibrationProblem problem(
        c.start, c.plan,
        ReadCalibrationLogs({folder.Path("log.csv")}, c.start, c.plan), {}, 2);
    RefuseImplausible(&problem);
    const CalibrationResult result = Calibrate(&problem);
    const Identifiability& found = result.identifiability;
    AddParameters(c, problem, found, outcome);
    if (outcome->said.empty()) {
      double chi2 = 0, dof = 0;
      for (const Identifiability::Noise& noise : found.noise) {
        chi2 += noise.chi2;
        dof += noise.dof;
      }
      outcome->chi2_per_dof = chi2 / dof;
      outcome->condition_data = ConditionNumber(found.information);
      outcome->condition = ConditionNumber(found.information + found.prior);
    }
    outcome->rejected = std::max(outcome->rejected,
                                 static_cast<int>(problem.rejected().size()));
    const auto& starts = result.solution.starts;
    outcome->agree =
        std::min(outcome->agree, static_cast<int>(std::count_if(
                                     starts.begin(), starts.end(),
                                     [](const auto& s) { return s.agrees; })));
    const std::string verdict = result.Verdict();
    std::string said = verdict + (verdict == "good"            ? " 0"
                                  : verdict == "not_converged" ? " 3"
                                                               : " 4");
    for (const Warning& warning : result.warnings) {
      if (said.find(warning.code) == std::string::npos) {
        said += ", " + warning.code;
      }
    }
    outcome->said.push_back(said);
  } catch (const InputError& error) {
    outcome->said.push_back(std::string("bad input 2: ") + error.what());
  } catch (const std::exception& error) {
    outcome->said.push_back(std::string("failed 3: ") + error.what());
  }
}

inline CalibrationOutcome RunCalibration(const CalibrationCase& c, int seeds) {
  CalibrationOutcome outcome;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto before = std::chrono::steady_clock::now();
    CalibrateOnce(c, static_cast<unsigned>(seed), &outcome);
    const std::chrono::duration<double> took =
        std::chrono::steady_clock::now() - before;
    outcome.seconds = std::max(outcome.seconds, took.count());
  }
  return outcome;
}

inline void PrintCalibrationHeader(const char* varied) {
  std::printf(
      "| %s | worst parameter, std | stiffness off by | gain | rib, mm | "
      "offset, V | chi2/dof | condition of S, S + P | starts that agree | "
      "rejected | s | verdict, exit code, warnings "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      varied);
}

inline void PrintCalibration(const std::string& name,
                             const CalibrationOutcome& o) {
  std::string said;
  for (std::size_t i = 0; i < o.said.size(); ++i) {
    if (i == 0 || o.said[i] != o.said[0]) {
      said += (i == 0 ? "" : "; ") + o.said[i];
    }
  }
  std::printf(
      "| %s | %.2g (%s) | %.1e | %.1e | %.1e | %.1e | %.3g | %.1e, %.1e | %d | "
      "%d | %.0f | %s |\n",
      name.c_str(), o.worst_std, o.worst_name.c_str(), o.stiffness, o.gain,
      o.rib_mm, o.offset_V, o.chi2_per_dof, o.condition_data, o.condition,
      o.values.empty() ? 0 : o.agree, o.rejected, o.seconds, said.c_str());
  std::fflush(stdout);
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_CALIBRATION_EXTREMES_H_
