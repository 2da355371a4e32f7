#ifndef FINRAY_CONTROL_PLANT_H_
#define FINRAY_CONTROL_PLANT_H_

#include <deque>
#include <random>
#include <string>
#include <vector>

#include "finray/control/drive.h"
#include "finray/finger/finger.h"
#include "finray/objects/object_contact.h"
#include "finray/scene/measurements.h"

namespace finray {

/// The std by which a finger differs from its model. The errors are normal and
/// independent.
struct ModelError {
  double stiffness_percent = 0;  ///< of each beam's EI
  double gauge_gain_percent = 0;
  double gauge_offset_V = 0;
  double rib_length_mm = 0;
};

/// `finger` with errors drawn from `generator`.
Finger Perturbed(const Finger& finger, const ModelError& error,
                 std::mt19937_64* generator);

/// The place of the object before the loop starts: its origin at the height
/// y_mm, its outline at the distance gap_mm from the undeformed front beam.
struct ObjectStart {
  double y_mm = 0;
  double angle_rad = 0;
  double gap_mm = 1;
};

/// One finger of the plant at an equilibrium.
struct PlantFinger {
  Measurements readings;       ///< of its gauges, without noise
  ObjectPose object;           ///< in its frame S, without the spring's way
  double displacement_mm = 0;  ///< of an object on a spring
  std::vector<PointContact> contacts;
  Eigen::Vector2d force_N = Eigen::Vector2d::Zero();  ///< in the world
};

struct PlantState {
  std::string failure;  ///< Why there is no equilibrium; empty if there is one.
  std::vector<PlantFinger> fingers;
  /// The magnitude of a finger's force, as a sensor in the object reads it; the
  /// mean of two fingers.
  double force_N = 0;
};

/// The true world of a control loop. It turns the position of the drive and the
/// place of the object into contact forces and gauge readings, by equilibria of
/// the true fingers.
///
/// Between two fingers the object shifts along x by the d that balances the
/// forces,
///
///   F_1x(x + d) = F_2x(x - d),
///
/// while its y and its angle are held. It does not shift while no finger
/// touches.
class Plant {
 public:
  /// Takes as many fingers as the mechanism has, and the object's place at
  /// drive 0. Throws std::invalid_argument for an object on a spring between
  /// two fingers.
  Plant(const std::vector<Finger>& fingers, const Mechanism& mechanism,
        const RigidObject& object, double friction, const ObjectStart& start);

  /// The state with the object moved by `motion_mm` towards the (first) finger.
  PlantState At(double drive, double motion_mm);

 private:
  struct TrueFinger {
    EquilibriumSolver solver;
    std::vector<PointContact> contacts;  // at the last equilibrium
  };

  bool Solve(std::size_t finger, double drive, double x_mm, PlantState* state);
  bool Balance(double drive, double motion_mm, PlantState* state);

  std::deque<TrueFinger> fingers_;
  Mechanism mechanism_;
  RigidObject object_;
  double friction_;
  ObjectPose start_;  // of the object in the world
  double shift_mm_ = 0;
  double slope_N_per_mm_ = 1;  // of the difference of forces over the shift
};

}  // namespace finray

#endif  // FINRAY_CONTROL_PLANT_H_
