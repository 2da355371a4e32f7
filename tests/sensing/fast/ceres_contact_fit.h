#ifndef FINRAY_TESTS_SENSING_FAST_CERES_CONTACT_FIT_H_
#define FINRAY_TESTS_SENSING_FAST_CERES_CONTACT_FIT_H_

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <vector>

#include "finray/residuals/frame_set.h"
#include "finray/residuals/gauge_reading_residual.h"

namespace finray {

/// One contact from gauge volts by ceres::Solve on GaugeReadingResidual blocks
/// in the reduced form: the same problem as ContactFit, in another way.
class CeresContactFit {
 public:
  CeresContactFit(const Finger& finger, const Discretization& discretization)
      : shared_(SharedParameters::Of(finger)),
        frames_(finger, discretization, EquilibriumForm::kReduced, &shared_, 1),
        readings_V_(finger.gauges.size()) {
    for (const Gauge& gauge : finger.gauges) {
      gains_.push_back(gauge.gain_V_per_rad);
      offsets_.push_back(gauge.offset_V);
    }
    FrameEvaluation& frame = frames_.Add(1, 0, contact_);
    ceres::Problem::Options options;
    options.evaluation_callback = &frames_;
    problem_ = std::make_unique<ceres::Problem>(options);
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      std::vector<double*> blocks = FrameParameterBlocks(
          frame, contact_, &shared_.ln_front_stiffness,
          &shared_.ln_back_stiffness, shared_.rib_lengths_mm.data());
      blocks.push_back(&gains_[j]);
      blocks.push_back(&offsets_[j]);
      problem_->AddResidualBlock(GaugeReadingResidual::Create(
                                     &frame, static_cast<int>(j),
                                     &readings_V_[j], finger.gauges[j].noise_V),
                                 nullptr, blocks);
    }
    std::vector<double*> blocks;
    problem_->GetParameterBlocks(&blocks);
    for (double* block : blocks) {
      if (block != contact_) problem_->SetParameterBlockConstant(block);
    }
    problem_->SetParameterLowerBound(contact_, 0, 0);
    problem_->SetParameterUpperBound(contact_, 0, finger.front_length_mm);
    problem_->SetParameterLowerBound(contact_, 1, 0);
  }

  /// Starts from and leaves `*contact`; false if Ceres says so.
  bool Fit(const std::vector<double>& readings_V, double parameter_tolerance,
           PointContact* contact) {
    readings_V_ = readings_V;
    contact_[0] = contact->arc_mm;
    contact_[1] = contact->normal_N;
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.initial_trust_region_radius = 1e12;
    options.max_trust_region_radius = 1e16;
    options.function_tolerance = options.gradient_tolerance = 1e-16;
    options.parameter_tolerance = parameter_tolerance;
    ceres::Solver::Summary summary;
    ceres::Solve(options, problem_.get(), &summary);
    contact->arc_mm = contact_[0];
    contact->normal_N = contact_[1];
    return summary.IsSolutionUsable();
  }

 private:
  SharedParameters shared_;
  FrameSet frames_;
  std::vector<double> readings_V_, gains_, offsets_;
  double contact_[2];
  std::unique_ptr<ceres::Problem> problem_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_SENSING_FAST_CERES_CONTACT_FIT_H_
