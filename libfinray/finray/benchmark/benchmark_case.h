#ifndef FINRAY_BENCHMARK_BENCHMARK_CASE_H_
#define FINRAY_BENCHMARK_BENCHMARK_CASE_H_

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "finray/estimation/packed_readings.h"
#include "finray/scene/scene.h"

namespace finray {

// A case is a simulated log. Along it a contact wanders and its force swells,
//
//   l_c = l_0 (1/2 + 2/7 sin(0.0015 i)),   f_c = F (4 + 3 cos(0.006 i)),
//
// with F = 1 N on the paper's finger, so that frames differ by up to 0.06 mm
// and 0.018 N from the one before. The log consists of stretches from all of
// this path, so that a slow solver, which gets a few frames of each, meets the
// whole beam too. Each stretch begins with a lead-in frame. Solvers start from
// it, and it is not measured.

constexpr int kStretches = 16;
constexpr int kStretchFrames = 64;

/// A solver's answer to a frame.
struct FrameAnswer {
  bool solved = false;
  std::vector<PointContact> contacts;
  Eigen::VectorXd gauges_rad;
  Eigen::Vector3d tip_pose = Eigen::Vector3d::Zero();  ///< mm, rad.
  int iterations = 0;
};

struct BenchmarkFrame {
  std::vector<PointContact> contacts;  ///< The true ones.
  ObjectPose object;
  Measurements readings;       ///< With noise, in V.
  PackedReadings measurement;  ///< The same, in rad and mm.
};

struct BenchmarkCase {
  std::string scene_name;
  Finger finger;  ///< With the gauge noise of the case.
  Scene scene;
  std::vector<BenchmarkFrame> frames;
  /// The answers of the finest discretization: to the load, and to the
  /// readings.
  std::vector<FrameAnswer> forward, sensed;

  int stretches() const {
    return static_cast<int>(frames.size()) / (kStretchFrames + 1);
  }
  /// Index of the lead-in of the k-th of `some` stretches, which are spread
  /// over the whole log. The frames of the stretch follow it.
  int LeadIn(int k, int some) const {
    return k * stretches() / some * (kStretchFrames + 1);
  }
};

constexpr const char* kBenchmarkScenes[] = {
    "no_contact", "one_contact", "two_contacts", "friction", "circle"};

/// Returns the number of elements over both beams that puts `a_bay` of them
/// into every bay.
int ElementsFor(const Finger& finger, double a_bay);

/// Returns the discretization of the reference: order 16, eight elements a bay.
Discretization ReferenceDiscretization(const Finger& finger);

/// Returns the contact of `one_contact` at step `i` of the path above.
PointContact WanderingContact(const Finger& finger, int i);

/// Makes a case of `stretches` stretches. Throws std::runtime_error if the
/// finger has no equilibrium somewhere along the log.
BenchmarkCase MakeBenchmarkCase(const Finger& finger, const std::string& scene,
                                int stretches = kStretches);

/// Returns the case of a scene. Throws std::logic_error if there is none.
const BenchmarkCase& CaseOf(const std::vector<BenchmarkCase>& cases,
                            std::string_view scene);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_BENCHMARK_CASE_H_
