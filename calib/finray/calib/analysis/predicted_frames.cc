#include "finray/calib/analysis/predicted_frames.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <unordered_map>

#include "finray/calib/analysis/reading_noise.h"
#include "finray/calib/solve/frame_pass.h"
#include "finray/finger/geometry.h"
#include "finray/io/nan.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

constexpr int kHeights = 9;
constexpr double kLoads[] = {0.1, 0.3, 0.6, 1};  // shares of the largest
// Loads in EI / l_0^2: one that a finger carries with ease, and the largest.
constexpr double kUsualLoad = 10, kLargestLoad = 40;

double TwoDigits(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::round(value / unit) * unit;
}

// Returns a frame of the log, time and temperature of one in the logs, without
// its measurements.
CalibrationFrame Template(const CalibrationProblem& problem, bool contact) {
  CalibrationFrame frame;
  for (const CalibrationFrame& recorded : problem.logs().frames) {
    if (recorded.held_out || recorded.IsBench()) continue;
    frame.log = recorded.log;
    frame.time_s = recorded.time_s;
    frame.temperature_C = recorded.temperature_C;
    frame.gauge_readings = recorded.gauge_readings;
    frame.force_std_times = recorded.force_std_times;
    if (recorded.contact == contact) break;
  }
  frame.contact = contact;
  return frame;
}

// Returns a load that the logs show the finger to bear. A few wild frames do
// not count.
double LargestLoad(const Finger& finger, const Contacts& contacts) {
  const double unit = ForceUnit(finger);
  std::vector<double> forces;
  for (const auto& [arc_mm, normal_N] : contacts) {
    if (normal_N > 0) forces.push_back(normal_N);
  }
  if (forces.empty()) return kUsualLoad * unit;
  const auto high =
      forces.begin() + static_cast<long>(forces.size() * 95 / 100);
  std::nth_element(forces.begin(), high, forces.end());
  return std::clamp(*high, kUsualLoad * unit, kLargestLoad * unit);
}

// Returns the first fitted frame of each log.
std::vector<CalibrationFrame> FirstFrames(const CalibrationProblem& problem) {
  std::vector<CalibrationFrame> frames;
  std::set<int> seen;
  for (const CalibrationFrame& frame : problem.logs().frames) {
    if (!frame.held_out && seen.insert(frame.log).second) {
      frames.push_back(frame);
    }
  }
  return frames;
}

// Says which gauges some frame has read. The others will not read next time
// either.
std::vector<bool> WorkingGauges(const CalibrationProblem& problem) {
  std::vector<bool> works(problem.finger().gauges.size(), false);
  for (const CalibrationFrame& frame : problem.logs().frames) {
    for (std::size_t j = 0; j < works.size(); ++j) {
      if (std::isfinite(frame.gauges_V[j])) works[j] = true;
    }
  }
  return works;
}

// The rows of gauges, over the std of one reading.
LinearizedFrame GaugeRows(const LinearizedFrame& at,
                          const std::vector<double>& more_noise_V) {
  std::vector<int> gauges;
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    if (at.rows[i].family == ResidualFamily::kGauge) {
      gauges.push_back(static_cast<int>(i));
    }
  }
  LinearizedFrame rows = at.WithRows(gauges);
  for (std::size_t i = 0; i < gauges.size(); ++i) {
    const LinearizedFrame::Row& row = rows.rows[i];
    const double share =
        row.std_V /
        std::hypot(row.std_V,
                   more_noise_V[static_cast<std::size_t>(row.gauge)]);
    const auto k = static_cast<Eigen::Index>(i);
    rows.by_contact.row(k) *= share;
    rows.by_parameter.row(k) *= share;
  }
  return rows;
}

}  // namespace

bool PredictReadings(const std::vector<PointContact>& contacts,
                     const std::vector<bool>& works, const Plan& plan,
                     const StageFrame& stage, EquilibriumSolver* solver,
                     CalibrationFrame* frame) {
  solver->Reset();
  if (!solver->Solve(contacts)) return false;
  const Finger& finger = solver->model().finger();
  frame->gauges_V.resize(works.size());
  for (std::size_t j = 0; j < works.size(); ++j) {
    const double angle = solver->gauge_angle(static_cast<int>(j));
    frame->gauges_V[j] = works[j] ? finger.gauges[j].Volts(angle) : kNaN;
  }
  if (contacts.empty()) return true;
  frame->force_N = contacts[0].normal_N * std::hypot(1, contacts[0].friction);
  frame->contact_mm = contacts[0].arc_mm;
  if (plan.scene.circle_radius_mm()) {
    frame->object_mm = stage.FromS(
        CircleCentre(solver->contact_pose(0), *plan.scene.circle_radius_mm()));
  }
  return true;
}

PredictedFrames PredictFrames(CalibrationProblem* problem,
                              const Contacts& contacts,
                              const Eigen::VectorXd& unit) {
  PredictedFrames predicted;
  const Finger finger = problem->parameters().Apply(problem->finger());
  const Plan& plan = problem->plan();
  const double largest_N = LargestLoad(problem->finger(), contacts);
  for (const double share : kLoads) {
    predicted.forces_N.push_back(TwoDigits(share * largest_N));
  }

  // The candidates stand behind a frame of each log, so that the parameters
  // of all logs exist. They are linearised like any frame.
  CalibrationLogs logs = problem->logs();
  logs.frames = FirstFrames(*problem);
  const int recorded = static_cast<int>(logs.frames.size());
  EquilibriumSolver solver(finger, problem->discretization());
  const std::vector<bool> works = WorkingGauges(*problem);
  CalibrationFrame frame = Template(*problem, false);
  const StageFrame stage = problem->parameters().Stage(frame.log);
  if (PredictReadings({}, works, plan, stage, &solver, &frame)) {
    logs.frames.push_back(frame);
    predicted.frames.push_back({true, kNaN, 0, {kNaN, kNaN}, {}});
  }
  frame = Template(*problem, true);
  predicted.gauge_readings = frame.gauge_readings;
  const StageFrame touching = problem->parameters().Stage(frame.log);
  const bool may_touch = plan.scene.contacts.value_or(1) > 0;
  for (int i = 1; may_touch && i <= kHeights; ++i) {
    const double arc = std::round(finger.front_length_mm * i / (kHeights + 1));
    for (const double force : predicted.forces_N) {
      if (!PredictReadings({{arc, force, problem->parameters().friction()}},
                           works, plan, touching, &solver, &frame)) {
        continue;
      }
      logs.frames.push_back(frame);
      predicted.frames.push_back({false, arc, force, frame.object_mm, {}});
    }
  }
  CalibrationProblem extended(finger, plan, logs, problem->discretization(), 1);
  // Parameters are found by name, because the candidates may have other steps
  // of a drift and other sensors.
  const CalibrationParameters& known = problem->parameters();
  std::unordered_map<std::string, int> column_of;  // by name
  std::unordered_map<std::string, const double*> value_of;
  for (const CalibrationParameter& p : known.all()) {
    value_of[p.name] = p.variable;
  }
  const int columns = static_cast<int>(known.free().size());
  for (int k = 0; k < columns; ++k) {
    column_of[known.FreeParameter(k).name] = k;
  }
  const CalibrationParameters& of_extended = extended.parameters();
  for (const CalibrationParameter& p : of_extended.all()) {
    if (const auto value = value_of.find(p.name); value != value_of.end()) {
      *p.variable = *value->second;
    }
  }
  ContactStore places(&extended);
  const auto keep = [&](int frame, const LinearizedFrame& at) {
    const int index = frame - recorded;
    if (index < 0) return;
    LinearizedFrame& candidate = predicted.frames[index].at;
    candidate = at;
    candidate.by_parameter.setZero(at.by_parameter.rows(), columns);
    for (std::size_t k = 0; k < of_extended.free().size(); ++k) {
      const auto column = column_of.find(of_extended.FreeParameter(k).name);
      if (column == column_of.end()) continue;
      candidate.by_parameter.col(column->second) =
          at.by_parameter.col(static_cast<Eigen::Index>(k)) *
          unit[column->second];
    }
  };
  LinearizeFrames(extended.candidates(), &extended, &places, keep);
  // Some candidates have too few measurements to be a frame.
  predicted.frames.erase(
      std::remove_if(predicted.frames.begin(), predicted.frames.end(),
                     [](const PredictedFrame& candidate) {
                       return candidate.at.rows.empty();
                     }),
      predicted.frames.end());
  return predicted;
}

double PredictedForce::calibration_N(const Eigen::MatrixXd& covariance) const {
  return std::sqrt(weight.cwiseProduct(covariance).sum());
}

std::vector<double> MoreNoise_V(const Finger& rows, double gauge_readings,
                                const std::vector<double>& reading_noise_V) {
  std::vector<double> more_V;
  for (std::size_t j = 0; j < rows.gauges.size(); ++j) {
    const double row_V =
        Measurements::MeanStd(rows.gauges[j].noise_V, gauge_readings);
    more_V.push_back(std::sqrt(std::max(
        0.0, reading_noise_V[j] * reading_noise_V[j] - row_V * row_V)));
  }
  return more_V;
}

std::optional<GaugedContact> SensedBy(const LinearizedFrame& at,
                                      const std::vector<double>& more_noise_V) {
  LinearizedFrame rows = GaugeRows(at, more_noise_V);
  if (rows.rows.size() < 2) return {};
  GaugedContact sensed;
  sensed.noise = PseudoInverse(Eigen::Matrix2d(rows.Information()));
  rows.Eliminate(sensed.noise);
  sensed.by_parameter = rows.move.by_parameter;
  return sensed;
}

PredictedForce PredictForce(const CalibrationProblem& problem,
                            const PredictedFrames& predicted) {
  PredictedForce force;
  const auto n = static_cast<Eigen::Index>(problem.parameters().free().size());
  force.weight = Eigen::MatrixXd::Zero(n, n);
  const double per_normal = std::hypot(1, problem.parameters().friction());
  double noise = 0;
  const std::vector<double> more_noise_V = MoreNoise_V(
      problem.finger(), predicted.gauge_readings, ReadingNoise_V(problem));
  for (const PredictedFrame& frame : predicted.frames) {
    if (frame.free) continue;
    const std::optional<GaugedContact> sensed =
        SensedBy(frame.at, more_noise_V);
    if (!sensed) continue;
    const Eigen::Matrix2d& covariance = sensed->noise;
    const double place_std = std::sqrt(covariance(0, 0));
    const double force_std = std::sqrt(covariance(1, 1));
    if (place_std >
            PredictedForce::kSensedPlace * problem.finger().front_length_mm ||
        force_std > PredictedForce::kSensedForce * frame.normal_N) {
      continue;
    }
    const Eigen::RowVectorXd by_parameter =
        per_normal * sensed->by_parameter.row(1);
    force.weight += by_parameter.transpose() * by_parameter;
    noise += per_normal * per_normal * covariance(1, 1);
    force.contacts.emplace_back(frame.contact_mm, frame.normal_N);
  }
  if (force.contacts.empty()) return force;
  const auto count = static_cast<double>(force.contacts.size());
  force.weight /= count;
  force.noise_N = std::sqrt(noise / count);
  return force;
}

}  // namespace finray
