#ifndef FINRAY_BENCHMARK_BENCHMARK_CASE_H_
#define FINRAY_BENCHMARK_BENCHMARK_CASE_H_

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "finray/scene/scene.h"
#include "finray/sensing/packed_readings.h"

namespace finray {

// A case is a log along which a contact wanders and its force swells,
//
//   l_c = l_0 (1/2 + 2/7 sin(0.0015 i)),   f_c = F (4 + 3 cos(0.006 i)),
//
// F = 1 N on the paper's finger: up to 0.06 mm and 0.018 N from frame to frame.
// It is cut into stretches spread over the whole way, so that a solver too slow
// for all of it still sees all of the beam. Each begins with a lead-in frame,
// from which solvers start and which is not measured.

constexpr int kStretches = 16;
constexpr int kStretchFrames = 64;

/// What a solver says of a frame.
struct FrameAnswer {
  bool solved = false;
  std::vector<PointContact> contacts;
  Eigen::VectorXd gauges_rad;
  Eigen::Vector3d tip_pose = Eigen::Vector3d::Zero();  ///< mm, rad.
  int iterations = 0;
};

struct BenchmarkFrame {
  std::vector<PointContact> contacts;  ///< The load; with an object its answer.
  ObjectPose object;
  Measurements readings;       ///< With noise, in V.
  PackedReadings measurement;  ///< The same as ContactFit takes it.
};

struct BenchmarkCase {
  std::string scene_name;
  Finger finger;  ///< Its gauges have the noise of the case.
  Scene scene;
  std::vector<BenchmarkFrame> frames;
  /// What the finest discretization says of load and of readings.
  std::vector<FrameAnswer> forward, sensed;

  /// The lead-in of a stretch; its frames are those behind it.
  static int LeadIn(int stretch) { return stretch * (kStretchFrames + 1); }
};

/// The names of all scenes: no_contact, one_contact, two_contacts, friction,
/// circle.
const std::vector<std::string>& BenchmarkScenes();

/// Elements over both beams that make `a_bay` of them in each bay of equal
/// stiffness between ribs.
int ElementsFor(const Finger& finger, double a_bay);

/// The discretization that answers are compared with: order 16, eight elements
/// a bay.
Discretization ReferenceDiscretization(const Finger& finger);

/// Makes a case of `stretches` stretches. Throws std::runtime_error if the
/// finger has no equilibrium somewhere along the log.
BenchmarkCase MakeBenchmarkCase(const Finger& finger, const std::string& scene,
                                int stretches = kStretches);

/// The case of a scene. Throws std::logic_error if there is none.
const BenchmarkCase& CaseOf(const std::vector<BenchmarkCase>& cases,
                            std::string_view scene);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_BENCHMARK_CASE_H_
