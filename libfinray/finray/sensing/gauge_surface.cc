#include "finray/sensing/gauge_surface.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "finray/finger/geometry.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

constexpr int kMostSteps = 30;
// A step is halved at most so often until chi2 falls.
constexpr int kMostHalvings = 6;
// The last change, in l_0 and in the force: Newton's method squares it. Without
// B, on a bound, the steps shrink by a constant factor only.
constexpr double kLastNewton = 1e-6, kLastGauss = 1e-9;
// A change this small may not lower chi2, because of rounding.
constexpr double kFutile = 1e-5;
// Cells leave out this share of what a frame may, in std of the finger's gauges
// and of a circle measured to kCircle_mm, but no less than rounding.
constexpr double kResolution = 0.1, kCircle_mm = 1e-3;
constexpr double kLeastResolution_rad = 1e-12;
// No gauge bends further.
constexpr double kMostAngle_rad = 0.8;
// The equilibria are solved to this tolerance. Newton's method ends far below
// it.
constexpr double kTolerance = 1e-10;
constexpr int kPoses = 6;

Eigen::VectorXd ResolutionOf(const Finger& finger, bool circle, double std) {
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  Eigen::VectorXd resolution(gauges + (circle ? 2 : 0));
  for (Eigen::Index j = 0; j < gauges; ++j) {
    // With a curve the weight differs from angle to angle.
    double weight = 0;
    for (double angle = -kMostAngle_rad; angle <= kMostAngle_rad;
         angle += kMostAngle_rad / 8) {
      weight = std::max(weight, finger.gauges[j].AngleWeight(angle));
    }
    resolution[j] = std::max(kLeastResolution_rad, std / weight);
  }
  if (circle) resolution.tail<2>().setConstant(std * kCircle_mm);
  return resolution;
}

// Samples [gauges, centre] and then [contact pose, tip pose, rib tensions].
std::function<LoadSampler()> SamplersOf(
    const EquilibriumSolver& solver, double friction,
    std::optional<double> circle_radius_mm) {
  const auto prototype = std::make_shared<const EquilibriumSolver>(solver);
  return [=]() -> LoadSampler {
    const auto own = std::make_shared<EquilibriumSolver>(*prototype);
    own->Reset();
    own->set_tolerance(kTolerance);
    bool near = false;
    return [=](double arc_mm, double normal_N, double* values) mutable {
      if (!own->Solve({{arc_mm, normal_N, friction}})) return false;
      // The first equilibrium may take a path of loads.
      if (!near) own->set_near_only(near = true);
      const int gauges = own->model().gauges();
      values = std::copy_n(own->outputs().data(), gauges, values);
      if (circle_radius_mm) {
        const Eigen::Vector2d centre =
            CircleCentre(own->contact_pose(0), *circle_radius_mm);
        values = std::copy_n(centre.data(), 2, values);
      }
      values = std::copy_n(own->outputs().data() + gauges, kPoses, values);
      for (int i = 0; i < own->model().ribs(); ++i) {
        *values++ = own->rib_tension(i);
      }
      return true;
    };
  };
}

}  // namespace

GaugeSurface::GaugeSurface(const EquilibriumSolver& solver, double friction,
                           std::optional<double> circle_radius_mm,
                           double heaviest_N, double exact_std)
    : friction_(friction),
      length_mm_(solver.model().finger().front_length_mm),
      force_unit_N_(ForceUnit(solver.model().finger())),
      exact_std_(exact_std),
      gauges_(solver.model().gauges()),
      values_(gauges_ + (circle_radius_mm ? 2 : 0)),
      ribs_(solver.model().ribs()),
      resolution_(ResolutionOf(solver.model().finger(),
                               circle_radius_mm.has_value(),
                               kResolution * exact_std)),
      surface_(
          LoadSurface::DomainOf(solver.model().finger(),
                                solver.model().mesh(Side::kFront), heaviest_N),
          {{values_, kPoses + ribs_},
           resolution_,
           SamplersOf(solver, friction, circle_radius_mm)}) {}

// Memory for a frame, on the stack unless the finger is large.
template <int kOnStack>
class GaugeSurface::Scratch {
 public:
  explicit Scratch(int size) {
    if (size > kOnStack) heap_.resize(size);
  }
  double* data() { return heap_.empty() ? stack_.data() : heap_.data(); }

 private:
  std::array<double, kOnStack> stack_;
  std::vector<double> heap_;
};

// Newton's method on x = (l_c / l_0, f_c / (EI / l_0^2)).
class GaugeSurface::Descent {
 public:
  using Column = Eigen::Ref<const Eigen::VectorXd>;

  Descent(const GaugeSurface& surface, const Column& values,
          const Column& weights, double most_force_N)
      : s_(surface),
        values_(values),
        weights_(weights),
        most_force_N_(most_force_N),
        stride_(LoadPolynomial::Padded(s_.values_)),
        jets_(6 * stride_) {}

  // Returns false off the surface.
  bool EquationsAt(const ContactVector& x, ContactEquations* equations) {
    // Rounding may put the force beyond its bound.
    const double arc_mm = std::clamp(x[0] * s_.length_mm_, 0.0, s_.length_mm_);
    const double normal_N =
        std::clamp(x[1] * s_.force_unit_N_, 0.0, most_force_N_);
    if (!s_.surface_.Locate(arc_mm, normal_N, &place_)) return false;
    s_.surface_.Jets(place_, 0, jets_.data());
    const double l = s_.length_mm_, f = s_.force_unit_N_;
    CurvedSums sums;
    for (int j = 0; j < s_.values_; ++j) {
      if (weights_[j] == 0) continue;
      const double* const jet = jets_.data() + j;
      sums.Add(weights_[j], jet[0] - values_[j], l * jet[stride_],
               f * jet[2 * stride_], l * l * jet[3 * stride_],
               l * f * jet[4 * stride_], f * f * jet[5 * stride_]);
    }
    *equations = sums.Equations();
    return true;
  }

 private:
  const GaugeSurface& s_;
  const Column &values_, &weights_;
  const double most_force_N_;
  const int stride_;
  LoadSurface::Place place_;
  Scratch<6 * 16> jets_;  // LoadSurface::Jets
};

bool GaugeSurface::Fit(const Eigen::Ref<const Eigen::VectorXd>& values,
                       const Eigen::Ref<const Eigen::VectorXd>& weights,
                       double most_force_N, const PointContact& start,
                       ContactSolution* solution) const {
  const double most = most_force_N / force_unit_N_;
  ContactVector x(2);
  x << start.arc_mm / length_mm_, start.normal_N / force_unit_N_;
  Descent descent(*this, values, weights, most_force_N);
  std::array<ContactEquations, 2> equations;
  ContactEquations *here = &equations[0], *there = &equations[1];
  if (!descent.EquationsAt(x, here)) return false;
  for (int i = 0; i < kMostSteps; ++i) {
    ContactVector change = BoundedChange(*here, x, most, 0);
    const bool newton = here->curvature.size() > 0;
    const double size = LargestChange(change, x, 0);
    // Wherever it is, a contact without force is the free finger.
    bool last = size < (newton ? kLastNewton : kLastGauss) ||
                (x[1] == 0 && change[1] == 0);
    ContactVector taken = change;
    for (int halvings = 0; !last; ++halvings) {
      taken = change;
      taken[0] *= ArcShare(x[1], change[1]);
      taken[0] = std::clamp(x[0] + taken[0], 0.0, 1.0) - x[0];
      if (!descent.EquationsAt(x + taken, there)) return false;
      if (there->chi2 <= here->chi2) break;
      if (halvings == kMostHalvings) {
        if (size > kFutile) return false;
        taken.setZero();
        last = true;
      }
      change *= 0.5;
    }
    if (last) {
      // chi2 is quadratic over so small a change.
      double fallen = 2 * here->gradient.dot(taken);
      fallen += taken.dot(ContactVector(here->normal * taken));
      if (newton) fallen += taken.dot(ContactVector(here->curvature * taken));
      x += taken;
      solution->count = 1;
      solution->contacts[0] = {
          x[0] >= 1 ? length_mm_ : x[0] * length_mm_,
          x[1] >= most ? most_force_N : x[1] * force_unit_N_, friction_};
      solution->chi2 = std::max(0.0, here->chi2 + fallen);
      solution->information =
          InformationOf(here->normal, length_mm_, force_unit_N_);
      return SetOutputs(exact_std_ / weights.cwiseProduct(resolution_).norm(),
                        solution);
    }
    x += taken;
    std::swap(here, there);
  }
  return false;
}

bool GaugeSurface::SetOutputs(double most_error,
                              ContactSolution* solution) const {
  LoadSurface::Place place;
  const PointContact& contact = solution->contacts[0];
  if (!surface_.Locate(contact.arc_mm, contact.normal_N, &place) ||
      !(place.error() < most_error)) {
    return false;
  }
  Scratch<32> outputs(LoadPolynomial::Padded(kPoses + ribs_));
  surface_.Values(place, 1, outputs.data());
  const double* const poses = outputs.data();
  solution->poses[0] = Eigen::Map<const Eigen::Vector3d>(poses);
  solution->tip_pose = Eigen::Map<const Eigen::Vector3d>(poses + 3);
  solution->rib_tension_N.assign(poses + kPoses, poses + kPoses + ribs_);
  return true;
}

bool GaugeSurface::ValuesAt(double arc_mm, double normal_N,
                            Eigen::VectorXd* values) const {
  LoadSurface::Place place;
  if (!surface_.Locate(arc_mm, normal_N, &place)) return false;
  values->resize(LoadPolynomial::Padded(values_));
  surface_.Values(place, 0, values->data());
  values->conservativeResize(values_);
  return true;
}

}  // namespace finray
