#include "finray/fit/row_frames.h"

#include <algorithm>

namespace finray {
namespace {

// No more exact than rounding.
constexpr double kLeastResolution_rad = 1e-12;
// A place is measured no better.
constexpr double kBest_mm = 1e-3;
// No gauge bends further.
constexpr double kMostAngle_rad = 0.8;

// With a curve the weight differs from angle to angle.
double MostWeight(const Gauge& gauge) {
  double weight = 0;
  for (double angle = -kMostAngle_rad; angle <= kMostAngle_rad;
       angle += kMostAngle_rad / 8) {
    weight = std::max(weight, gauge.AngleWeight(angle));
  }
  return weight;
}

}  // namespace

double RowFrames::Coarseness(const Finger& finger, double exact_std) {
  double coarseness = 1;
  for (const Gauge& gauge : finger.gauges) {
    coarseness = std::max(coarseness,
                          kLeastResolution_rad * MostWeight(gauge) / exact_std);
  }
  return coarseness;
}

Eigen::VectorXd RowFrames::Resolution(const Finger& finger, const Scene& scene,
                                      double exact_std) {
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  const Eigen::Index poses = scene.tip_std_mm ? 2 : scene.object_std_mm ? 1 : 0;
  const double place_mm =
      exact_std * std::min({kBest_mm, scene.object_std_mm.value_or(kBest_mm),
                            scene.tip_std_mm.value_or(kBest_mm)});
  Eigen::VectorXd resolution(gauges + 3 * poses);
  for (Eigen::Index j = 0; j < gauges; ++j) {
    const Gauge& gauge = finger.gauges[static_cast<std::size_t>(j)];
    resolution[j] =
        std::max(kLeastResolution_rad, exact_std / MostWeight(gauge));
  }
  for (Eigen::Index i = 0; i < poses; ++i) {
    resolution.segment<3>(gauges + 3 * i) << place_mm, place_mm,
        std::max(kLeastResolution_rad, place_mm / finger.front_length_mm);
  }
  return resolution;
}

RowFrames::RowFrames(const Finger& finger, const Scene& scene,
                     const Discretization& discretization)
    : finger_(finger),
      model_(MeasurementModel::OfScene(finger, scene)),
      friction_(scene.friction_coefficient),
      pins_(scene.pin_std_mm.has_value()),
      parameters_(finger_, scene.circle_radius_mm()),
      solver_(finger_, discretization) {
  const SharedParameters& shared = *parameters_.shared();
  solver_.model().set_effects(shared.effects, shared.friction_varies);
}

void RowFrames::set_friction(double friction) {
  row_friction_ = {friction - friction_, 1};
  for (const auto& frame : frames_) {
    if (frame) frame->evaluation.set_friction(friction_, row_friction_);
  }
}

FrameFit::Frame RowFrames::Of(const Measurements& row,
                              const PointContact* contacts, int count) {
  std::unique_ptr<Frame>& frame = frames_[static_cast<std::size_t>(count)];
  if (!frame) {
    const bool movable =
        finger_.calibration && finger_.calibration->HasGaugePlaces();
    frame = std::make_unique<Frame>(
        FrameEvaluation(solver_.model(), EquilibriumForm::kReduced, count,
                        friction_, pins_, movable, row_friction_),
        model_, parameters_.frame(), finger_.gauges);
  }
  for (int c = 0; c < count; ++c) {
    frame->contacts[2 * c] = contacts[c].arc_mm;
    frame->contacts[2 * c + 1] = contacts[c].normal_N;
  }
  last_ = &frame->evaluation;
  return {&frame->blocks.Of(row), &frame->evaluation, frame->contacts.data()};
}

}  // namespace finray
