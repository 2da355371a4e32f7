#ifndef FINRAY_CONTROL_PLANT_H_
#define FINRAY_CONTROL_PLANT_H_

#include <deque>
#include <string>
#include <vector>

#include "finray/control/mechanism.h"
#include "finray/finger/finger.h"
#include "finray/objects/object_contact.h"
#include "finray/scene/measurements.h"

namespace finray {

/// One finger of the plant at an equilibrium.
struct PlantFinger {
  Measurements readings;       ///< of its gauges, without noise
  ObjectPose object;           ///< where the object is given, in its frame S
  double displacement_mm = 0;  ///< of an object on a spring
  std::vector<PointContact> contacts;
  Eigen::Vector2d force_N = Eigen::Vector2d::Zero();  ///< on it, in the world
};

struct PlantState {
  std::string failure;  ///< Why there is no equilibrium; empty if there is one.
  std::vector<PlantFinger> fingers;
  /// What a sensor in the object reads: the magnitude of the force of a
  /// finger, of two the mean.
  double force_N = 0;
};

/// The true world of a control loop: a mechanism's drive and the object's place
/// to contact forces and gauges, by equilibria of the true fingers.
///
/// Between two fingers the object is free to shift along x by d, by which both
/// forces along x balance,
///
///   F_1x(x + d) = F_2x(x - d),
///
/// and held in y and turn. Nobody else holds it: it stays where it is while no
/// finger touches.
class Plant {
 public:
  /// One finger for each that the mechanism has. The object's shape is that
  /// where `gap_mm` is left to the undeformed front beam at drive 0, its origin
  /// at y_mm. Throws std::invalid_argument for an object on a spring between
  /// two fingers.
  Plant(const std::vector<Finger>& fingers, const Mechanism& mechanism,
        const RigidObject& object, double friction, double y_mm,
        double angle_rad, double gap_mm);

  /// With the object moved by `motion_mm` towards the (first) finger.
  PlantState At(double drive, double motion_mm);

 private:
  struct TrueFinger {
    EquilibriumSolver solver;
    std::vector<PointContact> contacts;  // the last ones
  };

  bool Solve(std::size_t finger, double drive, double x_mm, PlantState* state);
  bool Balance(double drive, double motion_mm, PlantState* state);

  std::deque<TrueFinger> fingers_;
  Mechanism mechanism_;
  RigidObject object_;
  double friction_;
  ObjectPose start_;  // of the object in the world
  double shift_mm_ = 0;
  double slope_N_per_mm_ = 1;  // of the difference of forces, by the shift
};

}  // namespace finray

#endif  // FINRAY_CONTROL_PLANT_H_
