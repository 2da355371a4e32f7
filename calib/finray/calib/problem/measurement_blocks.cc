#include "finray/calib/problem/measurement_blocks.h"

#include <algorithm>
#include <cmath>

#include "finray/residuals/cylinder_gauge_residual.h"
#include "finray/residuals/gauge_reading_residual.h"
#include "finray/residuals/object_contact_residual.h"
#include "finray/residuals/point_residual.h"
#include "finray/residuals/reference_force_residual.h"

namespace finray {
namespace {

bool AnyGauge(const CalibrationFrame& frame) {
  return std::any_of(frame.gauges_V.begin(), frame.gauges_V.end(),
                     [](double volts) { return std::isfinite(volts); });
}

void Add(ceres::CostFunction* cost, std::vector<double*> parameters,
         ResidualFamily family, int gauge, std::vector<MeasurementBlock>* out) {
  out->push_back({std::unique_ptr<ceres::CostFunction>(cost),
                  std::move(parameters), family, gauge});
}

}  // namespace

bool MeasurementBlocks::HasEnough(const CalibrationFrame& frame) const {
  if (frame.IsBench() || AnyGauge(frame)) return AnyGauge(frame);
  const bool object =
      frame.object_mm.allFinite() && plan_.scene.circle_radius_mm();
  const bool force =
      std::isfinite(frame.force_N) || frame.force_xy_N.allFinite();
  const auto points = frame.pins.size() + frame.tip_mm.allFinite();
  if (!frame.contact) return points > 0;
  return 2 * (points + object) + force + std::isfinite(frame.contact_mm) > 2;
}

bool MeasurementBlocks::HasReference(const CalibrationFrame& frame) const {
  const bool object =
      frame.object_mm.allFinite() && plan_.scene.circle_radius_mm();
  return object || std::isfinite(frame.contact_mm) ||
         std::isfinite(frame.force_N) || frame.force_xy_N.allFinite() ||
         !frame.pins.empty() || frame.tip_mm.allFinite();
}

std::vector<MeasurementBlock> MeasurementBlocks::Of(
    const CalibrationFrame& frame, const FrameEvaluation* evaluation,
    double* unknowns) const {
  Blocks out;
  if (frame.IsBench()) {
    AddBench(frame, &out);
    return out;
  }
  SharedParameters& shared = parameters_.shared;
  const std::vector<double*> model = FrameParameterBlocks(
      *evaluation, unknowns, &shared.ln_front_stiffness,
      &shared.ln_back_stiffness, shared.rib_lengths_mm.data());
  AddReadings(frame, *evaluation, model, &out);
  AddForce(frame, *evaluation, unknowns, model, &out);
  if (frame.contact) AddPlace(frame, *evaluation, unknowns, model, &out);
  AddPoints(frame, *evaluation, model, &out);
  return out;
}

std::vector<double> MeasurementBlocks::AddTerms(
    const CalibrationFrame& frame, int gauge,
    std::vector<double*>* blocks) const {
  std::vector<double> coefficients;
  for (const ReadingTerm& term : parameters_.readings.Of(frame, gauge)) {
    blocks->push_back(term.variable);
    coefficients.push_back(term.coefficient);
  }
  return coefficients;
}

void MeasurementBlocks::AddReadings(const CalibrationFrame& frame,
                                    const FrameEvaluation& evaluation,
                                    const std::vector<double*>& model,
                                    Blocks* out) const {
  for (int j = 0; j < evaluation.gauges(); ++j) {
    if (!std::isfinite(frame.gauges_V[j])) continue;
    std::vector<double*> blocks;
    blocks.reserve(model.size() + 2);
    blocks = model;
    blocks.push_back(&parameters_.gains_V_per_rad[j]);
    const std::vector<double> coefficients = AddTerms(frame, j, &blocks);
    Add(GaugeReadingResidual::Create(&evaluation, j, &frame.gauges_V[j],
                                     gauge_std_V(j), coefficients),
        std::move(blocks), ResidualFamily::kGauge, j, out);
  }
}

void MeasurementBlocks::AddBench(const CalibrationFrame& frame,
                                 Blocks* out) const {
  for (int j = 0; j < static_cast<int>(frame.gauges_V.size()); ++j) {
    if (!std::isfinite(frame.gauges_V[j])) continue;
    std::vector<double*> blocks = {&parameters_.gains_V_per_rad[j]};
    const std::vector<double> coefficients = AddTerms(frame, j, &blocks);
    Add(CylinderGaugeResidual::Create(
            finger_.gauges[j].length_mm, frame.cylinder_radius_mm,
            frame.gauges_V[j], gauge_std_V(j), coefficients),
        std::move(blocks), ResidualFamily::kBench, j, out);
  }
}

// A free frame tells the sensor's offset, if that is asked for.
void MeasurementBlocks::AddForce(const CalibrationFrame& frame,
                                 const FrameEvaluation& evaluation,
                                 double* unknowns,
                                 const std::vector<double*>& model,
                                 Blocks* out) const {
  const bool offset = plan_.family(ParameterFamily::kForceOffset).free;
  if (!frame.contact && !offset) return;
  if (frame.force_xy_N.allFinite()) {
    std::vector<double*> blocks = model;
    blocks.push_back(&parameters_.ln_force_scale);
    blocks.push_back(parameters_.force_offset_xy_N);
    Add(ReferenceForceVectorResidual::Create(&evaluation, frame.force_xy_N,
                                             plan_.force_std_N),
        std::move(blocks), ResidualFamily::kForce, -1, out);
  } else if (std::isfinite(frame.force_N)) {
    std::vector<double*> blocks;
    if (frame.contact) blocks.push_back(unknowns);
    blocks.push_back(&parameters_.ln_force_scale);
    blocks.push_back(&parameters_.force_offset_N);
    Add(ReferenceForceResidual::Create(&evaluation, frame.force_N,
                                       plan_.force_std_N),
        std::move(blocks), ResidualFamily::kForce, -1, out);
  }
}

void MeasurementBlocks::AddPlace(const CalibrationFrame& frame,
                                 const FrameEvaluation& evaluation,
                                 double* unknowns,
                                 const std::vector<double*>& model,
                                 Blocks* out) const {
  if (frame.object_mm.allFinite() && plan_.scene.circle_radius_mm()) {
    std::vector<double*> blocks = model;
    blocks.push_back(parameters_.object_origin_mm(frame.log));
    Add(ObjectContactResidual::Create(&evaluation, 0, frame.object_mm,
                                      *plan_.scene.circle_radius_mm(),
                                      plan_.object_std_mm),
        std::move(blocks), ResidualFamily::kObject, -1, out);
  }
  if (std::isfinite(frame.contact_mm)) {
    Add(ContactLocationResidual::Create(&evaluation, 0, frame.contact_mm,
                                        plan_.contact_std_mm),
        {unknowns}, ResidualFamily::kContact, -1, out);
  }
}

void MeasurementBlocks::AddPoints(const CalibrationFrame& frame,
                                  const FrameEvaluation& evaluation,
                                  const std::vector<double*>& model,
                                  Blocks* out) const {
  std::vector<double*> blocks = model;
  blocks.push_back(parameters_.camera_origin_mm);
  for (const SeenPin& pin : frame.pins) {
    Add(PointResidual::CreatePin(&evaluation, pin.rib, pin.side, pin.at_mm,
                                 *plan_.pin_std_mm),
        blocks, ResidualFamily::kPin, -1, out);
  }
  if (frame.tip_mm.allFinite()) {
    Add(PointResidual::CreateTip(&evaluation, frame.tip_mm, *plan_.tip_std_mm),
        blocks, ResidualFamily::kTip, -1, out);
  }
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
