#include "finray/model/model_surface.h"

#include <algorithm>
#include <memory>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

// Loads beyond this, in units of EI / l_0^2, are rare and solved one by one.
constexpr double kHeaviest = 40;
// A cell that leaves out so many times the resolution is not used.
constexpr double kInexact = 10;
// Derivatives by the parameters leave out terms of this share of their largest.
// Every std is off by as small a share of itself, and the minimum by as small a
// share of a std.
constexpr double kNegligible = 1e-5;
constexpr int kPoses = 6;  // numbers of the contact and the tip

}  // namespace

// A solver and a frame at values of the shared parameters.
struct ModelSurface::Model {
  SharedParameters shared;
  EquilibriumSolver solver;
  FrameEvaluation frame;

  Model(const EquilibriumSolver& from, const SharedParameters& at,
        double friction, bool movable_gauges)
      : shared(at),
        solver(from),
        frame(
            (solver.model().set_effects(shared.effects, shared.friction_varies),
             solver.Reset(), solver.model()),
            EquilibriumForm::kReduced, 1, friction, false, movable_gauges) {}

  bool Update(double arc_mm, double normal_N) {
    const double contact[] = {arc_mm, normal_N};
    frame.Update(contact, shared, &solver);
    return frame.valid();
  }

  // Writes the first `count` outputs; their derivatives by the parameters and
  // by the places of the gauges; and the shape.
  bool Sample(double arc_mm, double normal_N, int count, bool by_parameter,
              bool shape, double* to) {
    // The solver knows the samples before.
    frame.set_state({});
    if (!Update(arc_mm, normal_N)) return false;
    const int first = frame.contact_row(1), tip = frame.tip_row();
    const auto& all = frame.d_outputs();
    const auto row = [&](int i) { return i < first ? i : i - first + tip; };
    for (int i = 0; i < count; ++i) *to++ = frame.outputs()[row(i)];
    for (int i = 0; by_parameter && i < count; ++i) {
      to = std::copy_n(all.row(row(i)).data() + 2, all.cols() - 2, to);
    }
    for (int j = 0;
         by_parameter && frame.movable_gauges() && j < frame.gauges(); ++j) {
      to = std::copy_n(frame.by_place(j).data(), 2, to);
    }
    for (int i = frame.gauges(); shape && i < first; ++i) {
      *to++ = frame.outputs()[i];
    }
    for (int i = tip; shape && i < tip + 3; ++i) *to++ = frame.outputs()[i];
    for (int i = 0; shape && i < frame.ribs(); ++i) {
      *to++ = solver.rib_tension(i);
    }
    return true;
  }

  // The loads at these values: the hinges may have moved, and the gauges too.
  LoadSurface::Domain Domain(std::optional<double> heaviest_N) const {
    Model moved = *this;
    const LadderModel& at = moved.solver.model();
    moved.Update(at.finger().front_length_mm / 2, 0);
    Finger finger = at.finger();
    for (std::size_t j = 0; frame.movable_gauges() && j < finger.gauges.size();
         ++j) {
      finger.gauges[j].start_mm = shared.gauge_starts_mm[j];
      finger.gauges[j].length_mm = shared.gauge_lengths_mm[j];
    }
    return LoadSurface::DomainOf(
        finger, at.mesh(Side::kFront),
        heaviest_N.value_or(kHeaviest * ForceUnit(finger)));
  }
};

ModelSurface::ModelSurface(const EquilibriumSolver& solver,
                           const SharedParameters& shared, double friction,
                           bool movable_gauges, const Content& content)
    : ModelSurface(std::make_shared<const Model>(solver, shared, friction,
                                                 movable_gauges),
                   content) {}

ModelSurface::ModelSurface(std::shared_ptr<const Model> model,
                           const Content& content)
    : outputs_(static_cast<int>(content.resolution.size())),
      parameters_(model->frame.columns() - 2),
      places_(model->frame.movable_gauges() ? model->frame.gauges() : 0),
      ribs_(model->frame.ribs()),
      by_parameter_(content.by_parameter),
      surface_(model->Domain(content.heaviest_N),
               {GroupSizes(content), content.resolution,
                [model, count = outputs_, by_parameter = content.by_parameter,
                 shape = content.shape]() -> LoadSampler {
                  const auto own = std::make_shared<Model>(*model);
                  return [=](double arc_mm, double normal_N, double* to) {
                    return own->Sample(arc_mm, normal_N, count, by_parameter,
                                       shape, to);
                  };
                },
                kNegligible}) {}

std::vector<int> ModelSurface::GroupSizes(const Content& content) const {
  std::vector<int> sizes = {outputs_};
  if (content.by_parameter) {
    sizes.push_back(outputs_ * parameters_ + 2 * places_);
  }
  if (content.shape) sizes.push_back(kPoses + ribs_);
  return sizes;
}

bool ModelSurface::Evaluate(double arc_mm, double normal_N, bool all,
                            Values* values) const {
  LoadSurface::Place place;
  if (!surface_.Locate(arc_mm, normal_N, &place) || place.error() > kInexact) {
    return false;
  }
  std::vector<double>& scratch = values->scratch;
  const int stride = LoadPolynomial::Padded(outputs_);
  const int derivatives = outputs_ * parameters_;
  const int size = LoadPolynomial::Padded(derivatives + 2 * places_);
  scratch.resize(static_cast<std::size_t>(std::max(3 * stride, size)));
  surface_.Gradients(place, 0, scratch.data());
  values->error = place.error();
  values->outputs = Eigen::Map<const Eigen::VectorXd>(scratch.data(), outputs_);
  values->d_outputs.resize(outputs_, 2 + parameters_);
  for (int k = 0; k < 2; ++k) {
    values->d_outputs.col(k) = Eigen::Map<const Eigen::VectorXd>(
        scratch.data() + (1 + k) * stride, outputs_);
  }
  values->by_place.resize(static_cast<std::size_t>(places_));
  if (!all) return true;
  surface_.Values(place, 1, scratch.data());
  values->d_outputs.rightCols(parameters_) =
      Eigen::Map<const EquilibriumSolver::Matrix>(scratch.data(), outputs_,
                                                  parameters_);
  for (int j = 0; j < places_; ++j) {
    values->by_place[j] =
        Eigen::Map<const Eigen::Vector2d>(scratch.data() + derivatives + 2 * j);
  }
  return true;
}

bool ModelSurface::ShapeAt(double arc_mm, double normal_N,
                           Eigen::Vector3d* contact, Eigen::Vector3d* tip,
                           std::vector<double>* rib_tension_N) const {
  LoadSurface::Place place;
  if (!surface_.Locate(arc_mm, normal_N, &place)) return false;
  // Room for the poses and what pads the ribs.
  rib_tension_N->resize(
      static_cast<std::size_t>(LoadPolynomial::Padded(kPoses + ribs_)));
  double* const values = rib_tension_N->data();
  surface_.Values(place, by_parameter_ ? 2 : 1, values);
  *contact = Eigen::Map<const Eigen::Vector3d>(values);
  *tip = Eigen::Map<const Eigen::Vector3d>(values + 3);
  std::copy(values + kPoses, values + kPoses + ribs_, values);
  rib_tension_N->resize(static_cast<std::size_t>(ribs_));
  return true;
}

}  // namespace finray
