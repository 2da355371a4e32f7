#include "finray/calib/analysis/next_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "finray/calib/solve/information_spectrum.h"
#include "finray/io/nan.h"

namespace finray {
namespace {

constexpr double kWorthwhile = 0.9;
constexpr std::size_t kMostAdvice = 4;

bool Has(const std::vector<ResidualFamily>& families, ResidualFamily family) {
  return std::find(families.begin(), families.end(), family) != families.end();
}

// A goal of advice: frames should shrink the std sqrt(trace(weight C)) of the
// covariance C. The goal is named after `parameter`, an index of the free ones.
struct Goal {
  Eigen::MatrixXd weight;
  Eigen::Index parameter = 0;
  bool is_force = false;
};

Goal Along(const Eigen::VectorXd& direction) {
  Goal goal{direction * direction.transpose()};
  direction.cwiseAbs().maxCoeff(&goal.parameter);
  return goal;
}

// Holds the predicted frames, for advice on one goal after the other.
class NextFrames {
 public:
  NextFrames(CalibrationProblem* problem, const CalibrationSolution& solution,
             const Identifiability& found)
      : problem_(problem), found_(found) {
    predicted_ = PredictFrames(problem, solution.contacts, found.unit);
    force_ = PredictForce(*problem, predicted_);
    // Correlated residuals enlarge the std, and they will enlarge that of new
    // frames likewise.
    const Eigen::VectorXd enlarged =
        Eigen::Map<const Eigen::VectorXd>(found.bounded_std.data(),
                                          found.unit.size())
            .cwiseQuotient(found.unit.cwiseProduct(
                found.covariance.diagonal().cwiseSqrt()));
    force_.weight =
        enlarged.asDiagonal() * force_.weight * enlarged.asDiagonal();
    ChooseMeasurements(solution.at);
  }

  // Returns advice on a unit vector over the free parameters, in units of
  // Identifiability.
  std::vector<FrameAdvice> BestAlong(const Eigen::VectorXd& direction) const {
    std::vector<FrameAdvice> all = Best(Along(direction));
    if (const auto known = KnownGains(direction)) all.push_back(*known);
    return Described(all);
  }

  // Returns advice on the force that the gauges will sense.
  std::vector<FrameAdvice> BestForForce() const {
    Goal goal{force_.weight, 0, true};
    force_.weight.diagonal()
        .cwiseProduct(found_.covariance.diagonal())
        .maxCoeff(&goal.parameter);
    return Described(Best(goal));
  }

  const PredictedForce& force() const { return force_; }

 private:
  using Families = std::vector<ResidualFamily>;

  std::vector<FrameAdvice> Described(std::vector<FrameAdvice> all) const {
    for (FrameAdvice& advice : all) {
      advice.words = DescribeNextFrames(*problem_, advice);
    }
    return all;
  }

  // Returns the best few pieces of advice, the best one first. Each set of
  // measurements has its best place and load, if these shrink the goal's std to
  // 90 % or less. An added measurement is named only if it helps more than the
  // same frames without it.
  std::vector<FrameAdvice> Best(const Goal& goal) const {
    std::vector<FrameAdvice> all;
    for (const Families& added : added_) {
      const FrameAdvice best = BestWith(added, goal);
      double bar = 1;  // the ratio that fewer measurements reach
      for (const FrameAdvice& other : all) {
        const bool fewer =
            std::all_of(other.added.begin(), other.added.end(),
                        [&](ResidualFamily f) { return Has(added, f); });
        if (fewer) bar = std::min(bar, other.ratio());
      }
      if (best.ratio() <= kWorthwhile * bar) all.push_back(best);
    }
    for (const PredictedFrame& candidate : predicted_.frames) {
      if (!candidate.free) continue;
      FrameAdvice advice;
      advice.free = true;
      Judge(Information(candidate, {ResidualFamily::kGauge}), goal, &advice);
      if (advice.ratio() <= kWorthwhile) all.push_back(advice);
    }
    // If two have the same effect, the one that asks for less comes first.
    std::stable_sort(all.begin(), all.end(),
                     [](const FrameAdvice& a, const FrameAdvice& b) {
                       return a.std_after < 0.98 * b.std_after;
                     });
    if (all.size() > kMostAdvice) all.resize(kMostAdvice);
    return all;
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
    for (const PredictedFrame& candidate : predicted_.frames) {
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

  Eigen::MatrixXd Information(const PredictedFrame& candidate,
                              const Families& measured) const {
    const LinearizedFrame& at = candidate.at;
    std::vector<int> rows;
    for (std::size_t i = 0; i < at.rows.size(); ++i) {
      if (Has(measured, at.rows[i].family)) rows.push_back(static_cast<int>(i));
    }
    LinearizedFrame used = at.WithRows(rows);
    used.Eliminate();
    return used.reduced.transpose() * used.reduced;
  }

  void Judge(const Eigen::MatrixXd& information, const Goal& goal,
             FrameAdvice* advice) const {
    std::vector<int> all(goal.weight.rows());
    std::iota(all.begin(), all.end(), 0);
    const Eigen::MatrixXd after = BoundedCovariance(
        found_.information + found_.prior + FrameAdvice::kFrames * information);
    Spread(found_.covariance, after, goal, all, advice);
    if (!goal.is_force) return;
    const auto total_N = [&](double calibration_N) {
      return std::hypot(calibration_N, force_.noise_N);
    };
    advice->force_std_before_N = total_N(advice->std_before);
    advice->force_std_after_N = total_N(advice->std_after);
  }

  // Sets the std of the advice. The covariances have a row for each of these
  // `parameters`, which are indices of free parameters.
  void Spread(const Eigen::MatrixXd& before, const Eigen::MatrixXd& after,
              const Goal& goal, const std::vector<int>& parameters,
              FrameAdvice* advice) const {
    advice->std_before = std::sqrt(goal.weight.cwiseProduct(before).sum());
    advice->std_after = std::sqrt(goal.weight.cwiseProduct(after).sum());
    const Eigen::Index largest = goal.parameter;
    const int free = parameters[static_cast<std::size_t>(largest)];
    advice->parameter = problem_->parameters().free()[free];
    const CalibrationParameter& p =
        problem_->parameters().all()[advice->parameter];
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
  FrameAdvice BestWith(const Families& added, const Goal& goal) const {
    Families measured = recorded_;
    measured.insert(measured.end(), added.begin(), added.end());
    FrameAdvice best;
    best.std_before = best.std_after = 1;
    const auto consider = [&](const Eigen::MatrixXd& information, double arc,
                              double force,
                              std::vector<Eigen::Vector2d> object_mm) {
      FrameAdvice advice;
      advice.contact_mm = arc;
      advice.normal_N = force;
      advice.added = added;
      if (!object_mm.empty() && object_mm[0].allFinite()) {
        advice.object_mm = std::move(object_mm);
      }
      Judge(information, goal, &advice);
      if (advice.ratio() < best.ratio()) best = advice;
    };
    for (const double force : predicted_.forces_N) {
      Eigen::MatrixXd spread =
          Eigen::MatrixXd::Zero(goal.weight.rows(), goal.weight.rows());
      std::vector<Eigen::Vector2d> places;
      for (const PredictedFrame& candidate : predicted_.frames) {
        if (candidate.free || candidate.normal_N != force) continue;
        const Eigen::MatrixXd one = Information(candidate, measured);
        consider(one, candidate.contact_mm, force, {candidate.object_mm});
        spread += one;
        places.push_back(candidate.object_mm);
      }
      if (places.size() > 1) {
        consider(spread / static_cast<double>(places.size()), kNaN, force,
                 places);
      }
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
           BoundedCovariance(known(others, others)), Along(rest), others,
           &advice);
    if (advice.ratio() > 0.5) return {};
    return advice;
  }

  CalibrationProblem* problem_;
  const Identifiability& found_;
  PredictedFrames predicted_;
  PredictedForce force_;
  Families recorded_;            // in the contact frames of the logs
  std::vector<Families> added_;  // sets that the next frames may add to them
};

}  // namespace

NextRecording AdviseNextFrames(CalibrationProblem* problem,
                               const CalibrationSolution& solution,
                               Identifiability* found) {
  const NextFrames next(problem, solution, *found);
  bool known = true;  // each direction is determined at least by its prior
  for (WeakDirection& weak : found->weak) {
    const std::vector<FrameAdvice> best = next.BestAlong(weak.direction);
    const bool held = IsHeld(weak, found->status);
    constexpr char kNone[] =
        "no 20 frames at one place or spread over the finger would help much; ";
    weak.remedy = !best.empty() ? best[0].words
                  : held        ? kNone + std::string(
                                              "it is as good as the "
                                                     "priors of the plan")
                         : kNone + std::string("give a prior");
    known &= held || std::isfinite(weak.std_over_prior);
  }
  NextRecording recording;
  const PredictedForce& force = next.force();
  if (known && !force.contacts.empty()) {
    recording.force_calibration_N = force.calibration_N(found->covariance);
    recording.force_noise_N = force.noise_N;
    recording.force_contacts = force.contacts.size();
  }
  recording.enough = found->weak.empty() &&
                     recording.force_calibration_N <= recording.force_noise_N;
  recording.advice = found->weak.empty() && !force.contacts.empty()
                         ? next.BestForForce()
                         : next.BestAlong(found->weakest);
  return recording;
}

}  // namespace finray
