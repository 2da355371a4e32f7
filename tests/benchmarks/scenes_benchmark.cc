// What each scene costs: unknowns of the equilibrium and time of a warm solve
// with the default scheme. What a scene leaves out is not there.
//
//   build/test/tests/scenes_benchmark

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "finray/objects/object_contact.h"
#include "test_finger.h"

namespace finray {
namespace {

Finger Changed(void (*change)(Finger*)) {
  Finger finger = PaperFinger();
  change(&finger);
  return finger;
}

// Along a log each contact moves by up to 0.06 mm, its force by up to
// 0.3 %.
std::vector<PointContact> Moved(std::vector<PointContact> contacts, int i) {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    contacts[c].arc_mm += 10 * std::sin(0.006 * i + c);
    contacts[c].normal_N *= 1 + 0.3 * std::cos(0.01 * i + c);
  }
  return contacts;
}

void Loads(benchmark::State& state, const Finger& finger,
           const std::vector<PointContact>& contacts) {
  EquilibriumSolver solver(finger, {});
  solver.set_tolerance(1e-6);
  std::vector<std::vector<PointContact>> frames;
  for (int i = 0; i < 1000; ++i) frames.push_back(Moved(contacts, i));
  solver.Solve(frames[0]);
  std::size_t i = 0;
  for (auto _ : state) {
    if (!solver.Solve(frames[i])) {
      state.SkipWithError("lost");
      break;
    }
    i = (i + 1) % frames.size();
  }
  state.counters["unknowns"] = solver.unknowns();
}

void Object(benchmark::State& state, const RigidObject& object) {
  EquilibriumSolver solver(PaperFinger(), {});
  solver.set_tolerance(1e-6);
  ObjectPose pose;
  ObjectContact contact;
  int i = 0;
  const auto move = [&] {
    pose.position_mm = {-16 + 1.5 * std::sin(0.006 * i),
                        70 + 10 * std::sin(0.004 * i)};
    ++i;
    contact = SolveObjectContact(object, pose, 0, &solver, contact.contacts);
    return contact.status == ObjectContactStatus::kContact;
  };
  move();
  for (auto _ : state) {
    if (!move()) {
      state.SkipWithError("lost");
      break;
    }
  }
  state.counters["unknowns"] = solver.unknowns() + 2. * contact.contacts.size();
}

void Register() {
  const std::vector<PointContact> one = {{70, 3, 0}};
  const auto loads = [](const char* name, const Finger& finger,
                        const std::vector<PointContact>& contacts) {
    benchmark::RegisterBenchmark(name, [=](benchmark::State& state) {
      Loads(state, finger, contacts);
    })->Unit(benchmark::kMicrosecond);
  };
  const Finger paper = PaperFinger();
  loads("one_contact_no_ribs",
        Changed([](Finger* finger) { finger->ribs.clear(); }), {{70, 0.5, 0}});
  loads("one_contact", paper, one);
  loads("one_contact_friction", paper, {{70, 3, 0.3}});
  loads("one_contact_back_beam", paper, {{70, 3, 0, Side::kBack}});
  loads("two_contacts", paper, {{45, 2, 0}, {95, 2, 0}});
  loads("four_contacts", paper,
        {{30, 1, 0}, {55, 1, 0}, {80, 1, 0}, {105, 1, 0}});
  loads("elastic_ribs", Changed([](Finger* finger) {
          for (Rib& rib : finger->ribs) rib.axial_stiffness_N = 2e3;
        }),
        one);
  loads("stretching_beams", Changed([](Finger* finger) {
          finger->front_axial_stiffness_N = 2e5;
          finger->back_axial_stiffness_N = 2e5;
        }),
        one);
  loads("three_pieces_a_beam", Changed([](Finger* finger) {
          finger->front_pieces = {{45, 1}, {90, 0.8}, {140, 0.6}};
          finger->back_pieces = {{50, 1}, {100, 0.8}, {151, 0.6}};
          finger->back_pieces.back().end_mm =
              finger->front_length_mm / std::sin(finger->back_angle_rad);
        }),
        one);
  const auto object = [](const char* name, const Outline& outline,
                         std::optional<ObjectSpring> spring) {
    benchmark::RegisterBenchmark(name, [=](benchmark::State& state) {
      Object(state, RigidObject{outline, spring});
    })->Unit(benchmark::kMicrosecond);
  };
  object("circle", Outline(CircleOutline{20}), {});
  object("circle_on_spring", Outline(CircleOutline{20}), ObjectSpring{2, M_PI});
  object("ellipse", Outline(EllipseOutline{20, 30}), {});
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  finray::Register();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
