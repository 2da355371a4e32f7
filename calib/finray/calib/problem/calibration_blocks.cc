#include "finray/calib/problem/calibration_blocks.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

bool AnyGauge(const CalibrationFrame& frame) {
  return std::any_of(frame.gauges_V.begin(), frame.gauges_V.end(),
                     [](double volts) { return std::isfinite(volts); });
}

MeasurementModel ModelOf(const Finger& finger, const Plan& plan) {
  MeasurementModel model;
  for (const Gauge& gauge : finger.gauges) {
    model.gauge_std_V.push_back(gauge.noise_V);
  }
  model.force_std_N = plan.force_std_N;
  model.contact_std_mm = plan.contact_std_mm;
  if (plan.scene.circle_radius_mm()) model.object_std_mm = plan.object_std_mm;
  model.pin_std_mm = plan.pin_std_mm;
  model.tip_std_mm = plan.tip_std_mm;
  return model;
}

// Returns the model with the std that this frame has.
MeasurementModel ModelOf(const CalibrationFrame& frame,
                         MeasurementModel model) {
  for (double& std : model.gauge_std_V) std *= frame.readings_std_times;
  for (auto* std : {&model.force_std_N, &model.pin_std_mm, &model.tip_std_mm}) {
    if (*std) **std *= frame.readings_std_times;
  }
  if (model.force_std_N) *model.force_std_N *= frame.force_std_times;
  if (model.contact_std_mm) *model.contact_std_mm *= frame.place_std_times;
  if (model.object_std_mm) *model.object_std_mm *= frame.place_std_times;
  return model;
}

}  // namespace

CalibrationBlocks::CalibrationBlocks(const Finger& finger, const Plan& plan,
                                     CalibrationParameters* parameters)
    : finger_(finger),
      parameters_(*parameters),
      model_(ModelOf(finger, plan)),
      free_model_(model_) {
  if (plan.ForceZeroIsKnown()) {
    free_model_.force_std_N.reset();
  }
}

bool CalibrationBlocks::HasEnough(const CalibrationFrame& frame) const {
  if (frame.IsBench() || AnyGauge(frame)) return AnyGauge(frame);
  const bool object = frame.object_mm.allFinite() && model_.object_std_mm;
  const auto points = frame.pins.size() + frame.tip_mm.allFinite();
  if (!frame.contact) return points > 0;
  return 2 * (points + object) + frame.Force().IsMeasured() +
             std::isfinite(frame.contact_mm) >
         2;
}

bool CalibrationBlocks::HasReference(const CalibrationFrame& frame) const {
  const bool object = frame.object_mm.allFinite() && model_.object_std_mm;
  return object || std::isfinite(frame.contact_mm) ||
         frame.Force().IsMeasured() || !frame.pins.empty() ||
         frame.tip_mm.allFinite();
}

std::vector<FrameBlock> CalibrationBlocks::Of(const CalibrationFrame& frame,
                                              const FrameEvaluation* evaluation,
                                              double* unknowns) const {
  const MeasurementModel& model = frame.contact ? model_ : free_model_;
  const bool own_std = frame.place_std_times > 1 ||
                       frame.readings_std_times > 1 ||
                       frame.force_std_times != 1;
  return MeasurementBlocks(frame, own_std ? ModelOf(frame, model) : model,
                           parameters_.Of(frame), finger_.gauges, evaluation,
                           unknowns);
}

std::unique_ptr<ceres::LossFunction> MakeLoss(const Plan& plan) {
  switch (plan.loss) {
    case RobustLoss::kNone:
      return nullptr;
    case RobustLoss::kHuber:
      return std::make_unique<ceres::HuberLoss>(plan.loss_scale);
    case RobustLoss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(plan.loss_scale);
  }
  return nullptr;
}

}  // namespace finray
