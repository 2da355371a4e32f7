#include "finray/residuals.h"

#include <algorithm>
#include <cmath>

#include "finray/model/frame_evaluation.h"
#include "finray/residuals/frame_set.h"
#include "inside.h"

namespace finray::v1 {

struct FrameResiduals::Inside {
  finray::Finger finger;
  SharedParameters start;
  EquilibriumSolver solver;
  FrameEvaluation evaluation;
};

namespace {

// The state of the finger, by its contacts and, if asked for, its parameters.
class StateCost final : public ceres::CostFunction {
 public:
  StateCost(const FrameResiduals::Inside& inside, bool of_parameters)
      : of_parameters_(of_parameters),
        start_(inside.start),
        solver_(inside.solver),
        evaluation_(inside.evaluation) {
    const auto add = [this](int size) {
      if (size > 0) mutable_parameter_block_sizes()->push_back(size);
    };
    add(evaluation_.frame_size());
    if (of_parameters) {
      add(1);
      add(1);
      add(evaluation_.ribs());
    }
    set_num_residuals(static_cast<int>(evaluation_.outputs().size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const double* const* at = parameters;
    const double* contacts = evaluation_.frame_size() > 0 ? *at++ : nullptr;
    double front = start_.ln_front_stiffness, back = start_.ln_back_stiffness;
    const double* ribs = start_.rib_lengths_mm.data();
    if (of_parameters_) {
      front = **at++;
      back = **at++;
      if (evaluation_.ribs() > 0) ribs = *at++;
    }
    evaluation_.Update(contacts, front, back, ribs, nullptr, &solver_);
    if (!evaluation_.valid()) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) =
        evaluation_.outputs();
    if (jacobians == nullptr) return true;
    int column = 0;
    for (std::size_t b = 0; b < parameter_block_sizes().size(); ++b) {
      const int size = parameter_block_sizes()[b];
      if (jacobians[b] != nullptr) {
        Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic,
                                 Eigen::RowMajor>>(jacobians[b],
                                                   num_residuals(), size) =
            evaluation_.d_outputs().middleCols(column, size);
      }
      column += size;
    }
    return true;
  }

 private:
  bool of_parameters_;
  SharedParameters start_;
  // Ceres evaluates const functions; these keep the last equilibrium, from
  // which the next one is found.
  mutable EquilibriumSolver solver_;
  mutable FrameEvaluation evaluation_;
};

// Whitened readings of all gauges.
class GaugesCost final : public ceres::CostFunction {
 public:
  GaugesCost(const FrameResiduals::Inside& inside, std::vector<double> volts)
      : gauges_(inside.finger.gauges),
        volts_(std::move(volts)),
        state_(inside, false) {
    *mutable_parameter_block_sizes() = state_.parameter_block_sizes();
    set_num_residuals(static_cast<int>(gauges_.size()));
    values_.resize(static_cast<std::size_t>(state_.num_residuals()));
    by_contacts_.resize(
        values_.size() *
        static_cast<std::size_t>(state_.parameter_block_sizes()[0]));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    double* all[] = {by_contacts_.data()};
    const bool derive = jacobians != nullptr && jacobians[0] != nullptr;
    if (!state_.Evaluate(parameters, values_.data(), derive ? all : nullptr)) {
      return false;
    }
    const auto size = static_cast<std::size_t>(parameter_block_sizes()[0]);
    for (std::size_t j = 0; j < gauges_.size(); ++j) {
      const Gauge& gauge = gauges_[j];
      const bool measured = gauge.IsMeasured(volts_[j]);
      const double weight = measured ? 1 / gauge.noise_V : 0;
      residuals[j] =
          measured ? weight * (gauge.Volts(values_[j]) - volts_[j]) : 0;
      for (std::size_t k = 0; derive && k < size; ++k) {
        jacobians[0][j * size + k] =
            weight * gauge.Slope(values_[j]) * by_contacts_[j * size + k];
      }
    }
    return true;
  }

 private:
  std::vector<Gauge> gauges_;
  std::vector<double> volts_;
  StateCost state_;
  mutable std::vector<double> values_, by_contacts_;  // memory
};

}  // namespace

FrameResiduals::FrameResiduals(const Finger& finger, int contacts,
                               const Scene& scene,
                               const Discretization& discretization)
    : gauges_(finger.gauges()), contacts_(contacts) {
  if (contacts < 1) throw InputError("contacts: expected 1 or more");
  Guarded([&] {
    const finray::Finger& of = finger.inside().finger;
    EquilibriumSolver solver(of, ToInternal(discretization));
    FrameEvaluation evaluation(solver.model(), EquilibriumForm::kReduced,
                               contacts,
                               scene.inside().scene.friction_coefficient);
    // The free finger, for the sizes.
    const SharedParameters start = SharedParameters::Of(of);
    std::vector<double> unloaded;
    for (int c = 0; c < contacts; ++c) {
      unloaded.push_back(of.front_length_mm * (c + 1) / (contacts + 1));
      unloaded.push_back(0);
    }
    evaluation.Update(unloaded.data(), start, &solver);
    if (!evaluation.valid()) {
      throw InputError(of.name + ": the unloaded finger has no equilibrium");
    }
    inside_ = std::make_shared<Inside>(Inside{of, start, solver, evaluation});
  });
}

ceres::CostFunction* FrameResiduals::State() const {
  return new StateCost(*inside_, false);
}
ceres::CostFunction* FrameResiduals::StateOfParameters() const {
  return new StateCost(*inside_, true);
}
ceres::CostFunction* FrameResiduals::Gauges(
    const std::vector<double>& volts) const {
  if (static_cast<int>(volts.size()) != gauges_) {
    throw InputError("volts: expected " + std::to_string(gauges_) +
                     " readings, one per gauge of the finger, found " +
                     std::to_string(volts.size()));
  }
  return new GaugesCost(*inside_, volts);
}

double FrameResiduals::ln_front_stiffness() const {
  return inside_->start.ln_front_stiffness;
}
double FrameResiduals::ln_back_stiffness() const {
  return inside_->start.ln_back_stiffness;
}
std::vector<double> FrameResiduals::rib_lengths_mm() const {
  return inside_->start.rib_lengths_mm;
}

}  // namespace finray::v1
