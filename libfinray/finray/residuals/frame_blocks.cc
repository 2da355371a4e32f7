#include "finray/residuals/frame_blocks.h"

#include <cmath>
#include <utility>

#include "finray/residuals/cylinder_gauge_residual.h"
#include "finray/residuals/equilibrium_residual.h"
#include "finray/residuals/gauge_reading_residual.h"
#include "finray/residuals/object_contact_residual.h"
#include "finray/residuals/point_residual.h"
#include "finray/residuals/reference_force_residual.h"
#include "finray/residuals/rib_length_residual.h"

namespace finray {
namespace {

// Collects the blocks of one frame.
struct Builder {
  const Measurements& row;
  const MeasurementModel& model;
  const FrameParameters& parameters;
  const FrameEvaluation* evaluation;
  double* unknowns;
  std::vector<double*> of_model;  // parameter blocks of FrameResidual
  std::vector<FrameBlock> blocks;

  void Add(ceres::CostFunction* cost, std::vector<double*> parameter_blocks,
           ResidualFamily family, int gauge = -1, double std_V = 0) {
    blocks.push_back({std::unique_ptr<ceres::CostFunction>(cost),
                      std::move(parameter_blocks), family, gauge, std_V});
  }
  // Returns the parameter blocks of a residual that depends on the whole model:
  // those of FrameResidual, then `a` and `b`.
  std::vector<double*> OfModelAnd(double* a, double* b = nullptr) const {
    std::vector<double*> all;
    all.reserve(of_model.size() + 7);
    all = of_model;
    all.push_back(a);
    if (b != nullptr) all.push_back(b);
    return all;
  }
};

// Appends the variables of a reading's terms to `blocks` and returns their
// coefficients.
std::vector<double> AddTerms(const std::vector<ReadingTerm>& terms,
                             std::vector<double*>* blocks) {
  std::vector<double> coefficients;
  coefficients.reserve(terms.size());
  for (const ReadingTerm& term : terms) {
    blocks->push_back(term.variable);
    coefficients.push_back(term.coefficient);
  }
  return coefficients;
}

void AddFlat(const FrameParameters& of, int gauge,
             std::vector<double*>* blocks) {
  if (of.flat_shares == nullptr) return;
  blocks->push_back(&of.flat_shares[gauge]);
  blocks->push_back(&of.ln_flat_widths[gauge]);
}

void AddReadings(const std::vector<Gauge>& gauges, Builder* out) {
  for (int j = 0; j < static_cast<int>(gauges.size()); ++j) {
    if (!gauges[j].IsMeasured(out->row.gauges_V[j])) continue;
    const FrameParameters& of = out->parameters;
    std::vector<double*> blocks =
        out->OfModelAnd(&of.gains_V_per_rad[j], &of.curvatures_per_rad[j]);
    AddFlat(of, j, &blocks);
    if (out->evaluation->movable_gauges()) {
      blocks.push_back(&of.finger->gauge_starts_mm[j]);
      blocks.push_back(&of.finger->gauge_lengths_mm[j]);
    }
    const HistoryTerm history =
        of.histories.empty() ? HistoryTerm{} : of.histories[j];
    if (history.history != nullptr) {
      blocks.insert(blocks.end(), {history.share, history.ln_time_constant,
                                   history.hysteresis_rad});
    }
    std::vector<double> coefficients = AddTerms(of.readings[j], &blocks);
    auto* residual = new GaugeReadingResidual(
        out->evaluation, j, &out->row, out->model.gauge_std_V[j],
        std::move(coefficients), history, of.flat_shares != nullptr);
    out->Add(residual, std::move(blocks), ResidualFamily::kGauge, j,
             residual->std_V());
  }
}

void AddBench(const std::vector<Gauge>& gauges, Builder* out) {
  for (int j = 0; j < static_cast<int>(gauges.size()); ++j) {
    if (!gauges[j].IsMeasured(out->row.gauges_V[j])) continue;
    std::vector<double*> blocks = {
        &out->parameters.gains_V_per_rad[j],
        &out->parameters.curvatures_per_rad[j],
        &out->parameters.finger->gauge_lengths_mm[j]};
    AddFlat(out->parameters, j, &blocks);
    const auto coefficients = AddTerms(out->parameters.readings[j], &blocks);
    const double std_V = out->row.GaugeStd_V(static_cast<std::size_t>(j),
                                             out->model.gauge_std_V[j]);
    out->Add(new CylinderGaugeResidual(
                 out->row.cylinder_radius_mm, out->row.gauges_V[j], std_V,
                 coefficients, out->parameters.flat_shares != nullptr),
             std::move(blocks), ResidualFamily::kBench, j);
  }
}

void AddForce(Builder* out) {
  if (!out->model.force_std_N) return;
  const double std_N = *out->model.force_std_N;
  const FrameParameters& of = out->parameters;
  double* ln_scale = of.ln_force_scale;
  LateForce late;
  late.time_s = out->row.time_s;
  const bool may_be_late = of.forces_N != nullptr;
  if (out->row.force_xy_N.allFinite()) {
    if (may_be_late) late.signals = of.forces_N->data();
    std::vector<double*> blocks =
        out->OfModelAnd(ln_scale, of.force_offset_xy_N);
    blocks.push_back(of.force_tilt_deg);
    blocks.push_back(of.force_weight_N);
    if (may_be_late) blocks.push_back(of.force_time_offset_s);
    out->Add(new ReferenceForceVectorResidual(out->evaluation,
                                              out->row.force_xy_N, std_N,
                                              out->row.object_angle_rad, late),
             std::move(blocks), ResidualFamily::kForce);
  } else if (std::isfinite(out->row.force_N)) {
    std::vector<double*> blocks;
    if (out->evaluation->contacts() > 0) blocks.push_back(out->unknowns);
    blocks.push_back(ln_scale);
    blocks.push_back(of.force_offset_N);
    if (may_be_late) {
      late.signals = &(*of.forces_N)[2];
      blocks.push_back(of.force_time_offset_s);
    }
    if (out->evaluation->contacts() > 0 &&
        out->evaluation->friction_effect() >= 0) {
      blocks.push_back(of.finger->effect_values.data());
    }
    out->Add(new ReferenceForceResidual(out->evaluation, out->row.force_N,
                                        std_N, late),
             std::move(blocks), ResidualFamily::kForce);
  }
}

void AddPlace(Builder* out) {
  if (out->evaluation->contacts() == 0) return;
  const Measurements& row = out->row;
  const FrameParameters& parameters = out->parameters;
  const bool any =
      std::isfinite(row.object_mm.x()) || std::isfinite(row.object_mm.y());
  if (out->model.object_std_mm && any) {
    std::vector<double*> blocks = out->OfModelAnd(parameters.object_origin_mm);
    blocks.insert(blocks.end(),
                  {parameters.object_rotation_deg, parameters.ln_object_scale,
                   parameters.object_radius_mm});
    out->Add(new ObjectContactResidual(out->evaluation, 0, &row.object_mm,
                                       *out->model.object_std_mm),
             std::move(blocks), ResidualFamily::kObject);
  }
  if (out->model.contact_std_mm && std::isfinite(row.contact_mm)) {
    out->Add(new ContactLocationResidual(out->evaluation, 0, row.contact_mm,
                                         *out->model.contact_std_mm),
             {out->unknowns}, ResidualFamily::kContact);
  }
}

void AddCamera(Builder* out) {
  double* origin = out->parameters.camera_origin_mm;
  if (out->model.pin_std_mm) {
    for (const SeenPin& pin : out->row.pins) {
      const int at = out->evaluation->pin_row(pin.rib, pin.side);
      out->Add(new PointResidual(out->evaluation, at, &pin.at_mm,
                                 *out->model.pin_std_mm),
               out->OfModelAnd(origin), ResidualFamily::kPin);
    }
  }
  if (out->model.tip_std_mm && out->row.tip_mm.allFinite()) {
    out->Add(new PointResidual(out->evaluation, out->evaluation->tip_row(),
                               &out->row.tip_mm, *out->model.tip_std_mm),
             out->OfModelAnd(origin), ResidualFamily::kTip);
  }
}

std::vector<double*> ModelBlocks(const FrameParameters& parameters,
                                 const FrameEvaluation& evaluation,
                                 double* unknowns) {
  SharedParameters& finger = *parameters.finger;
  return FrameParameterBlocks(evaluation, unknowns, &finger.ln_front_stiffness,
                              &finger.ln_back_stiffness,
                              finger.rib_lengths_mm.data(),
                              finger.effect_values.data());
}

}  // namespace

MeasurementModel MeasurementModel::OfScene(const Finger& finger,
                                           const Scene& scene) {
  MeasurementModel model;
  for (const Gauge& gauge : finger.gauges) {
    model.gauge_std_V.push_back(gauge.noise_V);
  }
  model.object_std_mm = scene.object_std_mm;
  model.pin_std_mm = scene.pin_std_mm;
  model.tip_std_mm = scene.tip_std_mm;
  return model;
}

std::vector<FrameBlock> MeasurementBlocks(const Measurements& row,
                                          const MeasurementModel& model,
                                          const FrameParameters& parameters,
                                          const std::vector<Gauge>& gauges,
                                          const FrameEvaluation* evaluation,
                                          double* unknowns) {
  Builder out{row, model, parameters, evaluation, unknowns, {}, {}};
  if (row.IsBench()) {
    AddBench(gauges, &out);
    return std::move(out.blocks);
  }
  out.of_model = ModelBlocks(parameters, *evaluation, unknowns);
  out.blocks.reserve(gauges.size() + 2);  // force and place
  AddReadings(gauges, &out);
  AddForce(&out);
  AddPlace(&out);
  AddCamera(&out);
  return std::move(out.blocks);
}

bool FrameBlocks::Fit(const Measurements& row) const {
  // Blocks of references hold their numbers.
  const bool keeps = model_.force_std_N || model_.contact_std_mm ||
                     row.IsBench() || row_.IsBench();
  if (blocks_.empty() || keeps || row.gauges_V.size() != row_.gauges_V.size() ||
      row.pins.size() != row_.pins.size()) {
    return false;
  }
  for (std::size_t j = 0; j < gauges_.size(); ++j) {
    if (gauges_[j].IsMeasured(row.gauges_V[j]) !=
        gauges_[j].IsMeasured(row_.gauges_V[j])) {
      return false;
    }
  }
  for (std::size_t i = 0; i < row.pins.size(); ++i) {
    if (row.pins[i].rib != row_.pins[i].rib ||
        row.pins[i].side != row_.pins[i].side) {
      return false;
    }
  }
  const auto same = [](double a, double b) {
    return std::isfinite(a) == std::isfinite(b);
  };
  return same(row.object_mm.x(), row_.object_mm.x()) &&
         same(row.object_mm.y(), row_.object_mm.y()) &&
         same(row.tip_mm.sum(), row_.tip_mm.sum());
}

const std::vector<FrameBlock>& FrameBlocks::Of(const Measurements& row) {
  const bool fit = Fit(row);
  row_ = row;
  if (!fit) {
    blocks_ = MeasurementBlocks(row_, model_, parameters_, gauges_, evaluation_,
                                unknowns_);
  }
  for (FrameBlock& block : blocks_) {
    if (block.family != ResidualFamily::kGauge) continue;
    block.std_V =
        static_cast<const GaugeReadingResidual*>(block.cost.get())->std_V();
  }
  return blocks_;
}

std::vector<FrameBlock> EquilibriumBlocks(const Finger& finger, double weight,
                                          const FrameParameters& parameters,
                                          const FrameEvaluation& evaluation,
                                          double* unknowns) {
  const Measurements none;
  const MeasurementModel model;
  Builder out{none, model, parameters, &evaluation, unknowns, {}, {}};
  const auto blocks = ModelBlocks(parameters, evaluation, unknowns);
  out.Add(new EquilibriumResidual(&evaluation, finger, weight), blocks,
          ResidualFamily::kEquilibrium);
  if (evaluation.ribs() > 0) {
    out.Add(new RibLengthResidual(&evaluation, finger, weight), blocks,
            ResidualFamily::kEquilibrium);
  }
  return std::move(out.blocks);
}

FingerParameters::FingerParameters(const Finger& finger,
                                   std::optional<double> circle_radius_mm)
    : shared_(SharedParameters::Of(
          finger, finger.calibration ? finger.calibration->StaticsEffects()
                                     : std::vector<FingerParameter>())),
      object_radius_mm_(circle_radius_mm.value_or(0)) {
  if (finger.calibration && finger.calibration->HasFriction()) {
    shared_.friction_varies = true;
    shared_.effect_values.push_back(finger.calibration->friction);
  }
  for (const Gauge& gauge : finger.gauges) {
    gains_.push_back(gauge.gain_V_per_rad);
    offsets_.push_back(gauge.offset_V);
    curvatures_.push_back(gauge.curvature_per_rad);
    flat_shares_.push_back(gauge.flat_share);
    ln_flat_widths_.push_back(std::log(gauge.flat_width_rad));
  }
  if (HasFlatGauges(finger)) {
    frame_.flat_shares = flat_shares_.data();
    frame_.ln_flat_widths = ln_flat_widths_.data();
  }
  frame_.finger = &shared_;
  frame_.gains_V_per_rad = gains_.data();
  frame_.curvatures_per_rad = curvatures_.data();
  for (double& offset : offsets_) frame_.readings.push_back({{&offset, 1}});
  frame_.ln_force_scale = &ln_force_scale_;
  frame_.force_offset_N = &force_offset_N_;
  frame_.force_offset_xy_N = force_offset_xy_N_;
  frame_.force_tilt_deg = &force_tilt_deg_;
  frame_.force_weight_N = force_weight_N_;
  frame_.object_origin_mm = object_origin_mm_;
  frame_.object_rotation_deg = &object_rotation_deg_;
  frame_.ln_object_scale = &ln_object_scale_;
  frame_.object_radius_mm = &object_radius_mm_;
  frame_.camera_origin_mm = camera_origin_mm_;
}

}  // namespace finray
