#include "finray/objects/object_contact.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/io/nan.h"
#include "finray/objects/approaches.h"
#include "finray/objects/tangency.h"

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr double kTolerance = 1e-12;  // of l_0
constexpr double kSmallestRampStep = 1e-3;
// In l_0. Longer steps may jump to another equilibrium.
constexpr double kLongestStep = 0.025;
constexpr double kNearEnd = 0.02;  // of l_0
constexpr int kMostEquilibria = 4000;
constexpr int kMaxRounds = 40;
// Rounds in which a contact held at a wrong place may still move.
constexpr int kMovingRounds = 8;
constexpr std::size_t kMostContacts = 40;
constexpr int kMaxWithdrawals = 200;
// In l_0. Rounding hides the finger from an object further away.
constexpr double kFarthest = 1e8;

// The contact problem of one object with one finger.
class ObjectContactSolver {
 public:
  ObjectContactSolver(const RigidObject& object, double friction,
                      EquilibriumSolver* solver)
      : object_(object),
        friction_(friction),
        solver_(solver),
        length_(solver->model().finger().front_length_mm),
        deepest_(-kContactDepthTolerance * length_),
        tangency_(object, friction, solver) {}

  ObjectContact Solve(const ObjectPose& pose,
                      const std::vector<PointContact>& guess) {
    // Written so that a NaN fails.
    if (!(pose.position_mm.lpNorm<Eigen::Infinity>() <= kFarthest * length_) ||
        !std::isfinite(pose.angle_rad)) {
      return {ObjectContactStatus::kNotConverged, {}, 0};
    }
    ObjectContact result{ObjectContactStatus::kContact, guess, 0};
    std::vector<PointContact>& contacts = result.contacts;
    for (PointContact& contact : contacts) contact.friction = friction_;
    if (contacts.empty() || !Settle(pose, &contacts)) {
      contacts.clear();
      result.status = MoveIn(pose, &contacts);
    }
    if (result.status != ObjectContactStatus::kContact) return result;

    result.status = Judge(contacts, approaches_);
    if (result.status != ObjectContactStatus::kContact) {
      contacts.clear();
      return result;
    }
    result.displacement_mm = tangency_.displacement_mm();
    return result;
  }

 private:
  // The approaches to the displaced object, with all that are inside it.
  std::vector<Approach> Approaches(
      const ObjectPose& pose, const std::vector<PointContact>& contacts) const {
    return FindApproaches(Shape::OfFront(*solver_, contacts), length_, contacts,
                          object_.outline, tangency_.Displaced(pose), deepest_);
  }

  // Finds the set of contacts: drops those that pull and adds places that are
  // inside the object. Where the beam follows the outline, Newton cannot
  // determine the places of contacts; they are then held, and enough of them
  // keep the beam out of the object. If it returns true, the contacts are in
  // order and the solver and tangency_ are at their equilibrium, of which
  // approaches_ holds the approaches.
  bool Settle(const ObjectPose& pose, std::vector<PointContact>* contacts) {
    const auto lower = [](const PointContact& a, const PointContact& b) {
      return a.arc_mm < b.arc_mm;
    };
    for (int round = 0; round < kMaxRounds; ++round) {
      if (contacts->empty() || contacts->size() > kMostContacts) return false;
      std::sort(contacts->begin(), contacts->end(), lower);
      const LadderState start = solver_->state();
      std::vector<PointContact> slid = *contacts;
      const bool tangent =
          tangency_.Solve(pose, TangencyUnknowns::kPlacesAndForces, &slid);
      if (tangent) {
        *contacts = slid;
      } else {
        solver_->set_state(start);
        if (!tangency_.Solve(pose, TangencyUnknowns::kForces, contacts)) {
          return false;
        }
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
      std::vector<double> inside;
      approaches_ = Approaches(pose, *contacts);
      for (const Approach& approach : approaches_) {
        if (!approach.at_end && approach.distance_mm < deepest_) {
          inside.push_back(approach.arc_mm);
        }
      }
      if (inside.empty()) {
        if (std::is_sorted(contacts->begin(), contacts->end(), lower)) {
          return true;
        }
        continue;
      }
      AddContacts(inside, !tangent && round < kMovingRounds, contacts);
    }
    return false;
  }

  // A contact held at a wrong place has a neighbour that is inside the object.
  // It is moved there, unless there is one on each side.
  void AddContacts(const std::vector<double>& places, bool may_move,
                   std::vector<PointContact>* contacts) const {
    const std::vector<PointContact> before = *contacts;
    std::vector<int> neighbours(before.size(), 0);
    const auto nearest = [&](double arc) {
      std::size_t best = 0;
      for (std::size_t c = 1; c < before.size(); ++c) {
        if (std::abs(before[c].arc_mm - arc) <
            std::abs(before[best].arc_mm - arc)) {
          best = c;
        }
      }
      return best;
    };
    const auto beside = [&](double arc) {
      return std::abs(before[nearest(arc)].arc_mm - arc) < length_ / 20;
    };
    for (const double arc : places) {
      if (beside(arc)) ++neighbours[nearest(arc)];
    }
    for (const double arc : places) {
      if (may_move && beside(arc) && neighbours[nearest(arc)] == 1) {
        (*contacts)[nearest(arc)].arc_mm = arc;
      } else {
        contacts->push_back({arc, 0, friction_});
      }
    }
  }

  // Returns true if the object has nearly reached an end of the beam.
  bool EndsAreInside(const ObjectPose& pose,
                     const std::vector<PointContact>& contacts) {
    const double margin = kNearEnd * length_;
    for (const PointContact& contact : contacts) {
      if (contact.arc_mm < margin || contact.arc_mm > length_ - margin) {
        return true;
      }
    }
    if (!solver_->SolveWithSensitivities(contacts)) return false;
    tangency_.Linearize(pose, contacts);
    return Judge(contacts, Approaches(pose, contacts)) ==
           ObjectContactStatus::kNoTangency;
  }

  // Judges the equilibrium that tangency_ has evaluated.
  ObjectContactStatus Judge(const std::vector<PointContact>& contacts,
                            const std::vector<Approach>& approaches) const {
    for (const PointContact& contact : contacts) {
      if (contact.arc_mm <= 0 || contact.arc_mm >= length_) {
        return ObjectContactStatus::kNoTangency;
      }
    }
    ObjectContactStatus status = ObjectContactStatus::kContact;
    for (const Approach& approach : approaches) {
      if (approach.distance_mm >= deepest_) continue;
      if (approach.at_end) return ObjectContactStatus::kNoTangency;
      status = ObjectContactStatus::kNotConverged;
    }
    if (tangency_.largest_gap_mm() > -deepest_) {
      return ObjectContactStatus::kNotConverged;
    }
    return status;
  }

  // An object between the beams has come from outside and pushes the front beam
  // ahead of it. Returns how far it lies behind the place where the free front
  // beam, nearest at `near`, runs through its middle; zero if it is not between
  // the beams.
  Vector2d InnerWay(const Section& near, const ObjectPose& pose) const {
    const Vector2d into(std::sin(near.theta_rad), -std::cos(near.theta_rad));
    const Vector2d beam(near.x_mm, near.y_mm);
    const Outline::Distance nearest = object_.outline.DistanceOf(beam, pose);
    const Finger& finger = solver_->model().finger();
    const double angle = BeamAngle(finger, Side::kBack);
    const Vector2d behind(std::sin(angle), -std::cos(angle));
    // The point of the object nearest to the beam.
    const Vector2d face = beam - nearest.distance_mm * nearest.normal;
    if (behind.dot(face - BeamBase(finger, Side::kBack)) > 0 ||
        nearest.normal.dot(into) > -0.5) {
      return Vector2d::Zero();
    }
    const double angle_into = std::atan2(into.y(), into.x()) - pose.angle_rad;
    const double width =
        (object_.outline.PointAt(angle_into).position_mm -
         object_.outline.PointAt(angle_into + M_PI).position_mm)
            .dot(Vector2d(std::cos(angle_into), std::sin(angle_into)));
    return (nearest.distance_mm + 0.5 * width) * into;
  }

  // Withdraws the object until it only touches the free finger, then moves it
  // in.
  ObjectContactStatus MoveIn(const ObjectPose& pose,
                             std::vector<PointContact>* contacts) {
    if (!solver_->Solve({})) return ObjectContactStatus::kNotConverged;
    tangency_.ResetDisplacement();
    const Shape free = Shape::OfFront(*solver_, {});
    const auto deepest = [&](const ObjectPose& at) {
      const std::vector<Approach> all =
          FindApproaches(free, length_, {}, object_.outline, at, 0);
      // Numbers that overflow have no lowest place.
      if (all.empty()) return Approach{0, kNaN, true};
      return *std::min_element(all.begin(), all.end(),
                               [](const Approach& a, const Approach& b) {
                                 return a.distance_mm < b.distance_mm;
                               });
    };
    Approach touch = deepest(pose);
    if (std::isnan(touch.distance_mm))
      return ObjectContactStatus::kNotConverged;
    ObjectPose withdrawn = pose;
    if (touch.distance_mm >= deepest_) {
      const Vector2d inwards =
          InnerWay(free.SurfaceAt(Side::kFront, touch.arc_mm), pose);
      if (inwards.isZero()) return ObjectContactStatus::kNoContact;
      withdrawn.position_mm -= inwards;
      touch = deepest(withdrawn);
    }
    // An object that is held and covers the clamped base cannot yield.
    const Section base = free.SurfaceAt(Side::kFront, 0);
    if (!object_.spring &&
        object_.outline.DistanceOf({base.x_mm, base.y_mm}, pose).distance_mm <
            deepest_) {
      return ObjectContactStatus::kNoTangency;
    }
    const double theta = free.At(Side::kFront, touch.arc_mm).theta_rad;
    const Vector2d outward(-std::sin(theta), std::cos(theta));
    for (int i = 0; i < kMaxWithdrawals; ++i) {
      if (touch.distance_mm >= -kTolerance * length_) break;
      // This cannot pass first touch, as the distance of no point grows faster.
      withdrawn.position_mm -= touch.distance_mm * outward;
      touch = deepest(withdrawn);
    }
    if (touch.at_end) return ObjectContactStatus::kNoTangency;

    const Vector2d way = pose.position_mm - withdrawn.position_mm;
    std::vector<PointContact> reached = {{touch.arc_mm, 0, friction_}};
    LadderState reached_state = solver_->state();
    const double longest_step = kLongestStep * length_ / way.norm();
    double fraction = 0, step = 1;
    while (fraction < 1) {
      step = std::min(step, longest_step);
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
        if (step < kSmallestRampStep ||
            tangency_.equilibria() > kMostEquilibria) {
          return EndsAreInside(moved, reached)
                     ? ObjectContactStatus::kNoTangency
                     : ObjectContactStatus::kNotConverged;
        }
      }
    }
    *contacts = reached;
    return ObjectContactStatus::kContact;
  }

  const RigidObject& object_;
  const double friction_;
  EquilibriumSolver* const solver_;
  const double length_;
  const double deepest_;  // A point at a smaller distance counts as inside.
  Tangency tangency_;
  std::vector<Approach> approaches_;
};

}  // namespace

ObjectContact SolveObjectContact(const RigidObject& object,
                                 const ObjectPose& pose, double friction,
                                 EquilibriumSolver* solver,
                                 const std::vector<PointContact>& guess) {
  return ObjectContactSolver(object, friction, solver).Solve(pose, guess);
}

}  // namespace finray
