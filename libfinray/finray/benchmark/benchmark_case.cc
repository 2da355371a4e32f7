#include "finray/benchmark/benchmark_case.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "finray/estimation/row_fit.h"
#include "finray/finger/geometry.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

constexpr double kNoise_rad = 1e-4;
// With 1e-4 rad four gauges cannot tell two contacts apart: many frames have
// several answers.
constexpr double kNoiseOfTwo_rad = 1e-5;
constexpr double kObjectStd_mm = 0.05;
constexpr double kFriction = 0.3;
constexpr int kFramesApart = 260;  // from stretch to stretch
constexpr double kPaperLength_mm = 140;
constexpr double kPaperForceUnit_N = 12500. / (140 * 140);

// Returns the contacts at step `i` of the path on the paper's finger.
std::vector<PointContact> ContactsAt(const std::string& scene, int i) {
  if (scene == "no_contact") return {};
  const double swing = std::sin(0.0015 * i), swell = std::cos(0.006 * i);
  if (scene == "two_contacts") {
    return {{45 + 10 * swing, 2 + 0.6 * swell, 0},
            {95 + 8 * std::sin(0.0015 * i + 1), 2 - 0.6 * swell, 0}};
  }
  return {
      {70 + 40 * swing, 4 + 3 * swell, scene == "friction" ? kFriction : 0}};
}

ObjectPose CircleAt(int i) {
  ObjectPose pose;
  pose.position_mm = {-16 + 1.5 * std::sin(0.006 * i),
                      70 + 10 * std::sin(0.004 * i)};
  return pose;
}

Scene SceneOf(const std::string& name, double scale) {
  Scene scene;
  if (name == "no_contact") return scene;  // contacts: auto
  scene.contacts = name == "two_contacts" ? 2 : 1;
  if (name == "friction") scene.friction_coefficient = kFriction;
  if (name == "circle") {
    scene.object = RigidObject{Outline(CircleOutline{20 * scale}), {}};
    scene.object_std_mm = kObjectStd_mm;
  }
  return scene;
}

FrameAnswer AnswerOf(const EquilibriumSolver& solver,
                     const std::vector<PointContact>& contacts) {
  return {true, contacts, solver.outputs().head(solver.model().gauges()),
          solver.tip_pose(), solver.iterations()};
}

[[noreturn]] void Fail(const BenchmarkCase& c, int frame, const char* what) {
  throw std::runtime_error("benchmark: " + c.finger.name + ", " + c.scene_name +
                           ", frame " + std::to_string(frame) + ": " + what);
}

}  // namespace

int ElementsFor(const Finger& finger, double a_bay) {
  const int bays = MakeBeamMesh(finger, Side::kFront, 1).elements() +
                   MakeBeamMesh(finger, Side::kBack, 1).elements();
  return static_cast<int>(std::lround(a_bay * bays));
}

Discretization ReferenceDiscretization(const Finger& finger) {
  return {Scheme::kTaylor, ElementsFor(finger, 8)};
}

PointContact WanderingContact(const Finger& finger, int i) {
  PointContact contact = ContactsAt("one_contact", i)[0];
  contact.arc_mm *= finger.front_length_mm / kPaperLength_mm;
  contact.normal_N *= ForceUnit(finger) / kPaperForceUnit_N;
  return contact;
}

BenchmarkCase MakeBenchmarkCase(const Finger& finger, const std::string& scene,
                                int stretches) {
  BenchmarkCase c;
  c.scene_name = scene;
  c.finger = finger;
  c.finger.calibration.reset();  // its uncertainty would only add to std
  const double noise = scene == "two_contacts" ? kNoiseOfTwo_rad : kNoise_rad;
  for (Gauge& gauge : c.finger.gauges) {
    gauge.noise_V = noise * std::abs(gauge.gain_V_per_rad);
  }
  const double length = finger.front_length_mm / kPaperLength_mm;
  const double force = ForceUnit(finger) / kPaperForceUnit_N;
  c.scene = SceneOf(scene, length);

  const Discretization finest = ReferenceDiscretization(finger);
  EquilibriumSolver solver(c.finger, finest);
  RowFit fit(c.finger, c.scene, finest, nullptr,
             std::numeric_limits<double>::infinity());
  const bool fitted = !finger.gauges.empty() && c.scene.contacts.has_value();
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  ObjectContact touch;
  for (int k = 0; k < stretches * (kStretchFrames + 1); ++k) {
    const int i =
        k / (kStretchFrames + 1) * kFramesApart + k % (kStretchFrames + 1);
    BenchmarkFrame frame;
    if (c.scene.object) {
      frame.object = CircleAt(i);
      frame.object.position_mm *= length;
      touch = SolveObjectContact(*c.scene.object, frame.object, 0, &solver,
                                 touch.contacts);
      if (touch.status != ObjectContactStatus::kContact ||
          touch.contacts.size() != 1) {
        Fail(c, k, "the circle does not touch at one point");
      }
      frame.contacts = touch.contacts;
    } else {
      frame.contacts = ContactsAt(scene, i);
      for (PointContact& contact : frame.contacts) {
        contact.arc_mm *= length;
        contact.normal_N *= force;
      }
      if (!solver.Solve(frame.contacts)) Fail(c, k, solver.Why().c_str());
    }
    c.forward.push_back(AnswerOf(solver, frame.contacts));

    const Eigen::VectorXd& gauges = c.forward.back().gauges_rad;
    for (Eigen::Index j = 0; j < gauges.size(); ++j) {
      frame.readings.gauges_V.push_back(
          finger.gauges[j].Volts(gauges[j] + noise * normal(generator)));
    }
    if (c.scene.object_std_mm) {
      for (int i = 0; i < 2; ++i) {
        frame.readings.object_mm[i] =
            frame.object.position_mm[i] + kObjectStd_mm * normal(generator);
      }
    }
    Pack(c.finger, c.scene, frame.readings, &frame.measurement);
    if (fitted) {
      EquilibriumSolver model(c.finger, finest);
      ContactSolution found;
      fit.set_row(frame.readings);
      const bool fits = fit.FitFrom(frame.contacts, &model, &found);
      const std::vector<PointContact> contacts(
          found.contacts.begin(), found.contacts.begin() + found.count);
      if (!fits || !model.Solve(contacts)) {
        Fail(c, k, "the gauges' least squares are not found");
      }
      c.sensed.push_back(AnswerOf(model, contacts));
    } else {
      // Without a contact the free finger is the answer.
      c.sensed.push_back(c.forward.back());
    }
    c.frames.push_back(std::move(frame));
  }
  return c;
}

const BenchmarkCase& CaseOf(const std::vector<BenchmarkCase>& cases,
                            std::string_view scene) {
  for (const BenchmarkCase& c : cases) {
    if (c.scene_name == scene) return c;
  }
  throw std::logic_error("no case of scene " + std::string(scene));
}

}  // namespace finray
