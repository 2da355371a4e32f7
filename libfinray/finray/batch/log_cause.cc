#include "finray/batch/log_cause.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "finray/batch/batch_estimation.h"
#include "finray/batch/estimation_summary.h"
#include "finray/batch/estimation_warnings.h"
#include "finray/estimation/zeroed_finger.h"
#include "finray/fit/calibration_errors.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// No frame counts more, so that a few odd ones do not decide.
constexpr double kMostOfFrame = 40;
// The std of a force sensor, which nobody states here.
constexpr double kForceStd_N = 0.02;
constexpr int kRounds = 6;

using Rows = std::vector<Measurements>;

// A finger, a scene and rows as they would be if a cause held.
struct World {
  Finger finger;
  Scene scene;
  Rows rows;
  double force_noise_N = kForceStd_N;  // of the force sensor
};

// How well a world explains its rows.
struct Trial {
  World world;
  std::vector<FrameEstimate> estimates;
  EstimationSummary summary;
  double cost = std::numeric_limits<double>::infinity();

  bool Fits() const {
    return !NeedsCause(summary) && summary.unsolved() < summary.frames;
  }
};

// A cause that was tried.
struct Tried {
  std::string words, details, remedy;
  int numbers = 0;
  double cost = 0;  // with what its numbers are charged
};

// The pairs of more gauges are too many to try.
constexpr int kMostExchanged = 16;

constexpr char kAllStillRemedy[] =
    "look at the cable, the unit and the logger; a zero of these rows would "
    "make the finger blind";
constexpr char kZero[] = "zero the gauges with finray_zero";
constexpr char kCalibrate[] = "calibrate the finger anew, or look for damage";

class CauseSearch {
 public:
  CauseSearch(const LogEvidence& evidence, const Finger& finger,
              const Scene& scene, const Discretization& discretization,
              int threads)
      : discretization_(discretization),
        threads_(threads),
        gauges_(static_cast<int>(finger.gauges.size())),
        faults_(evidence.Faults()) {
    World world{finger, scene, evidence.rows()};
    // The rows are estimated one by one.
    world.scene.smoothing.reset();
    base_.world = std::move(world);
  }

  LogCause Find() {
    Evaluate(&base_);
    if (base_.summary.frames == 0 || base_.Fits()) return {};
    if (LogCause steps; FindSteps(&steps)) return steps;
    if (LogCause unit; FindUnit(&unit)) return unit;
    TryOffsets();
    TryGains();
    TryStiffness();
    TryFriction();
    TryChannels();
    TryNoise();
    TryForceSensor();
    if (tried_.empty()) return None();
    std::stable_sort(
        tried_.begin(), tried_.end(),
        [](const Tried& a, const Tried& b) { return a.cost < b.cost; });
    LogCause cause{tried_[0].words, tried_[0].details, tried_[0].remedy};
    for (std::size_t i = 1; i < tried_.size(); ++i) {
      if (tried_[i].cost > tried_[0].cost + kAsWell) break;
      cause.words += ", or as well: " + tried_[i].words;
      if (!tried_[i].details.empty()) {
        cause.details +=
            (cause.details.empty() ? "" : "; ") + tried_[i].details;
      }
      cause.remedy += "; or " + tried_[i].remedy;
    }
    return cause;
  }

 private:
  // Estimates the rows. A finger without a solution has an infinite cost.
  void Evaluate(Trial* trial) const {
    trial->summary = {};
    trial->cost = std::numeric_limits<double>::infinity();
    try {
      trial->estimates =
          EstimateFrames(trial->world.finger, trial->world.scene,
                         discretization_, trial->world.rows, threads_);
    } catch (const InputError&) {
      return;
    }
    trial->cost = 0;
    const double friction = trial->world.scene.friction_coefficient;
    for (std::size_t i = 0; i < trial->estimates.size(); ++i) {
      const FrameEstimate& estimate = trial->estimates[i];
      const Measurements& row = trial->world.rows[i];
      trial->summary.Add(estimate, friction, row, trial->world.finger);
      if (!std::isfinite(estimate.chi2)) {
        trial->cost += kMostOfFrame;
        continue;
      }
      trial->cost += std::min(
          kMostOfFrame, estimate.explained_chi2() +
                            FrameEstimator::kSignificance * estimate.contacts);
      if (const auto error = ForceError(estimate, row, trial->world)) {
        trial->cost += std::min(kMostOfFrame, *error * *error);
      }
    }
  }

  // The error of a force over its std.
  static std::optional<double> ForceError(const FrameEstimate& estimate,
                                          const Measurements& row,
                                          const World& world) {
    if (estimate.status != FrameStatus::kOk &&
        estimate.status != FrameStatus::kNoContact) {
      return {};
    }
    const double friction = row.FrictionOr(world.scene.friction_coefficient);
    const double force_N = row.Force().magnitude_N;
    if (!std::isfinite(force_N)) return {};
    const double std_N = estimate.status == FrameStatus::kOk
                             ? EstimatedForceStd(estimate, friction)
                             : 0;
    const double error = (EstimatedForce(estimate, friction) - force_N) /
                         std::hypot(std_N, world.force_noise_N);
    return std::isfinite(error) ? std::optional(error) : std::nullopt;
  }

  Trial Try(World world) const {
    Trial trial;
    trial.world = std::move(world);
    Evaluate(&trial);
    return trial;
  }

  // Keeps a cause that fits. `charged` is what its numbers cost beside chi2.
  void Keep(const Trial& trial, Tried cause, double charged = 0) {
    const double frames = static_cast<double>(base_.summary.frames);
    cause.cost = trial.cost + charged + cause.numbers * std::log(frames);
    if (!trial.Fits() || cause.cost > base_.cost) return;
    tried_.push_back(std::move(cause));
  }

  struct Step {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
  };

  // Sums what the frames say about parameters, in their units.
  Step StepOf(const Trial& at, const std::vector<FingerParameter>& parameters,
              const Eigen::VectorXd& unit) const {
    Finger finger = at.world.finger;
    const auto n = static_cast<Eigen::Index>(parameters.size());
    ParameterCovariance all;
    all.parameters = parameters;
    all.std = unit;
    all.correlations = Eigen::MatrixXd::Identity(n, n);
    finger.calibration = all;
    const double friction = at.world.scene.friction_coefficient;
    CalibrationErrors derivatives(finger, Scene::OfGauges(friction),
                                  discretization_,
                                  CalibrationErrors::Surface::kNone);
    Step step{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
    for (std::size_t i = 0; i < at.estimates.size(); ++i) {
      const FrameEstimate& estimate = at.estimates[i];
      const Measurements& row = at.world.rows[i];
      if (!std::isfinite(estimate.chi2) ||
          estimate.status == FrameStatus::kNotConverged) {
        continue;
      }
      std::vector<PointContact> contacts;
      for (int c = 0; c < estimate.contacts; ++c) {
        contacts.push_back({estimate.contact[c].arc_mm,
                            estimate.contact[c].normal_N, friction});
      }
      const LinearizedFrame* const errors =
          derivatives.Linearize(contacts, row);
      if (errors == nullptr) continue;
      const Eigen::VectorXd& r = errors->residuals;
      Eigen::MatrixXd b = derivatives.ByParameter() * unit.asDiagonal();
      const double odd =
          std::sqrt(estimate.chi2 / std::max(1, estimate.dof)) / 3;
      const double weight = 1 / std::max(1.0, odd);
      if (!contacts.empty()) {
        const Eigen::MatrixXd a = errors->by_contact;
        const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
        const Eigen::MatrixXd follow = qr.solve(b);  // -dx/dp
        AddForce(estimate, row, at.world, follow, weight, &step);
        b -= a * follow;
      }
      step.information += weight * b.transpose() * b;
      step.gradient += weight * b.transpose() * r;
    }
    return step;
  }

  static void AddForce(const FrameEstimate& estimate, const Measurements& row,
                       const World& world, const Eigen::MatrixXd& follow,
                       double weight, Step* step) {
    const auto error = ForceError(estimate, row, world);
    if (!error || estimate.contacts != 1) return;
    const double friction = row.FrictionOr(world.scene.friction_coefficient);
    const double std_N =
        std::hypot(EstimatedForceStd(estimate, friction), world.force_noise_N);
    const Eigen::VectorXd by =
        -std::hypot(1, friction) / std_N * follow.row(1).transpose();
    weight *= 1 / std::max(1.0, std::abs(*error) / 3);
    step->information += weight * by * by.transpose();
    step->gradient += weight * *error * by;
  }

  // Minimises the cost over parameters from a trial on.
  Trial Minimize(Trial at, const std::vector<FingerParameter>& parameters) {
    Eigen::VectorXd unit(static_cast<Eigen::Index>(parameters.size()));
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const FingerParameter& p = parameters[k];
      unit[static_cast<Eigen::Index>(k)] =
          p.kind == FingerParameterKind::kGaugeOffset
              ? base_.world.finger.gauges[p.index].noise_V
              : 0.1 * std::abs(ParameterValue(base_.world.finger, p));
    }
    for (int round = 0; round < kRounds; ++round) {
      const Step step = StepOf(at, parameters, unit);
      Eigen::MatrixXd information = step.information;
      information.diagonal().array() += 1e-6;
      Eigen::VectorXd change = -information.ldlt().solve(step.gradient);
      bool better = false;
      for (int half = 0; half < 3 && !better; ++half, change /= 4) {
        World world = at.world;
        for (std::size_t k = 0; k < parameters.size(); ++k) {
          const auto i = static_cast<Eigen::Index>(k);
          const double was = ParameterValue(at.world.finger, parameters[k]);
          double value = was + unit[i] * change[i];
          if (parameters[k].kind != FingerParameterKind::kGaugeOffset) {
            const double ratio = std::clamp(value / was, 0.4, 2.5);
            value = was * ratio;
          }
          SetParameter(parameters[k], value, &world.finger);
        }
        Trial next = Try(std::move(world));
        const double gain = at.cost - next.cost;
        if (!(gain > 0)) continue;
        better = gain > 1 + 1e-3 * at.cost;
        at = std::move(next);
        break;
      }
      if (!better) break;
    }
    return at;
  }

  // Where most rows are alike they may be free ones: what they read beside the
  // offsets.
  std::optional<Eigen::VectorXd> ShiftOfDensest() const {
    const Rows& rows = base_.world.rows;
    const auto near = [&](const Measurements& a, const Measurements& b) {
      for (int j = 0; j < gauges_; ++j) {
        const double noise_V = base_.world.finger.gauges[j].noise_V;
        if (!(std::abs(a.gauges_V[j] - b.gauges_V[j]) < 4 * noise_V)) {
          return false;
        }
      }
      return true;
    };
    std::size_t most = 0;
    Eigen::VectorXd mean;
    for (const Measurements& center : rows) {
      std::size_t count = 0;
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(gauges_);
      for (const Measurements& row : rows) {
        if (!near(center, row)) continue;
        ++count;
        sum += Eigen::Map<const Eigen::VectorXd>(row.gauges_V.data(), gauges_);
      }
      if (count <= most) continue;
      most = count;
      mean = sum / static_cast<double>(count);
    }
    if (most < 5) return {};
    mean -= FreeVolts(base_.world.finger, discretization_);
    for (int j = 0; j < gauges_; ++j) {
      mean[j] -= base_.world.finger.gauges[j].offset_V;
    }
    return mean;
  }

  void TryOffsets() {
    std::vector<FingerParameter> offsets;
    for (int j = 0; j < gauges_; ++j) {
      offsets.push_back({FingerParameterKind::kGaugeOffset, j});
    }
    Trial start = base_;
    if (const auto shift = ShiftOfDensest()) {
      World world = base_.world;
      for (int j = 0; j < gauges_; ++j) {
        world.finger.gauges[j].offset_V += (*shift)[j];
      }
      Trial shifted = Try(std::move(world));
      if (shifted.cost < start.cost) start = std::move(shifted);
    }
    const Trial best = Minimize(std::move(start), offsets);
    std::string list;
    std::size_t farthest = 0;
    double most = 0;
    for (int j = 0; j < gauges_; ++j) {
      const Gauge& was = base_.world.finger.gauges[j];
      const double by_V = best.world.finger.gauges[j].offset_V - was.offset_V;
      if (std::abs(by_V) / was.noise_V > most) {
        most = std::abs(by_V) / was.noise_V;
        farthest = static_cast<std::size_t>(j);
      }
      list += FormatText("%s%+.2g", j > 0 ? ", " : "", 1e3 * by_V);
    }
    const bool one = IsOneEnough(best, offsets, farthest);
    Keep(best, {one ? "gauge " + std::to_string(farthest + 1) +
                          " has slipped: its offset alone has moved"
                    : "the gauges' offsets have moved",
                "offsets moved by " + list + " mV explain its rows", kZero,
                one ? 1 : gauges_});
  }

  // Says whether one of the parameters, with the others as they were, explains
  // the rows as well as all do.
  bool IsOneEnough(const Trial& all,
                   const std::vector<FingerParameter>& parameters,
                   std::size_t which) {
    if (gauges_ < 3 || !all.Fits()) return false;
    World world = base_.world;
    SetParameter(parameters[which],
                 ParameterValue(all.world.finger, parameters[which]),
                 &world.finger);
    const Trial one = Minimize(Try(std::move(world)), {parameters[which]});
    const double saved =
        (gauges_ - 1) * std::log(static_cast<double>(base_.summary.frames));
    return one.Fits() && one.cost < all.cost + saved;
  }

  static bool IsPossible(double ratio) {
    return ratio > 1 / kMostFactor && ratio < kMostFactor;
  }

  void TryGains() {
    std::vector<FingerParameter> gains;
    for (int j = 0; j < gauges_; ++j) {
      gains.push_back({FingerParameterKind::kGaugeGain, j});
    }
    const Trial best = Minimize(base_, gains);
    std::string list;
    std::size_t farthest = 0;
    double most = 0;
    for (int j = 0; j < gauges_; ++j) {
      const double ratio = best.world.finger.gauges[j].gain_V_per_rad /
                           base_.world.finger.gauges[j].gain_V_per_rad;
      if (!IsPossible(ratio)) return;
      if (std::abs(std::log(ratio)) > most) {
        most = std::abs(std::log(ratio));
        farthest = static_cast<std::size_t>(j);
      }
      list += FormatText("%s%.3g", j > 0 ? ", " : "", ratio);
    }
    const bool one = IsOneEnough(best, gains, farthest);
    Keep(best, {one ? "the gain of gauge " + std::to_string(farthest + 1) +
                          " is not the finger's"
                    : "gains are not the finger's",
                "gains of " + list + " times the finger's explain its rows",
                kCalibrate, one ? 1 : gauges_});
  }

  void TryStiffness() {
    const std::vector<FingerParameter> both = {
        {FingerParameterKind::kFrontStiffness},
        {FingerParameterKind::kBackStiffness}};
    // Both alike change forces and no reading of a gauge.
    Trial start = base_;
    if (const auto scale = ForceScale(); scale && IsPossible(*scale)) {
      World world = base_.world;
      for (const FingerParameter& p : both) {
        SetParameter(p, ParameterValue(world.finger, p) / *scale,
                     &world.finger);
      }
      Trial scaled = Try(std::move(world));
      if (scaled.cost < start.cost) start = std::move(scaled);
    }
    const Trial best = Minimize(std::move(start), both);
    double ratio[2];
    for (int i = 0; i < 2; ++i) {
      ratio[i] = ParameterValue(best.world.finger, both[i]) /
                 ParameterValue(base_.world.finger, both[i]);
      if (!IsPossible(ratio[i])) return;
    }
    Keep(best, {"stiffness is not the finger's",
                FormatText("front and back stiffness of %.3g and %.3g times "
                           "the finger's explain its rows",
                           ratio[0], ratio[1]),
                kCalibrate, 2});
  }

  void TryFriction() {
    const double given = base_.world.scene.friction_coefficient;
    std::optional<Trial> best;
    double at = given;
    const auto attempt = [&](double friction) {
      World world = base_.world;
      world.scene.friction_coefficient = friction;
      Trial trial = Try(std::move(world));
      if (best && trial.cost >= best->cost) return;
      best = std::move(trial);
      at = friction;
    };
    for (const double change : {-0.4, -0.2, 0.2, 0.4}) attempt(given + change);
    if (best->cost > base_.cost) return;
    const double middle = at;
    for (const double change : {-0.1, 0.1, -0.05, 0.05}) {
      attempt(middle + change);
    }
    if (std::abs(at) > 1) return;
    Keep(*best,
         {"friction is not the scene's",
          FormatText("a friction_coefficient of %.2g explains its rows", at),
          "set friction_coefficient in the scene", 1});
  }

  void TryChannels() {
    for (int j = 0; j < gauges_; ++j) {
      // About the offset, where wires are swapped, or about 0.
      for (const double twice_V :
           {2 * base_.world.finger.gauges[j].offset_V, 0.0}) {
        World turned = base_.world;
        for (Measurements& row : turned.rows) {
          row.gauges_V[j] = twice_V - row.gauges_V[j];
        }
        const std::size_t before = tried_.size();
        Keep(Try(std::move(turned)),
             {"gauge " + std::to_string(j + 1) + " has the wrong sign", "",
              "swap its wires, or change the sign in `columns`", 1});
        if (tried_.size() > before || twice_V == 0) break;
      }
      for (int k = j + 1; k < gauges_ && gauges_ <= kMostExchanged; ++k) {
        World exchanged = base_.world;
        for (Measurements& row : exchanged.rows) {
          std::swap(row.gauges_V[j], row.gauges_V[k]);
        }
        Keep(Try(std::move(exchanged)),
             {"gauges " + std::to_string(j + 1) + " and " +
                  std::to_string(k + 1) + " are swapped",
              "", "exchange their wires or columns", 1});
      }
    }
  }

  // Steps are a fact, and the cause if a noise as large explains the rows.
  bool FindSteps(LogCause* cause) const {
    World world = base_.world;
    std::string words;
    for (const GaugeFault& fault : faults_) {
      if (fault.kind != GaugeFault::Kind::kCoarse) continue;
      Gauge& gauge = world.finger.gauges[fault.gauge];
      gauge.noise_V = std::hypot(gauge.noise_V, fault.step_V / std::sqrt(12.0));
      words += (words.empty() ? "" : ", ") + fault.words;
    }
    if (words.empty() || !Try(std::move(world)).Fits()) return false;
    *cause = {words, "",
              "choose a finer range of the converter, or give the finger a "
              "noise_V of step / sqrt(12)"};
    return true;
  }

  // Readings in another unit have hardly any noise, so that nothing else
  // explains their rows as sharply.
  bool FindUnit(LogCause* cause) const {
    constexpr double kUnit = 1e3;
    World world = base_.world;
    for (Measurements& row : world.rows) {
      for (double& volts : row.gauges_V) volts *= kUnit;
    }
    if (!Try(std::move(world)).Fits()) return false;
    *cause = {"the readings are 1000 times too small (V taken for mV?)", "",
              "correct their unit: in the headers of the log, or by a scale in "
              "the scene's columns"};
    return true;
  }

  // -2 ln of what a larger noise does to the likelihood of a gauge's readings.
  double Charge(double noise_ratio) const {
    return 2 * static_cast<double>(base_.summary.frames) *
           std::log(noise_ratio);
  }

  // The sums of chi2, bounded by frame, and of dof of the frames that `is`
  // takes.
  template <class Is>
  static std::pair<double, int> Excess(const Trial& trial, const Is& is) {
    double chi2 = 0;
    int dof = 0;
    for (std::size_t i = 0; i < trial.estimates.size(); ++i) {
      const FrameEstimate& estimate = trial.estimates[i];
      if (estimate.dof < 1 || !std::isfinite(estimate.chi2) || !is(i)) continue;
      chi2 += std::min(estimate.explained_chi2(), kMostOfFrame * estimate.dof);
      dof += estimate.dof;
    }
    return {chi2, dof};
  }

  void TryNoise() {
    const auto all = [](std::size_t) { return true; };
    if (Excess(base_, all).second < 20) return;
    double ratio = 1;
    Trial noisy = base_;
    for (int round = 0; round < kRounds; ++round) {
      const auto [rest, rest_dof] = Excess(noisy, all);
      const double times = std::sqrt(rest / std::max(1, rest_dof));
      if (round > 0 && std::abs(times - 1) < 0.02) break;
      ratio *= times;
      if (ratio < 1.1 || ratio > 10) return;
      World world = base_.world;
      for (Gauge& gauge : world.finger.gauges) gauge.noise_V *= ratio;
      noisy = Try(std::move(world));
    }
    const auto loaded = [&](std::size_t i) {
      return noisy.estimates[i].contacts > 0;
    };
    const auto free = [&](std::size_t i) { return !loaded(i); };
    for (const auto& [some_chi2, some_dof] :
         {Excess(noisy, loaded), Excess(noisy, free)}) {
      const double off = (some_chi2 - some_dof) / std::sqrt(2.0 * some_dof);
      if (some_dof > 20 && std::abs(off) > 5) return;
    }
    if (CorrelationOfNeighbours(noisy) > 0.3) return;
    Keep(noisy,
         {"readings are noisier than noise_V says",
          FormatText("%.2g times the noise_V explains its rows", ratio),
          "look for what disturbs the gauges, or calibrate with this noise", 1},
         gauges_ * Charge(ratio));
  }

  // The correlation of residuals of neighbouring rows. Errors of a model are
  // alike in them, and noise is not.
  double CorrelationOfNeighbours(const Trial& trial) const {
    Finger finger = trial.world.finger;
    ParameterCovariance any;
    any.parameters = {{FingerParameterKind::kFrontStiffness}};
    any.std = Eigen::VectorXd::Ones(1);
    any.correlations = Eigen::MatrixXd::Identity(1, 1);
    finger.calibration = any;
    const double friction = trial.world.scene.friction_coefficient;
    CalibrationErrors model(finger, Scene::OfGauges(friction), discretization_,
                            CalibrationErrors::Surface::kNone);
    const auto residuals = [&](std::size_t i) -> Eigen::VectorXd {
      const FrameEstimate& estimate = trial.estimates[i];
      std::vector<PointContact> contacts;
      for (int c = 0; c < estimate.contacts; ++c) {
        contacts.push_back({estimate.contact[c].arc_mm,
                            estimate.contact[c].normal_N, friction});
      }
      Eigen::VectorXd of_gauges = Eigen::VectorXd::Zero(gauges_);
      const LinearizedFrame* const errors =
          std::isfinite(estimate.chi2)
              ? model.Linearize(contacts, trial.world.rows[i])
              : nullptr;
      for (std::size_t k = 0; errors != nullptr && k < errors->rows.size();
           ++k) {
        of_gauges[errors->rows[k].gauge] =
            errors->residuals[static_cast<Eigen::Index>(k)];
      }
      return of_gauges;
    };
    double across = 0, squares = 0;
    for (std::size_t i = 0; i + 1 < trial.estimates.size(); i += 2) {
      const Eigen::VectorXd a = residuals(i), b = residuals(i + 1);
      across += 2 * a.dot(b);
      squares += a.squaredNorm() + b.squaredNorm();
    }
    return squares > 0 ? across / squares : 0;
  }

  // What forces of the sensor are to be multiplied by to be the estimated ones.
  // Empty if they do not differ.
  std::optional<double> ForceScale() const {
    if (!base_.summary.forces_differ()) return {};
    double ff = 0, fe = 0;
    ForEachForce([&](double weight, double force_N, double estimated_N) {
      ff += weight * force_N * force_N;
      fe += weight * force_N * estimated_N;
    });
    return ff > 0 ? std::optional(fe / ff) : std::nullopt;
  }

  template <class Take>
  void ForEachForce(const Take& take) const {
    const double friction = base_.world.scene.friction_coefficient;
    for (std::size_t i = 0; i < base_.estimates.size(); ++i) {
      const FrameEstimate& estimate = base_.estimates[i];
      const Measurements& row = base_.world.rows[i];
      const double force_N = row.Force().magnitude_N;
      const double std_N =
          EstimatedForceStd(estimate, row.FrictionOr(friction));
      if (estimate.status != FrameStatus::kOk || !std::isfinite(force_N) ||
          !std::isfinite(std_N)) {
        continue;
      }
      take(std::pow(std::hypot(std_N, kForceStd_N), -2), force_N,
           EstimatedForce(estimate, row.FrictionOr(friction)));
    }
  }

  // A sensor of another scale or zero. Its axes go alike.
  void TryForceSensor() {
    const std::optional<double> scale = ForceScale();
    if (!scale) return;
    const auto attempt = [&](double factor, double offset_N, Tried cause) {
      World world = base_.world;
      for (Measurements& row : world.rows) {
        row.force_N = factor * row.Force().magnitude_N + offset_N;
        row.force_xy_N.setConstant(Measurements::kNotMeasured);
      }
      world.force_noise_N *= factor;
      Keep(Try(std::move(world)), std::move(cause));
    };
    if (IsPossible(*scale)) {
      attempt(*scale, 0,
              {"the force sensor has another scale",
               FormatText("%.3g times its forces are the finger's", *scale),
               "check the sensor's scale", 1});
    }
    double weights = 0, more = 0;
    ForEachForce([&](double weight, double force_N, double estimated_N) {
      weights += weight;
      more += weight * (estimated_N - force_N);
    });
    const double offset_N = more / weights;
    attempt(1, offset_N,
            {"the force sensor has an offset",
             FormatText("%+.2g N more are the finger's forces", offset_N),
             "tare the sensor", 1});
  }

  LogCause None() const {
    LogCause cause;
    cause.words = "none of the effects that finray knows";
    cause.remedy =
        "look for more contacts than the scene has, wide or moving ones, a "
        "changed finger, disturbed readings";
    if (base_.summary.forces_differ()) {
      cause.remedy += ", and at the unit and the delay of force_N";
    }
    // The split of frames into two with the largest excess of chi2 in one.
    const std::size_t n = base_.estimates.size();
    double most = 0;
    const auto split = [&](const std::vector<double>& by, const char* low,
                           const char* high, const std::string& unit) {
      std::vector<double> values;
      for (const double value : by) {
        if (std::isfinite(value)) values.push_back(value);
      }
      if (values.size() < 20) return;
      std::nth_element(values.begin(), values.begin() + values.size() / 2,
                       values.end());
      const double middle = values[values.size() / 2];
      const auto of = [&](bool above) {
        return Excess(base_, [&](std::size_t i) {
          return above ? by[i] >= middle : by[i] < middle;
        });
      };
      const auto [low_chi2, low_dof] = of(false);
      const auto [high_chi2, high_dof] = of(true);
      if (low_dof < 5 || high_dof < 5) return;
      const double apart = high_chi2 / high_dof - low_chi2 / low_dof;
      if (std::abs(apart) <= most) return;
      most = std::abs(apart);
      cause.details =
          std::string("chi2 is largest ") + (apart > 0 ? high : low) +
          FormatText(" %.3g", middle) + unit +
          FormatText(": %.2g instead of %.2g per degree of freedom",
                     std::max(high_chi2 / high_dof, low_chi2 / low_dof),
                     std::min(high_chi2 / high_dof, low_chi2 / low_dof));
    };
    std::vector<double> load(n, std::nan("")), place = load, time = load;
    for (std::size_t i = 0; i < n; ++i) {
      const FrameEstimate& estimate = base_.estimates[i];
      if (!std::isfinite(estimate.chi2)) continue;
      load[i] = 0;
      for (int c = 0; c < estimate.contacts; ++c) {
        load[i] += estimate.contact[c].normal_N;
      }
      if (estimate.contacts > 0) place[i] = estimate.contact[0].arc_mm;
      time[i] = base_.world.rows[i].time_s;
    }
    split(load, "at loads below", "at loads above", " N");
    split(place, "at places below", "at places above", " mm");
    split(time, "before", "after", " s");
    return cause;
  }

  const Discretization discretization_;
  const int threads_, gauges_;
  const std::vector<GaugeFault> faults_;
  Trial base_;
  std::vector<Tried> tried_;
};

}  // namespace

LogEvidence::LogEvidence(const Finger& finger, const Scene& scene)
    : faults_(finger), history_(finger, scene) {}

void LogEvidence::Add(Measurements row) {
  const std::size_t pair = count_ / 2;
  faults_.Add(++count_, row);
  if (!history_.empty()) history_.Remove(&row);
  if (pair % stride_ != 0) return;
  if (rows_.size() == kMostRows) {
    for (std::size_t i = 0; i < kMostRows / 4; ++i) {
      std::swap(rows_[2 * i], rows_[4 * i]);
      std::swap(rows_[2 * i + 1], rows_[4 * i + 1]);
    }
    rows_.resize(kMostRows / 2);
    stride_ *= 2;
    if (pair % stride_ != 0) return;
  }
  rows_.push_back(std::move(row));
}

LogCause FindLogCause(const LogEvidence& evidence, const Finger& finger,
                      const Scene& scene, const Discretization& discretization,
                      int threads, bool needed) {
  const std::vector<GaugeFault> faults = evidence.Faults();
  LogCause cause;
  cause.words = WordsOf(faults, false);
  cause.of_gauges = !cause.words.empty();
  if (cause.of_gauges) {
    cause.remedy = faults[0].kind == GaugeFault::Kind::kAllStill
                       ? kAllStillRemedy
                       : "check its wiring, its range and its column; with its "
                         "cells left empty the other gauges sense alone";
    return cause;
  }
  if (!needed) return {};
  if (!finger.calibration) {
    return {"the finger is not calibrated", "",
            "calibrate it with finray_calibrate"};
  }
  // Frames one by one do not know where the offsets have wandered to.
  if (scene.gauge_offset_walk) return {};
  return CauseSearch(evidence, finger, scene, discretization, threads).Find();
}

}  // namespace finray
