#include "finray/statics/object_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "finray/statics/object_clearance.h"

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr int kMaxIterations = 30;
constexpr double kTolerance = 1e-12;  // of l_0, and in rad
constexpr double kSmallestRampStep = 1e-3;
constexpr int kMaxRounds = 40;
constexpr std::size_t kMostContacts = 40;
constexpr int kMaxWithdrawals = 200;

// The contact problem of one object with one finger.
class ObjectContactSolver {
 public:
  ObjectContactSolver(const RigidObject& object, double friction,
                      EquilibriumSolver* solver)
      : object_(object),
        friction_(friction),
        solver_(solver),
        length_(solver->model().finger().front_length_mm) {}

  ObjectContact Solve(const ObjectPose& pose,
                      const std::vector<PointContact>& guess);

 private:
  // What may be varied to close the gaps.
  enum class Unknowns { kPlacesAndForces, kForces };

  bool Settle(const ObjectPose& pose, std::vector<PointContact>* contacts);
  bool SolveTangency(const ObjectPose& pose, Unknowns unknowns,
                     std::vector<PointContact>* contacts);
  void Linearize(const ObjectPose& pose,
                 const std::vector<PointContact>& contacts);
  ObjectContactStatus MoveIn(const ObjectPose& pose,
                             std::vector<PointContact>* contacts);
  std::vector<Approach> Approaches(const ObjectPose& pose,
                                   const std::vector<PointContact>& contacts,
                                   double below_mm) const;

  const RigidObject& object_;
  const double friction_;
  EquilibriumSolver* const solver_;
  const double length_;
  double displacement_ = 0;
  // Rows [d of each contact; t . n_o of each], columns [l_c of each; f_c of
  // each].
  Eigen::VectorXd residual_;
  Eigen::MatrixXd jacobian_;
  bool outside_ = false;  // The beam's normals point out of the object.
};

// Where the forces have pushed a sprung object.
ObjectPose Displaced(const RigidObject& object, ObjectPose pose, double way) {
  if (object.spring) {
    const double angle = object.spring->direction_rad;
    pose.position_mm += way * Vector2d(std::cos(angle), std::sin(angle));
  }
  return pose;
}

// The equations of object_contact.h at the solver's equilibrium. With
// dn = t dtheta, dt = -n dtheta and the moves of contact point and centre,
//   d(distance) = n_o . (dr - dc),
//   d(t . n_o) = -n . n_o dtheta + (t . t_o) (t_o . (dr - dc)) / (rho + d).
void ObjectContactSolver::Linearize(const ObjectPose& pose,
                                    const std::vector<PointContact>& contacts) {
  const int count = static_cast<int>(contacts.size());
  const int row = solver_->model().gauges();
  // Of (x, y, theta) of each contact, by [l_c; f_c].
  Eigen::MatrixXd d_pose(3 * count, 2 * count);
  for (int c = 0; c < count; ++c) {
    d_pose.col(c) = solver_->d_outputs().col(2 * c).segment(row, 3 * count);
    d_pose.col(count + c) =
        solver_->d_outputs().col(2 * c + 1).segment(row, 3 * count);
  }
  Vector2d direction = Vector2d::Zero();
  Eigen::RowVectorXd d_displacement = Eigen::RowVectorXd::Zero(2 * count);
  displacement_ = 0;
  if (object_.spring) {
    const double angle = object_.spring->direction_rad;
    direction = {std::cos(angle), std::sin(angle)};
    for (int c = 0; c < count; ++c) {
      const double theta = solver_->contact_pose(c).z();
      const Vector2d tangent(std::cos(theta), std::sin(theta));
      const Vector2d normal(tangent.y(), -tangent.x());
      const double softness = -1 / object_.spring->stiffness_N_per_mm;
      const double along =
          softness * direction.dot(normal + friction_ * tangent);
      const double turned =
          softness * direction.dot(tangent - friction_ * normal);
      displacement_ += contacts[c].normal_N * along;
      d_displacement[count + c] += along;
      d_displacement += contacts[c].normal_N * turned * d_pose.row(3 * c + 2);
    }
  }
  const ObjectPose moved = Displaced(object_, pose, displacement_);

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
        d_pose.middleRows<2>(3 * c) - direction * d_displacement;
    jacobian_.row(c) = outline.normal.transpose() * d_offset;
    jacobian_.row(count + c) =
        -normal.dot(outline.normal) * d_pose.row(3 * c + 2) +
        tangent.dot(along) /
            (outline.curvature_radius_mm + outline.distance_mm) *
            (along.transpose() * d_offset);
  }
}

// Newton on the contact equations, each evaluation an equilibrium; with places
// held only the gaps are closed. Steps along the beam are limited: beyond a bay
// the tangent is worthless.
bool ObjectContactSolver::SolveTangency(const ObjectPose& pose,
                                        Unknowns unknowns,
                                        std::vector<PointContact>* contacts) {
  const int count = static_cast<int>(contacts->size());
  const bool sliding = unknowns == Unknowns::kPlacesAndForces;
  const int equations = sliding ? 2 * count : count;
  const double longest_move = length_ / 10;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (!solver_->SolveWithSensitivities(*contacts)) return false;
    Linearize(pose, *contacts);
    const double gap = residual_.head(count).lpNorm<Eigen::Infinity>();
    const double slope =
        sliding ? residual_.tail(count).lpNorm<Eigen::Infinity>() : 0;
    if (gap <= kTolerance * length_ && slope <= kTolerance) {
      return outside_;
    }
    const Eigen::VectorXd step = -jacobian_.topRightCorner(equations, equations)
                                      .partialPivLu()
                                      .solve(residual_.head(equations));
    if (!step.allFinite()) return false;
    double fraction = 1;
    if (sliding) {
      const double move = step.head(count).lpNorm<Eigen::Infinity>();
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

std::vector<Approach> ObjectContactSolver::Approaches(
    const ObjectPose& pose, const std::vector<PointContact>& contacts,
    double below_mm) const {
  return FindApproaches(Shape(*solver_, contacts), length_, object_.outline,
                        Displaced(object_, pose, displacement_), below_mm);
}

// Finds the set of contacts: those that pull are dropped, places that are
// inside the object are added. Contacts keep their places where they cannot be
// told (the beam follows the outline); enough of them then keep it out.
bool ObjectContactSolver::Settle(const ObjectPose& pose,
                                 std::vector<PointContact>* contacts) {
  for (int round = 0; round < kMaxRounds; ++round) {
    if (contacts->empty() || contacts->size() > kMostContacts) return false;
    const LadderState start = solver_->state();
    std::vector<PointContact> slid = *contacts;
    if (SolveTangency(pose, Unknowns::kPlacesAndForces, &slid)) {
      *contacts = slid;
    } else {
      solver_->set_state(start);
      if (!SolveTangency(pose, Unknowns::kForces, contacts)) return false;
    }
    const auto weakest =
        std::min_element(contacts->begin(), contacts->end(),
                         [](const PointContact& a, const PointContact& b) {
                           return a.normal_N < b.normal_N;
                         });
    if (!(weakest->normal_N > 0)) {
      contacts->erase(weakest);
      continue;
    }
    bool clear = true;
    for (const Approach& approach :
         Approaches(pose, *contacts, -kContactDepthTolerance * length_)) {
      if (approach.at_end ||
          approach.distance_mm >= -kContactDepthTolerance * length_) {
        continue;
      }
      clear = false;
      contacts->push_back({approach.arc_mm, 0, friction_});
    }
    if (clear) return true;
  }
  return false;
}

// The object withdrawn until it only touches the free finger, then moved in.
ObjectContactStatus ObjectContactSolver::MoveIn(
    const ObjectPose& pose, std::vector<PointContact>* contacts) {
  if (!solver_->Solve({})) return ObjectContactStatus::kNotConverged;
  displacement_ = 0;
  const Shape free(*solver_, {});
  const auto deepest = [&](const ObjectPose& at) {
    const std::vector<Approach> all =
        FindApproaches(free, length_, object_.outline, at, 0);
    return *std::min_element(all.begin(), all.end(),
                             [](const Approach& a, const Approach& b) {
                               return a.distance_mm < b.distance_mm;
                             });
  };
  Approach touch = deepest(pose);
  if (touch.distance_mm >= 0) return ObjectContactStatus::kNoContact;
  const double theta = free.At(Side::kFront, touch.arc_mm).theta_rad;
  const Vector2d outward(-std::sin(theta), std::cos(theta));
  ObjectPose withdrawn = pose;
  for (int i = 0; i < kMaxWithdrawals; ++i) {
    if (touch.distance_mm >= -kTolerance * length_) break;
    // Never further than to first touch, as no point moves faster.
    withdrawn.position_mm -= touch.distance_mm * outward;
    touch = deepest(withdrawn);
  }
  if (touch.at_end) return ObjectContactStatus::kNoTangency;

  const Vector2d way = pose.position_mm - withdrawn.position_mm;
  std::vector<PointContact> reached = {{touch.arc_mm, 0, friction_}};
  LadderState reached_state = solver_->state();
  double fraction = 0, step = 1;
  while (fraction < 1) {
    const double next = std::min(1.0, fraction + step);
    ObjectPose moved = pose;
    moved.position_mm -= (1 - next) * way;
    std::vector<PointContact> guess = reached;
    if (Settle(moved, &guess)) {
      fraction = next;
      reached = guess;
      reached_state = solver_->state();
      step *= 1.5;
    } else {
      solver_->set_state(reached_state);
      step *= 0.5;
      if (step < kSmallestRampStep) return ObjectContactStatus::kNotConverged;
    }
  }
  *contacts = reached;
  return ObjectContactStatus::kContact;
}

ObjectContact ObjectContactSolver::Solve(
    const ObjectPose& pose, const std::vector<PointContact>& guess) {
  ObjectContact result;
  std::vector<PointContact>& contacts = result.contacts;
  contacts = guess;
  for (PointContact& contact : contacts) contact.friction = friction_;
  result.status = ObjectContactStatus::kContact;
  if (contacts.empty() || !Settle(pose, &contacts)) {
    contacts.clear();
    result.status = MoveIn(pose, &contacts);
  }
  if (result.status != ObjectContactStatus::kContact) return result;

  for (const Approach& approach :
       Approaches(pose, contacts, -kContactDepthTolerance * length_)) {
    if (approach.at_end &&
        approach.distance_mm < -kContactDepthTolerance * length_) {
      result.status = ObjectContactStatus::kNoTangency;
      contacts.clear();
      return result;
    }
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const PointContact& a, const PointContact& b) {
              return a.arc_mm < b.arc_mm;
            });
  // Once more, so that the solver's results are in the order of the contacts.
  if (!solver_->SolveWithSensitivities(contacts)) {
    result.status = ObjectContactStatus::kNotConverged;
    contacts.clear();
    return result;
  }
  result.displacement_mm = displacement_;
  return result;
}

}  // namespace

ObjectContact SolveObjectContact(const RigidObject& object,
                                 const ObjectPose& pose, double friction,
                                 EquilibriumSolver* solver,
                                 const std::vector<PointContact>& guess) {
  return ObjectContactSolver(object, friction, solver).Solve(pose, guess);
}

}  // namespace finray
