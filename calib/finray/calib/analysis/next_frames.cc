#include "finray/calib/analysis/next_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include "finray/calib/solve/frame_pass.h"
#include "finray/calib/solve/information_spectrum.h"
#include "finray/calib/solve/linearization.h"
#include "finray/finger/geometry.h"
#include "finray/io/nan.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

constexpr int kHeights = 9;
constexpr double kLoads[] = {0.1, 0.3, 0.6, 1};  // shares of the largest
// Loads in EI / l_0^2: one that a finger carries with ease, and the largest.
constexpr double kUsualLoad = 10, kLargestLoad = 40;
constexpr double kWorthwhile = 0.9;
constexpr std::size_t kMostAdvice = 4;

double TwoDigits(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::round(value / unit) * unit;
}

bool Has(const std::vector<ResidualFamily>& families, ResidualFamily family) {
  return std::find(families.begin(), families.end(), family) != families.end();
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

// Fills in the readings of all sensors. Returns false if the finger cannot
// carry the contact, if there is one.
bool Measure(const std::vector<PointContact>& contacts,
             const std::vector<bool>& works, const Plan& plan,
             EquilibriumSolver* solver, CalibrationFrame* frame) {
  solver->Reset();
  if (!solver->Solve(contacts)) return false;
  const Finger& finger = solver->model().finger();
  frame->gauges_V.resize(works.size());
  for (std::size_t j = 0; j < works.size(); ++j) {
    const double angle = solver->gauge_angle(static_cast<int>(j));
    frame->gauges_V[j] = works[j] ? finger.gauges[j].Volts(angle) : kNaN;
  }
  if (contacts.empty()) return true;
  frame->force_N = contacts[0].normal_N;
  frame->contact_mm = contacts[0].arc_mm;
  if (plan.scene.circle_radius_mm()) {
    frame->object_mm =
        CircleCentre(solver->contact_pose(0), *plan.scene.circle_radius_mm());
  }
  return true;
}

// Holds the predicted frames, for advice on one direction after the other.
class NextFrames {
 public:
  NextFrames(CalibrationProblem* problem, const CalibrationSolution& solution,
             const Identifiability& found)
      : problem_(problem), found_(found) {
    Predict(solution.contacts);
    ChooseMeasurements(solution.at);
  }

  // Returns the best few pieces of advice, the best one first. Each set of
  // measurements has its best place and load, if these shrink the std along
  // `direction` to 90 % or less. `direction` is a unit vector over the free
  // parameters, in units of Identifiability. An added measurement is named only
  // if it helps more than the same frames without it.
  std::vector<FrameAdvice> Best(const Eigen::VectorXd& direction) const {
    std::vector<FrameAdvice> all;
    for (const Families& added : added_) {
      const FrameAdvice best = BestWith(added, direction);
      double bar = 1;  // the ratio that fewer measurements reach
      for (const FrameAdvice& other : all) {
        const bool fewer =
            std::all_of(other.added.begin(), other.added.end(),
                        [&](ResidualFamily f) { return Has(added, f); });
        if (fewer) bar = std::min(bar, other.ratio());
      }
      if (best.ratio() <= kWorthwhile * bar) all.push_back(best);
    }
    for (const Candidate& candidate : candidates_) {
      if (!candidate.free) continue;
      FrameAdvice advice;
      advice.free = true;
      Judge(Information(candidate, {ResidualFamily::kGauge}), direction,
            &advice);
      if (advice.ratio() <= kWorthwhile) all.push_back(advice);
    }
    // If two have the same effect, the one that asks for less comes first.
    std::stable_sort(all.begin(), all.end(),
                     [](const FrameAdvice& a, const FrameAdvice& b) {
                       return a.std_after < 0.98 * b.std_after;
                     });
    if (all.size() > kMostAdvice) all.resize(kMostAdvice);
    if (const auto known = KnownGains(direction)) all.push_back(*known);
    for (FrameAdvice& advice : all) {
      advice.words = DescribeNextFrames(*problem_, advice);
    }
    return all;
  }

 private:
  // One predicted frame. Its parameters are those of Identifiability, in its
  // units.
  struct Candidate {
    bool free;
    double contact_mm, normal_N;
    LinearizedFrame at;
  };
  using Families = std::vector<ResidualFamily>;

  void Predict(const Contacts& contacts) {
    const Finger finger = problem_->parameters().Apply(problem_->finger());
    const Plan& plan = problem_->plan();
    const double largest_N = LargestLoad(problem_->finger(), contacts);
    for (const double share : kLoads) {
      forces_N_.push_back(TwoDigits(share * largest_N));
    }

    // The candidates stand behind a frame of each log, so that the parameters
    // of all logs exist. They are linearised like any frame.
    CalibrationLogs logs = problem_->logs();
    logs.frames = FirstFrames(*problem_);
    const int recorded = static_cast<int>(logs.frames.size());
    EquilibriumSolver solver(finger, problem_->discretization());
    const std::vector<bool> works = WorkingGauges(*problem_);
    CalibrationFrame frame = Template(*problem_, false);
    if (Measure({}, works, plan, &solver, &frame)) {
      logs.frames.push_back(frame);
      candidates_.push_back({true, kNaN, 0, {}});
    }
    frame = Template(*problem_, true);
    const bool may_touch = plan.scene.contacts.value_or(1) > 0;
    for (int i = 1; may_touch && i <= kHeights; ++i) {
      const double arc =
          std::round(finger.front_length_mm * i / (kHeights + 1));
      for (const double force : forces_N_) {
        if (!Measure({{arc, force, plan.scene.friction_coefficient}}, works,
                     plan, &solver, &frame)) {
          continue;
        }
        logs.frames.push_back(frame);
        candidates_.push_back({false, arc, force, {}});
      }
    }
    CalibrationProblem predicted(finger, plan, logs, problem_->discretization(),
                                 1);
    // Parameters are found by name, because the candidates may have other steps
    // of a drift and other sensors.
    const CalibrationParameters& known = problem_->parameters();
    std::unordered_map<std::string, int> column_of;  // by name
    std::unordered_map<std::string, const double*> value_of;
    for (const CalibrationParameter& p : known.all()) {
      value_of[p.name] = p.variable;
    }
    const int columns = static_cast<int>(known.free().size());
    for (int k = 0; k < columns; ++k) {
      column_of[known.FreeParameter(k).name] = k;
    }
    const CalibrationParameters& of_predicted = predicted.parameters();
    for (const CalibrationParameter& p : of_predicted.all()) {
      if (const auto value = value_of.find(p.name); value != value_of.end()) {
        *p.variable = *value->second;
      }
    }
    ContactStore places(&predicted);
    const auto keep = [&](int frame, const LinearizedFrame& at) {
      const int index = frame - recorded;
      if (index < 0) return;
      LinearizedFrame& candidate = candidates_[index].at;
      candidate = at;
      candidate.by_parameter.setZero(at.by_parameter.rows(), columns);
      for (std::size_t k = 0; k < of_predicted.free().size(); ++k) {
        const auto column = column_of.find(of_predicted.FreeParameter(k).name);
        if (column == column_of.end()) continue;
        candidate.by_parameter.col(column->second) =
            at.by_parameter.col(static_cast<Eigen::Index>(k)) *
            found_.unit[column->second];
      }
    };
    LinearizeFrames(predicted.candidates(), &predicted, &places, keep);
    // Some candidates have too few measurements to be a frame.
    candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(),
                                     [](const Candidate& candidate) {
                                       return candidate.at.rows.empty();
                                     }),
                      candidates_.end());
  }

  // Chooses the sets of measurements: those of the contact frames in the logs,
  // and these with one or two more.
  void ChooseMeasurements(const Linearization& at_solution) {
    recorded_ = {ResidualFamily::kGauge};
    for (const ResidualInfo& row : at_solution.rows) {
      if (problem_->frame(row.frame).contact && !Has(recorded_, row.family)) {
        recorded_.push_back(row.family);
      }
    }
    Families missing;
    for (const Candidate& candidate : candidates_) {
      for (const LinearizedFrame::Row& row : candidate.at.rows) {
        if (!Has(recorded_, row.family) && !Has(missing, row.family)) {
          missing.push_back(row.family);
        }
      }
    }
    added_.push_back({});
    for (const ResidualFamily family : missing) added_.push_back({family});
    // If the logs have neither force nor place, one of the two may not be
    // enough.
    const bool placed = Has(recorded_, ResidualFamily::kObject) ||
                        Has(recorded_, ResidualFamily::kContact);
    for (const ResidualFamily place :
         {ResidualFamily::kObject, ResidualFamily::kContact}) {
      if (Has(missing, ResidualFamily::kForce) && Has(missing, place) &&
          !placed) {
        added_.push_back({ResidualFamily::kForce, place});
      }
    }
  }

  Eigen::MatrixXd Information(const Candidate& candidate,
                              const Families& measured) const {
    const LinearizedFrame& at = candidate.at;
    std::vector<int> rows;
    for (std::size_t i = 0; i < at.rows.size(); ++i) {
      if (Has(measured, at.rows[i].family)) rows.push_back(static_cast<int>(i));
    }
    const Eigen::MatrixXd j = EliminateContact(
        at.by_parameter(rows, Eigen::all), at.by_contact(rows, Eigen::all));
    return j.transpose() * j;
  }

  void Judge(const Eigen::MatrixXd& information,
             const Eigen::VectorXd& direction, FrameAdvice* advice) const {
    const Eigen::MatrixXd known = found_.information + found_.prior;
    std::vector<int> all(direction.size());
    std::iota(all.begin(), all.end(), 0);
    Spread(found_.covariance,
           BoundedCovariance(known + FrameAdvice::kFrames * information),
           direction, all, advice);
  }

  // Sets the std of the advice. The covariances have a row for each of these
  // `parameters`, which are indices of free parameters.
  void Spread(const Eigen::MatrixXd& before, const Eigen::MatrixXd& after,
              const Eigen::VectorXd& direction,
              const std::vector<int>& parameters, FrameAdvice* advice) const {
    advice->std_before = std::sqrt(direction.dot(before * direction));
    advice->std_after = std::sqrt(direction.dot(after * direction));
    Eigen::Index largest;
    direction.cwiseAbs().maxCoeff(&largest);
    const int free = parameters[static_cast<std::size_t>(largest)];
    advice->parameter = problem_->parameters().free()[free];
    const CalibrationParameter& p =
        problem_->parameters().all()[advice->parameter];
    // Correlated residuals enlarge the std, and they will enlarge that of new
    // frames likewise.
    const double enlarged =
        found_.bounded_std[free] /
        (found_.unit[free] * std::sqrt(before(largest, largest)));
    const auto std = [&](double variance) {
      // A variance that has only the bound of BoundedCovariance is not known.
      if (variance > 0.01 / kLeastInformation) {
        return std::numeric_limits<double>::infinity();
      }
      return p.ValueStd(*p.variable, found_.unit[free] * std::sqrt(variance)) *
             enlarged;
    };
    advice->parameter_std_before = std(before(largest, largest));
    advice->parameter_std_after = std(after(largest, largest));
  }

  // Returns the best advice on contact frames with the measurements of the logs
  // and the added ones.
  FrameAdvice BestWith(const Families& added,
                       const Eigen::VectorXd& direction) const {
    Families measured = recorded_;
    measured.insert(measured.end(), added.begin(), added.end());
    FrameAdvice best;
    best.std_before = best.std_after = 1;
    const auto consider = [&](const Eigen::MatrixXd& information, double arc,
                              double force) {
      FrameAdvice advice;
      advice.contact_mm = arc;
      advice.normal_N = force;
      advice.added = added;
      Judge(information, direction, &advice);
      if (advice.ratio() < best.ratio()) best = advice;
    };
    for (const double force : forces_N_) {
      Eigen::MatrixXd spread =
          Eigen::MatrixXd::Zero(direction.size(), direction.size());
      int heights = 0;
      for (const Candidate& candidate : candidates_) {
        if (candidate.free || candidate.normal_N != force) continue;
        const Eigen::MatrixXd one = Information(candidate, measured);
        consider(one, candidate.contact_mm, force);
        spread += one;
        ++heights;
      }
      if (heights > 1) consider(spread / heights, kNaN, force);
    }
    return best;
  }

  // Predicts the same data with known gains: the rows and columns of the gains
  // are left out.
  std::optional<FrameAdvice> KnownGains(
      const Eigen::VectorXd& direction) const {
    const CalibrationParameters& parameters = problem_->parameters();
    std::vector<int> others;
    for (int i = 0; i < direction.size(); ++i) {
      if (parameters.FreeParameter(i).family != ParameterFamily::kGaugeGain) {
        others.push_back(i);
      }
    }
    if (others.empty()) return {};
    Eigen::VectorXd rest = direction(others);
    const double share = rest.squaredNorm();
    if (share < 0.05 || share > 0.95) return {};
    rest /= std::sqrt(share);
    const Eigen::MatrixXd known = found_.information + found_.prior;
    FrameAdvice advice;
    advice.known_gains = true;
    Spread(found_.covariance(others, others),
           BoundedCovariance(known(others, others)), rest, others, &advice);
    if (advice.ratio() > 0.5) return {};
    return advice;
  }

  CalibrationProblem* problem_;
  const Identifiability& found_;
  std::vector<double> forces_N_;
  std::vector<Candidate> candidates_;
  Families recorded_;            // in the contact frames of the logs
  std::vector<Families> added_;  // sets that the next frames may add to them
};

}  // namespace

std::vector<FrameAdvice> AdviseNextFrames(CalibrationProblem* problem,
                                          const CalibrationSolution& solution,
                                          Identifiability* found) {
  const NextFrames next(problem, solution, *found);
  for (WeakDirection& weak : found->weak) {
    const std::vector<FrameAdvice> best = next.Best(weak.direction);
    weak.remedy = best.empty() ? "no 20 frames at one place or spread over "
                                 "the finger would help much; give a prior"
                               : best[0].words;
  }
  return next.Best(found->weakest);
}

}  // namespace finray
