// What each row of a log adds to the calibration problem.

#include <cmath>

#include "finray/calib/calibration_problem.h"
#include "finray/residuals/cylinder_gauge_residual.h"
#include "finray/residuals/gauge_reading_residual.h"
#include "finray/residuals/object_contact_residual.h"
#include "finray/residuals/point_residual.h"
#include "finray/residuals/reference_force_residual.h"

namespace finray {
namespace {

bool AnyGauge(const CalibrationFrame& frame) {
  for (const double volts : frame.gauges_V) {
    if (std::isfinite(volts)) return true;
  }
  return false;
}

}  // namespace

// Without a gauge, a contact's place and force take two measurements.
bool CalibrationProblem::HasEnough(const CalibrationFrame& frame) const {
  if (AnyGauge(frame)) return true;
  const bool object =
      frame.object_mm.allFinite() && plan_.scene.circle_radius_mm();
  const bool force =
      std::isfinite(frame.force_N) || frame.force_xy_N.allFinite();
  const auto points = frame.pins.size() + frame.tip_mm.allFinite();
  if (!frame.contact) return points > 0;
  return 2 * (points + object) + force + std::isfinite(frame.contact_mm) > 2;
}

void CalibrationProblem::AddFrame(int index) {
  const CalibrationFrame& frame = logs_.frames[index];
  if (frame.IsBench()) {
    AddBenchFrame(index);
    return;
  }
  if (!HasEnough(frame)) return;

  double* contact = nullptr;
  if (frame.contact) {
    contact_of_frame_[index] = static_cast<int>(contacts_.size());
    contacts_.emplace_back();
    contact = contacts_.back().data();
  }
  FrameEvaluation& evaluation =
      frames_.Add(frame.contact ? 1 : 0, plan_.scene.friction_coefficient,
                  contact, !frame.pins.empty());
  if (frame.contact) GuessContact(index, contact, &evaluation);
  SharedParameters& shared = parameters_.shared;
  const std::vector<double*> model = FrameParameterBlocks(
      evaluation, contact, &shared.ln_front_stiffness,
      &shared.ln_back_stiffness, shared.rib_lengths_mm.data());
  AddReadings(index, evaluation, model);
  AddForce(index, evaluation, contact, model);
  if (contact != nullptr) AddPlace(index, evaluation, contact, model);
  AddPoints(index, evaluation, model);
  if (contact == nullptr) return;
  problem_->SetParameterLowerBound(contact, 0, 0);
  problem_->SetParameterUpperBound(contact, 0, finger_.front_length_mm);
  problem_->SetParameterLowerBound(contact, 1, 0);
}

void CalibrationProblem::AddReadings(int index,
                                     const FrameEvaluation& evaluation,
                                     const std::vector<double*>& model) {
  const CalibrationFrame& frame = logs_.frames[index];
  for (int j = 0; j < evaluation.gauges(); ++j) {
    if (!std::isfinite(frame.gauges_V[j])) continue;
    std::vector<double*> blocks = model;
    blocks.push_back(&parameters_.gains_V_per_rad[j]);
    std::vector<double> coefficients;
    for (const ReadingTerm& term : parameters_.readings.Of(frame, j)) {
      blocks.push_back(term.variable);
      coefficients.push_back(term.coefficient);
    }
    AddMeasurement(
        GaugeReadingResidual::Create(&evaluation, j, &frame.gauges_V[j],
                                     gauge_std_V(j), coefficients),
        ResidualFamily::kGauge, index, j, blocks);
  }
}

void CalibrationProblem::AddBenchFrame(int index) {
  const CalibrationFrame& frame = logs_.frames[index];
  for (int j = 0; j < static_cast<int>(frame.gauges_V.size()); ++j) {
    if (!std::isfinite(frame.gauges_V[j])) continue;
    std::vector<double*> blocks = {&parameters_.gains_V_per_rad[j]};
    std::vector<double> coefficients;
    for (const ReadingTerm& term : parameters_.readings.Of(frame, j)) {
      blocks.push_back(term.variable);
      coefficients.push_back(term.coefficient);
    }
    AddMeasurement(CylinderGaugeResidual::Create(
                       finger_.gauges[j].length_mm, frame.cylinder_radius_mm,
                       frame.gauges_V[j], gauge_std_V(j), coefficients),
                   ResidualFamily::kBench, index, j, blocks);
  }
}

// A free frame tells the sensor's offset, if that is asked for.
void CalibrationProblem::AddForce(int index, const FrameEvaluation& evaluation,
                                  double* contact,
                                  const std::vector<double*>& model) {
  const CalibrationFrame& frame = logs_.frames[index];
  const bool offset = plan_.family(ParameterFamily::kForceOffset).free;
  if (contact == nullptr && !offset) return;
  if (frame.force_xy_N.allFinite()) {
    std::vector<double*> blocks = model;
    blocks.push_back(&parameters_.ln_force_scale);
    blocks.push_back(parameters_.force_offset_xy_N);
    AddMeasurement(ReferenceForceVectorResidual::Create(
                       &evaluation, frame.force_xy_N, plan_.force_std_N),
                   ResidualFamily::kForce, index, -1, blocks);
  } else if (std::isfinite(frame.force_N)) {
    std::vector<double*> blocks;
    if (contact != nullptr) blocks.push_back(contact);
    blocks.push_back(&parameters_.ln_force_scale);
    blocks.push_back(&parameters_.force_offset_N);
    AddMeasurement(ReferenceForceResidual::Create(&evaluation, frame.force_N,
                                                  plan_.force_std_N),
                   ResidualFamily::kForce, index, -1, blocks);
  }
}

void CalibrationProblem::AddPlace(int index, const FrameEvaluation& evaluation,
                                  double* contact,
                                  const std::vector<double*>& model) {
  const CalibrationFrame& frame = logs_.frames[index];
  if (frame.object_mm.allFinite() && plan_.scene.circle_radius_mm()) {
    std::vector<double*> blocks = model;
    blocks.push_back(parameters_.object_origin_mm(frame.log));
    AddMeasurement(ObjectContactResidual::Create(
                       &evaluation, 0, frame.object_mm,
                       *plan_.scene.circle_radius_mm(), plan_.object_std_mm),
                   ResidualFamily::kObject, index, -1, blocks);
  }
  if (std::isfinite(frame.contact_mm)) {
    AddMeasurement(ContactLocationResidual::Create(
                       &evaluation, 0, frame.contact_mm, plan_.contact_std_mm),
                   ResidualFamily::kContact, index, -1, {contact});
  }
}

void CalibrationProblem::AddPoints(int index, const FrameEvaluation& evaluation,
                                   const std::vector<double*>& model) {
  const CalibrationFrame& frame = logs_.frames[index];
  std::vector<double*> blocks = model;
  blocks.push_back(parameters_.camera_origin_mm);
  for (const SeenPin& pin : frame.pins) {
    AddMeasurement(PointResidual::CreatePin(&evaluation, pin.rib, pin.side,
                                            pin.at_mm, *plan_.pin_std_mm),
                   ResidualFamily::kPin, index, -1, blocks);
  }
  if (frame.tip_mm.allFinite()) {
    AddMeasurement(
        PointResidual::CreateTip(&evaluation, frame.tip_mm, *plan_.tip_std_mm),
        ResidualFamily::kTip, index, -1, blocks);
  }
}

void CalibrationProblem::AddMeasurement(ceres::CostFunction* cost,
                                        ResidualFamily family, int frame,
                                        int gauge,
                                        const std::vector<double*>& blocks) {
  blocks_.push_back(problem_->AddResidualBlock(cost, loss_.get(), blocks));
  block_info_.push_back({family, frame, gauge});
}

}  // namespace finray
