#include "finray/objects/tangency.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr int kMaxIterations = 30;
constexpr double kGapTolerance = 1e-12;  // in l_0
// The gap changes by the square of the slope only. Along the beam the contact
// is off by slope / |1 / rho - kappa|, 2e-10 mm for a circle of 20 mm at a
// straight beam. 1e-12 would often ask for one more equilibrium.
constexpr double kSlopeTolerance_rad = 1e-11;

}  // namespace

Tangency::Tangency(const RigidObject& object, double friction,
                   EquilibriumSolver* solver)
    : object_(object),
      friction_(friction),
      solver_(solver),
      length_(solver->model().finger().front_length_mm) {
  if (object.spring) {
    const double angle = object.spring->direction_rad;
    direction_ = {std::cos(angle), std::sin(angle)};
  }
}

double Tangency::largest_gap_mm() const {
  return residual_.head(residual_.size() / 2).lpNorm<Eigen::Infinity>();
}

ObjectPose Tangency::Displaced(ObjectPose pose) const {
  pose.position_mm += displacement_mm_ * direction_;
  return pose;
}

// u = -e . sum f_c (n + mu t) / k and its derivatives, with dn = t dtheta and
// dt = -n dtheta.
void Tangency::Push(const std::vector<PointContact>& contacts) {
  const int count = static_cast<int>(contacts.size());
  displacement_mm_ = 0;
  d_displacement_.setZero(2 * count);
  if (!object_.spring) return;
  const double softness = -1 / object_.spring->stiffness_N_per_mm;
  for (int c = 0; c < count; ++c) {
    const double theta = solver_->contact_pose(c).z();
    const Vector2d tangent(std::cos(theta), std::sin(theta));
    const Vector2d normal(tangent.y(), -tangent.x());
    const double by_force =
        softness * direction_.dot(normal + friction_ * tangent);
    const double by_turn =
        softness * direction_.dot(tangent - friction_ * normal);
    displacement_mm_ += contacts[c].normal_N * by_force;
    d_displacement_[count + c] += by_force;
    d_displacement_ += contacts[c].normal_N * by_turn * d_pose_.row(3 * c + 2);
  }
}

// With the moves dr of a contact point and dc of the object,
//   d(distance) = n_o . (dr - dc),
//   d(t . n_o) = -n . n_o dtheta + (t . t_o) (t_o . (dr - dc)) / (rho + d).
void Tangency::Linearize(const ObjectPose& pose,
                         const std::vector<PointContact>& contacts) {
  const int count = static_cast<int>(contacts.size());
  const int row = solver_->model().gauges();
  d_pose_.resize(3 * count, 2 * count);
  for (int c = 0; c < count; ++c) {
    d_pose_.col(c) = solver_->d_outputs().col(2 * c).segment(row, 3 * count);
    d_pose_.col(count + c) =
        solver_->d_outputs().col(2 * c + 1).segment(row, 3 * count);
  }
  Push(contacts);
  const ObjectPose moved = Displaced(pose);

  residual_.resize(2 * count);
  jacobian_.resize(2 * count, 2 * count);
  outside_ = true;
  for (int c = 0; c < count; ++c) {
    const Eigen::Vector3d at = solver_->contact_pose(c);
    const Vector2d tangent(std::cos(at.z()), std::sin(at.z()));
    const Vector2d normal(tangent.y(), -tangent.x());
    const Outline::Distance outline =
        object_.outline.DistanceOf(at.head<2>(), moved);
    const Vector2d along(-outline.normal.y(), outline.normal.x());
    residual_[c] = outline.distance_mm;
    residual_[count + c] = tangent.dot(outline.normal);
    outside_ = outside_ && normal.dot(outline.normal) > 0;
    const Eigen::Matrix2Xd d_offset =
        d_pose_.middleRows<2>(3 * c) - direction_ * d_displacement_;
    jacobian_.row(c) = outline.normal.transpose() * d_offset;
    jacobian_.row(count + c) =
        -normal.dot(outline.normal) * d_pose_.row(3 * c + 2) +
        tangent.dot(along) /
            (outline.curvature_radius_mm + outline.distance_mm) *
            (along.transpose() * d_offset);
  }
}

// Newton's method on the contact equations. With places held it closes the gaps
// only. Steps along the beam are limited, as the tangent is useless beyond a
// bay.
bool Tangency::Solve(const ObjectPose& pose, TangencyUnknowns unknowns,
                     std::vector<PointContact>* contacts) {
  const int count = static_cast<int>(contacts->size());
  const bool sliding = unknowns == TangencyUnknowns::kPlacesAndForces;
  const int equations = sliding ? 2 * count : count;
  const double longest_move = length_ / 10;
  for (int i = 0; i < kMaxIterations; ++i) {
    ++equilibria_;
    if (!solver_->SolveWithSensitivities(*contacts)) return false;
    Linearize(pose, *contacts);
    const double gap = residual_.head(count).lpNorm<Eigen::Infinity>();
    const double slope =
        sliding ? residual_.tail(count).lpNorm<Eigen::Infinity>() : 0;
    if (gap <= kGapTolerance * length_ && slope <= kSlopeTolerance_rad) {
      return outside_;
    }
    const Eigen::VectorXd step = -jacobian_.topRightCorner(equations, equations)
                                      .partialPivLu()
                                      .solve(residual_.head(equations));
    // Where the outline's normal runs along the beam, the equations are
    // singular and rounding makes forces of 1e17 N and more, which no finger
    // bears.
    if (!step.allFinite()) return false;
    // How far, to first order, the forces move the contact points.
    const Eigen::VectorXd moves = d_pose_.rightCols(count) * step.tail(count);
    if (moves.reshaped(3, count).topRows<2>().colwise().norm().maxCoeff() >
        length_) {
      return false;
    }
    double fraction = 1;
    if (sliding) {
      const double move = step.head(count).lpNorm<Eigen::Infinity>();
      // A step off the beam: the beam follows the outline, so the equations do
      // not determine the places.
      if (move > length_) return false;
      fraction = std::min(1.0, longest_move / std::max(move, 1e-300));
    }
    for (int c = 0; c < count; ++c) {
      PointContact& contact = (*contacts)[c];
      if (sliding) {
        contact.arc_mm =
            std::clamp(contact.arc_mm + fraction * step[c], 0.0, length_);
      }
      contact.normal_N += fraction * step[equations - count + c];
    }
  }
  return false;
}

}  // namespace finray
