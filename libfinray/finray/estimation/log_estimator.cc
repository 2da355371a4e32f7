#include "finray/estimation/log_estimator.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "finray/estimation/block_tridiagonal.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/free_frame.h"
#include "finray/finger/geometry.h"
#include "finray/finger/possible_reading.h"
#include "finray/io/error.h"
#include "finray/io/nan.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// Each free frame tells the filter to forget what was before it, by about the
// ratio of the walk since the last frame to the noise of a reading. After a sum
// of so much of that, e^-8 of an old error is left.
constexpr double kForgotten = 8;

const Finger& Checked(const Finger& finger, const Scene& scene) {
  RefuseBackContacts(scene);
  if (scene.contacts.value_or(1) > 1) {
    throw InputError("scene: contacts: " + std::to_string(*scene.contacts) +
                     " cannot be estimated with the whole log; 0, 1 and auto "
                     "can");
  }
  // TouchDetection decides by the gauges alone which frames touch.
  if (scene.UsesCamera() && !scene.contacts) {
    throw InputError(
        "scene: pin_std_mm and tip_std_mm with the whole log need to know who "
        "touches; expected contacts: 0 or 1");
  }
  if (scene.presliding_mm) {
    throw InputError("scene: presliding_mm cannot be used with the whole log");
  }
  if (finger.gauges.size() < 2) {
    throw InputError("finger '" + finger.name +
                     "': a contact needs at least 2 gauges");
  }
  return finger;
}

// The row with the finger's offsets.
Measurements WithoutWander(const Finger& finger, const LogFrame& frame) {
  OffsetBelief told;
  told.mean_V = frame.offset_V;
  told.variance_V2 = Eigen::VectorXd::Zero(frame.offset_V.size());
  Measurements row;
  MoveToOffsetsOf(finger, told, frame.row, &row);
  return row;
}

}  // namespace

LogEstimator::LogEstimator(const Finger& finger, const Scene& scene,
                           const Discretization& discretization, int threads,
                           Take take)
    : finger_(Checked(finger, scene)),
      scene_(scene),
      discretization_(discretization),
      threads_(threads),
      take_(std::move(take)),
      detection_(finger, scene, discretization),
      systematic_(finger, scene, discretization),
      free_(FrameEstimator::FreeEstimate(finger, discretization)),
      least_force_N_(FrameEstimator::LeastForce_N(finger)),
      prior_(FirstPrior()) {}

LogPrior LogEstimator::FirstPrior() const {
  LogPrior prior;
  if (!scene_.gauge_offset_walk) return prior;
  prior.mean = GaugeOffsets(finger_);
  const Eigen::Index gauges = prior.mean.size();
  const double std_V = scene_.gauge_offset_walk->start_std_V;
  prior.information =
      Eigen::MatrixXd::Identity(gauges, gauges) / (std_V * std_V);
  return prior;
}

OffsetBelief LogEstimator::BeliefBefore() const {
  const auto gauges = static_cast<Eigen::Index>(finger_.gauges.size());
  OffsetBelief belief;
  belief.time_s = frames_.front().row.time_s;
  if (!scene_.gauge_offset_walk) {
    belief.mean_V = GaugeOffsets(finger_);
    belief.variance_V2 = Eigen::VectorXd::Zero(gauges);
    return belief;
  }
  belief.mean_V = prior_.mean.head(gauges);
  belief.variance_V2 =
      InverseInformation(prior_.information).diagonal().head(gauges);
  return belief;
}

void LogEstimator::Add(const Measurements& row) {
  if (scene_.gauge_offset_walk) {
    const bool later = frames_.empty() ? std::isfinite(row.time_s)
                                       : row.time_s > frames_.back().row.time_s;
    if (!later) {
      throw InputError(
          "time_s: expected a time after that of the row before, "
          "as gauge_offset_walk needs, found " +
          NumberText(row.time_s));
    }
  }
  LogFrame frame;
  frame.row = row;
  if (!ArePossible(finger_.gauges, row.gauges_V, OffsetsWander_V(scene_))) {
    frame.row.gauges_V.assign(row.gauges_V.size(), kNaN);
  }
  frames_.push_back(std::move(frame));
  if (frames_.size() < next_look_) return;
  detection_.Decide(BeliefBefore(), &frames_);
  if (const std::optional<Gap> gap = FindGap()) {
    SolveWindow(gap->end, gap->middle);
  } else if (frames_.size() >= kLongestWindow) {
    SolveWindow(frames_.size(), frames_.size() / 2);
  }
  next_look_ = frames_.size() + kWindow;  // of those that are left
}

void LogEstimator::Finish() {
  if (frames_.empty()) return;
  detection_.Decide(BeliefBefore(), &frames_);
  SolveWindow(frames_.size(), frames_.size());
}

std::optional<LogEstimator::Gap> LogEstimator::FindGap() const {
  // What a frame forgets.
  const auto forgets = [this](std::size_t t) {
    if (!scene_.gauge_offset_walk) return kForgotten;
    const double dt = frames_[t].row.time_s - frames_[t - 1].row.time_s;
    double least = 1;
    for (const Gauge& gauge : finger_.gauges) {
      least = std::min(least, scene_.gauge_offset_walk->std_V_per_sqrt_s *
                                  std::sqrt(dt) / gauge.noise_V);
    }
    return least;
  };
  const auto is_free = [this](std::size_t t) {
    return frames_[t].role == LogFrame::Role::kFree;
  };
  std::size_t end = frames_.size();
  while (end > 1) {
    if (!is_free(end - 1)) {
      --end;
      continue;
    }
    double forgotten = 0;
    std::size_t begin = end, middle = 0;
    for (; begin > 1 && is_free(begin - 1); --begin) {
      forgotten += forgets(begin - 1);
      if (forgotten >= kForgotten && middle == 0) middle = begin - 1;
      if (forgotten >= 2 * kForgotten) return Gap{middle, end};
    }
    end = begin - 1;
  }
  return std::nullopt;
}

void LogEstimator::SolveWindow(std::size_t window, std::size_t settled) {
  const auto window_end = static_cast<long>(window);
  std::vector<LogFrame> frames(frames_.begin(), frames_.begin() + window_end);
  std::vector<bool> dropped(window, false);
  iterations_ = 0;
  for (int round = 1;; ++round) {
    LogProblem problem(finger_, scene_, discretization_, threads_, &frames,
                       prior_);
    iterations_ += problem.Solve();
    const std::vector<LogMarginal> marginals = problem.Marginals();
    if (round < kMostRounds && Reconsider(marginals, &frames, &dropped)) {
      continue;
    }
    if (!problem.converged()) {
      EstimateAlone({frames_.begin(), frames_.begin() + window_end}, settled);
      break;
    }
    problem.AddTo(&walk_, marginals, settled);
    offsets_are_told_ = walk_.TellsOffsets();
    for (std::size_t t = 0; t < settled; ++t) {
      take_(Judge(frames[t], marginals[t]));
    }
    if (settled < window) prior_ = problem.PriorOf(settled);
    break;
  }
  detection_.Settle(settled);
  frames_.erase(frames_.begin(), frames_.begin() + static_cast<long>(settled));
}

void LogEstimator::EstimateAlone(const std::vector<LogFrame>& frames,
                                 std::size_t settled) {
  if (!frame_estimator_) {
    Scene scene = scene_;
    scene.gauge_offset_walk.reset();
    scene.smoothing.reset();
    scene.most_contacts = 1;
    frame_estimator_.emplace(finger_, scene, discretization_);
  }
  const std::vector<OffsetBelief> beliefs =
      detection_.Beliefs(BeliefBefore(), frames);
  Measurements moved;
  for (std::size_t t = 0; t < settled; ++t) {
    MoveToOffsetsOf(finger_, beliefs[t], frames[t].row, &moved);
    FrameEstimate estimate = frame_estimator_->Estimate(moved);
    if (frames[t].doubtful && estimate.status == FrameStatus::kNoContact) {
      LeaveUnknown(&estimate);
    }
    if (scene_.gauge_offset_walk) {
      // Nothing tests the walk here.
      if (estimate.status == FrameStatus::kOk) {
        estimate.status = FrameStatus::kUnobservable;
      }
      for (Eigen::Index j = 0; j < beliefs[t].mean_V.size(); ++j) {
        estimate.gauge_offset_V.push_back(beliefs[t].mean_V[j]);
        estimate.gauge_offset_std_V.push_back(
            std::sqrt(beliefs[t].variance_V2[j]));
      }
    }
    take_(estimate);
  }
  alone_ += settled;
  // The settled frames give the offsets of the next frame, and no contact.
  const std::vector<OffsetBelief> there =
      detection_.BeliefsBehind(BeliefBefore(), frames);
  prior_ = {};
  if (settled == frames.size() || !scene_.gauge_offset_walk) return;
  const OffsetBelief& next = there[settled];
  prior_ = {next.mean_V, next.variance_V2.cwiseInverse().asDiagonal()};
}

// chi2 of the free finger where all other frames put the offsets.
double LogEstimator::FreeChi2(const LogFrame& frame,
                              const LogMarginal& marginal) {
  std::vector<int> measured;
  for (std::size_t j = 0; j < finger_.gauges.size(); ++j) {
    if (finger_.gauges[j].IsMeasured(frame.row.gauges_V[j])) {
      measured.push_back(static_cast<int>(j));
    }
  }
  const auto count = static_cast<Eigen::Index>(measured.size());
  Eigen::VectorXd off(count);
  Eigen::MatrixXd covariance(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int j = measured[i];
    const Gauge& gauge = finger_.gauges[j];
    off[i] = frame.row.gauges_V[j] - marginal.mean_without[j] -
             gauge.BendingVolts(detection_.search().table().free_angles()[j]);
    for (Eigen::Index k = 0; k < count; ++k) {
      covariance(i, k) = marginal.offsets_without(j, measured[k]);
    }
    covariance(i, i) += std::pow(
        frame.row.GaugeStd_V(static_cast<std::size_t>(j), gauge.noise_V), 2);
  }
  const double camera_chi2 =
      scene_.UsesCamera() ? detection_.FreeCameraChi2(frame.row) : 0;
  return camera_chi2 + off.dot(covariance.ldlt().solve(off));
}

bool LogEstimator::Reconsider(const std::vector<LogMarginal>& marginals,
                              std::vector<LogFrame>* frames,
                              std::vector<bool>* dropped) {
  if (scene_.contacts) return false;
  bool changed = false;
  for (std::size_t t = 0; t < frames->size(); ++t) {
    LogFrame& frame = (*frames)[t];
    const LogMarginal& marginal = marginals[t];
    const double free_chi2 = FreeChi2(frame, marginal);
    if (frame.role == LogFrame::Role::kTouching) {
      if (free_chi2 - marginal.chi2 >= FrameEstimator::kSignificance &&
          frame.normal_N > 0) {
        continue;
      }
      frame.LeaveOpen();
      frame.doubtful &= frame.normal_N > 0 && scene_.gauge_offset_walk;
      (*dropped)[t] = changed = true;
    } else if (!(*dropped)[t] && free_chi2 >= FrameEstimator::kSignificance &&
               detection_.FindContact(frame, marginal.mean_without,
                                      marginal.offsets_without.diagonal())) {
      detection_.StartTouch(&frame);
      changed = true;
    }
  }
  return changed;
}

FrameEstimate LogEstimator::Judge(const LogFrame& frame,
                                  const LogMarginal& marginal) {
  FrameEstimate estimate = free_;
  PackedReadings packed;
  Pack(finger_, scene_, frame.row, &packed);
  if (packed.gauges + packed.camera < 1 ||
      packed.all < 2 * scene_.contacts.value_or(1)) {
    estimate = FrameEstimate();
    estimate.rib_tension_N.assign(finger_.ribs.size(), std::nan(""));
  } else if (frame.role == LogFrame::Role::kTouching &&
             frame.normal_N >= least_force_N_) {
    estimate.chi2 = marginal.chi2;
    estimate.dof = packed.all - 2;
    JudgeContact(frame, marginal, packed, &estimate);
  } else {
    estimate.chi2 = FreeChi2(frame, marginal);
    estimate.dof = packed.gauges + packed.camera;
    JudgeFree(WithoutWander(finger_, frame), &systematic_, &estimate);
    if (frame.doubtful) LeaveUnknown(&estimate);
  }
  estimate.iterations = iterations_;
  if (!scene_.gauge_offset_walk) return estimate;
  for (std::size_t j = 0; j < finger_.gauges.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    estimate.gauge_offset_V.push_back(frame.offset_V[i]);
    estimate.gauge_offset_std_V.push_back(std::sqrt(marginal.covariance(i, i)));
  }
  return estimate;
}

void LogEstimator::JudgeContact(const LogFrame& frame,
                                const LogMarginal& marginal,
                                const PackedReadings& packed,
                                FrameEstimate* estimate) {
  const std::vector<PointContact> contacts = {
      {frame.arc_mm, frame.normal_N, scene_.friction_coefficient}};
  const Measurements row = WithoutWander(finger_, frame);
  if (!systematic_.empty() && packed.all == packed.gauges &&
      estimate->p_value() < FrameEstimate::kUnexplained) {
    estimate->model_chi2 = systematic_.Chi2(contacts, row);
  }
  const double scale = estimate->noise_scale();
  frame.CopyTo(scale * scale * marginal.covariance, estimate);
  estimate->change_chi2 = marginal.change_chi2;
  estimate->change_dof = marginal.change_dof;
  estimate->SetNoise();
  if (scene_.gauge_offset_walk) {
    const Eigen::Vector2d noise = marginal.StdGivenOffsets();
    estimate->contact[0].arc_noise_mm = noise[0];
    estimate->contact[0].normal_noise_N = noise[1];
  }
  if (!systematic_.empty()) {
    FrameEstimator::AddCovariance(systematic_.Of(contacts, row), estimate);
  }
  if (frame.rival) {
    const ContactSolution& rival = frame.rival->contact;
    estimate->alternative[0].arc_mm = rival.contacts[0].arc_mm;
    estimate->alternative[0].normal_N = rival.contacts[0].normal_N;
    estimate->alternative[0].pose = rival.poses[0];
    estimate->alternative_chi2 = estimate->chi2 + frame.rival->more_chi2;
  }
  estimate->SetIntervals(finger_.front_length_mm);
  estimate->status =
      offsets_are_told_
          ? FrameEstimator::StatusOf(*estimate, finger_, detection_.search())
          : FrameStatus::kUnobservable;
}

}  // namespace finray
