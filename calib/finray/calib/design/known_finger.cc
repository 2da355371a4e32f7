#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/analysis/plausibility.h"
#include "finray/calib/analysis/reading_noise.h"
#include "finray/calib/design/recording_plan.h"
#include "finray/calib/solve/information_spectrum.h"
#include "finray/calib/solve/robust_solve.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"

namespace finray {
namespace {

// A direction with less information is not known at all; nobody can say how far
// fingers differ along it.
constexpr double kLeastKnown = 1e-3;

// Frames from which the free parameters and their units come; not their
// information.
PlannedRecording AnyRecording(const Finger& finger, const Plan& plan,
                              const Discretization& discretization) {
  const double load_N = ForceUnit(finger);
  const ContactRange range{0.3 * finger.front_length_mm,
                           0.6 * finger.front_length_mm, load_N, 2 * load_N};
  return PlannedRecording(finger, plan, SpreadContacts(range, 12, 1),
                          discretization);
}

Eigen::MatrixXd PriorOf(const CalibrationParameters& parameters) {
  const auto n = static_cast<Eigen::Index>(parameters.free().size());
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(n, n);
  const Eigen::VectorXd unit = parameters.Units();
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& std = parameters.FreeParameter(k).prior_std;
    if (std) prior(k, k) = std::pow(unit[k] / *std, 2);
  }
  return prior;
}

CalibrationLogs ReadLogsWithReadings(const std::vector<std::string>& paths,
                                     const Finger& finger, const Plan& plan) {
  CalibrationLogs logs = ReadCalibrationLogs(paths, finger, plan);
  const bool any = std::any_of(
      logs.frames.begin(), logs.frames.end(), [](const auto& frame) {
        return std::any_of(frame.gauges_V.begin(), frame.gauges_V.end(),
                           [](double volts) { return std::isfinite(volts); });
      });
  if (any) return logs;
  throw InputError(paths.front() + (paths.size() > 1 ? " and others" : "") +
                   ": no row has a reading of a gauge");
}

}  // namespace

KnownFinger FromDrawing(const Finger& finger, const Plan& plan,
                        const Discretization& discretization) {
  const PlannedRecording any = AnyRecording(finger, plan, discretization);
  return {finger, {}, PriorOf(any.problem().parameters())};
}

KnownFinger FromLogs(const Finger& finger, const Plan& plan,
                     const std::vector<std::string>& logs,
                     const Discretization& discretization, int threads) {
  CalibrationProblem problem(finger, plan,
                             ReadLogsWithReadings(logs, finger, plan),
                             discretization, threads);
  RefuseImplausible(&problem);
  const CalibrationSolution solution = SolveRobustly(&problem);
  if (!solution.solve.converged) {
    throw std::runtime_error("the calibration of the logs did not converge");
  }
  const Identifiability found = AnalyzeIdentifiability(&problem, solution.at);
  CalibrationParameters& parameters = problem.parameters();
  KnownFinger known;
  known.rows = problem.FittedFrames().size();
  known.copies = problem.logs().copies;
  known.finger = parameters.Apply(finger);
  const std::vector<double> reading_V = ReadingNoise_V(problem);
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    // Without a scatter the plan's std may be that of means.
    double& noise_V = known.finger.gauges[j].noise_V;
    const bool scatter = std::isfinite(problem.logs().reading_std_V[j]);
    noise_V = scatter ? reading_V[j] : std::max(noise_V, reading_V[j]);
  }
  known.stage = parameters.Stage(parameters.last_fitted_log());

  // By name, because parameters of a log are new in the next one.
  const PlannedRecording next =
      AnyRecording(known.finger, plan, discretization);
  const CalibrationParameters& of_next = next.problem().parameters();
  std::map<std::string, int> column_of;
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    column_of[parameters.FreeParameter(k).name] = static_cast<int>(k);
  }
  std::vector<int> from, to;
  known.information = PriorOf(of_next);
  for (std::size_t k = 0; k < of_next.free().size(); ++k) {
    const auto column = column_of.find(of_next.FreeParameter(k).name);
    if (column == column_of.end()) continue;
    from.push_back(column->second);
    to.push_back(static_cast<int>(k));
  }
  const Eigen::VectorXd ratio =
      of_next.Units()(to).cwiseQuotient(found.unit(from));
  known.information(to, to) =
      ratio.asDiagonal() *
      BoundedCovariance(Eigen::MatrixXd(found.covariance(from, from))) *
      ratio.asDiagonal();
  return known;
}

KnownFinger DrawFrom(const KnownFinger& known, const Plan& plan,
                     std::uint64_t seed, const Discretization& discretization) {
  PlannedRecording any = AnyRecording(known.finger, plan, discretization);
  CalibrationProblem& problem = any.problem();
  const InformationSpectrum spectrum(known.information);
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(spectrum.values.size());
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    const double z = normal(generator);
    if (spectrum.values[k] < kLeastKnown) continue;
    change += z / std::sqrt(spectrum.values[k]) * spectrum.vectors.col(k);
  }
  problem.SetValues(problem.Values() +
                    problem.parameters().Units().cwiseProduct(change));
  KnownFinger drawn = known;
  drawn.finger = problem.parameters().Apply(known.finger);
  // The stage of the draw stands behind the one that is known.
  const StageFrame moved = problem.parameters().Stage(0);
  drawn.stage.origin_mm = moved.InS(known.stage.origin_mm);
  drawn.stage.rotation_deg += moved.rotation_deg;
  drawn.stage.ln_scale += moved.ln_scale;
  return drawn;
}

}  // namespace finray
