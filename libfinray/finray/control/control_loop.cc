#include "finray/control/control_loop.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <random>

#include "finray/control/contact_watch.h"
#include "finray/control/controller.h"
#include "finray/control/model_controller.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/io/error.h"
#include "finray/scene/clean_readings.h"

namespace finray {
namespace {

std::vector<Finger> TrueFingers(const Finger& finger,
                                const Experiment& experiment,
                                std::mt19937_64* generator) {
  std::vector<Finger> fingers;
  for (int i = 0; i < experiment.mechanism.fingers(); ++i) {
    fingers.push_back(Perturbed(finger, experiment.model_error, generator));
  }
  return fingers;
}

// Null for kNone. The PI's stiffness is that of the model under the middle
// force of the set-point, at the height for which it is tuned.
std::unique_ptr<Controller> MakeController(
    const Finger& finger, const Experiment& experiment,
    const ControllerSettings& settings, const Discretization& discretization) {
  if (settings.kind == ControllerKind::kNone) return nullptr;
  const Mechanism& mechanism = experiment.mechanism;
  std::vector<PushModel> models;
  for (int i = 0; i < mechanism.fingers(); ++i) {
    models.emplace_back(finger, experiment.scene.circle_radius_mm().value_or(0),
                        experiment.scene.friction_coefficient, discretization);
  }
  if (settings.kind == ControllerKind::kModel) {
    return std::make_unique<ModelController>(
        std::move(models), mechanism, settings.prior,
        experiment.actuation.period_s, settings.preview);
  }
  const double y_mm = settings.tuned_at_mm;
  const auto push =
      models.front().At(MakePose<double>(0, Eigen::Vector2d::Zero()), y_mm,
                        experiment.set_point.Middle(), y_mm);
  if (!push) {
    throw InputError("the finger's model has no contact of " +
                     std::to_string(experiment.set_point.Middle()) +
                     " N at the height that the PI is tuned for");
  }
  return std::make_unique<PiController>(
      push->stiffness_N_per_mm * mechanism.ApproachPerDrive(0, y_mm),
      experiment.actuation, settings.preview);
}

class Loop {
 public:
  Loop(const Finger& finger, const Experiment& experiment,
       const ControllerSettings& settings, const Discretization& discretization,
       std::uint64_t seed)
      : experiment_(experiment),
        gauges_(finger.gauges),
        generator_(seed),
        plant_(TrueFingers(finger, experiment, &generator_),
               experiment.mechanism, *experiment.scene.object,
               experiment.scene.friction_coefficient, experiment.start),
        true_drive_(TrueActuation(), 0),
        known_drive_(experiment.actuation, 0),
        touch_(finger, experiment.safety.touch_N, discretization),
        watch_(experiment.safety, experiment.actuation.period_s),
        controller_(
            MakeController(finger, experiment, settings, discretization)) {
    for (int i = 0; i < experiment.mechanism.fingers(); ++i) {
      zeros_.emplace_back(finger, discretization);
      estimators_.emplace_back(finger, experiment.scene, discretization);
    }
  }

  LoopRun Run() {
    LoopRun run;
    const double period = experiment_.actuation.period_s;
    const int periods =
        static_cast<int>(std::floor(experiment_.duration_s / period + 1e-9));
    for (int k = 0; k <= periods; ++k) {
      LoopRow row;
      row.time_s = k * period;
      if (!Sense(&row, &run.failure)) return run;
      Act(&row);
      run.rows.push_back(std::move(row));
    }
    return run;
  }

 private:
  ActuatorSettings TrueActuation() {
    ActuatorSettings settings = experiment_.actuation;
    settings.delay_s =
        std::max(0.0, experiment_.true_delay_s +
                          experiment_.delay_std_s * unit_(generator_));
    return settings;
  }

  bool Sense(LoopRow* row, std::string* failure) {
    row->set_point_N = experiment_.set_point.At(row->time_s);
    row->object_motion_mm = experiment_.motion.At(row->time_s);
    row->drive = true_drive_.AdvanceTo(row->time_s);
    PlantState state = plant_.At(row->drive, row->object_motion_mm);
    if (!state.failure.empty()) {
      *failure = state.failure;
      return false;
    }
    row->force_N = state.force_N;
    row->fingers = std::move(state.fingers);
    for (std::size_t i = 0; i < estimators_.size(); ++i) {
      Measurements readings = row->fingers[i].readings;
      for (std::size_t j = 0; j < gauges_.size(); ++j) {
        readings.gauges_V[j] += gauges_[j].noise_V * unit_(generator_);
      }
      if (i == 0) LoseGauges(row->time_s, &readings);
      if (row->time_s < experiment_.zero_s) zeros_[i].Add(readings);
      zeros_[i].Apply(&readings);
      row->estimates.push_back(estimators_[i].Next(readings));
      row->readings.push_back(std::move(readings));
    }
    row->seen = MeanForceOf(Contacts(*row));
    return true;
  }

  static std::vector<ContactEstimate> Contacts(const LoopRow& row) {
    std::vector<ContactEstimate> contacts;
    for (const FrameEstimate& estimate : row.estimates) {
      contacts.push_back(estimate.contact[0]);
    }
    return contacts;
  }

  void LoseGauges(double time_s, Measurements* readings) const {
    const auto& loss = experiment_.gauge_loss;
    if (!loss || time_s < loss->from_s || time_s >= loss->to_s) return;
    for (const int gauge : loss->gauges) {
      readings->gauges_V[gauge] = std::nan("");
    }
  }

  void Act(LoopRow* row) {
    std::vector<Sight> sights;
    row->sure = true;
    for (std::size_t i = 0; i < estimators_.size(); ++i) {
      sights.push_back(Judge(row->estimates[i], touch_.Of(row->readings[i]),
                             experiment_.safety));
      row->sure &= sights[i].seen || sights[i].free;
    }
    if (controller_ == nullptr) {
      row->command = 0;
      return;
    }
    known_drive_.AdvanceTo(row->time_s);
    if (experiment_.drive_is_measured) known_drive_.CorrectTo(row->drive);
    row->mode = row->time_s < experiment_.zero_s ? LoopMode::kZero
                                                 : watch_.Next(sights);
    row->command = CommandOf(*row);
    true_drive_.Command(row->time_s, row->command);
    known_drive_.Command(row->time_s, row->command);
  }

  double CommandOf(const LoopRow& row) {
    const double step =
        experiment_.safety.approach_speed * experiment_.actuation.period_s;
    const double last = known_drive_.last_command();
    switch (row.mode) {
      case LoopMode::kZero:
        break;
      case LoopMode::kControl:
        return controller_->Next(row.time_s, Contacts(row),
                                 experiment_.set_point, known_drive_);
      case LoopMode::kApproach:
        controller_->Lost();
        return last + step;
      case LoopMode::kHold:
        controller_->Skip();
        break;
      case LoopMode::kStopped:
        return std::max(0.0, last - step);
    }
    return last;
  }

  const Experiment& experiment_;
  const std::vector<Gauge> gauges_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> unit_;
  Plant plant_;
  Actuator true_drive_, known_drive_;
  const TouchSignal touch_;
  ContactWatch watch_;
  std::vector<GaugeZero> zeros_;
  std::unique_ptr<Controller> controller_;
  std::deque<FrameEstimator> estimators_;
};

}  // namespace

GaugeZero::GaugeZero(const Finger& finger,
                     const Discretization& discretization) {
  EquilibriumSolver solver(finger, discretization);
  if (!solver.Solve({})) {
    throw InputError("the free finger has no equilibrium: " + solver.Why());
  }
  free_V_ = CleanReadings(solver).gauges_V;
  sum_V_.assign(free_V_.size(), 0);
}

void GaugeZero::Add(const Measurements& readings) {
  for (std::size_t j = 0; j < sum_V_.size(); ++j) {
    sum_V_[j] += readings.gauges_V[j] - free_V_[j];
  }
  ++count_;
}

void GaugeZero::Apply(Measurements* readings) const {
  if (count_ == 0) return;
  for (std::size_t j = 0; j < sum_V_.size(); ++j) {
    readings->gauges_V[j] -= sum_V_[j] / count_;
  }
}

LoopRun RunLoop(const Finger& finger, const Experiment& experiment,
                const ControllerSettings& controller,
                const Discretization& discretization, std::uint64_t seed) {
  return Loop(finger, experiment, controller, discretization, seed).Run();
}

}  // namespace finray
