// Does every frame find its contact from a cold start? Readings without noise,
// std as of 3e-4 rad, l_c 10..135 mm, f_c 0.05..10 N of the paper's finger: a
// grid of 126 x 60 and 10000 at random (log-uniform force, seed 1), with one
// contact known to be there and with "auto". Then other fingers and gauges,
// with place and force in the same proportion to l_0 and EI / l_0^2.
//
//   build/test/tests/cold_start_study

#include <cstdio>

#include "studies/cold_start.h"
#include "test_finger.h"

namespace finray {
namespace {

const Finger kPaper = PaperFinger();

double ForceUnit(const Finger& finger) {
  return finger.front_stiffness_N_mm2 / std::pow(finger.front_length_mm, 2);
}

void PrintHead(const char* first) {
  std::printf(
      "\n| %s | frames | right | unobservable | no_contact | another place "
      "within 1 std | wrong | 4 std off, std below 5 %% of l_0 "
      "|\n|---|---|---|---|---|---|---|---|\n",
      first);
}

void PrintLine(const char* name, const ColdStartTally& tally) {
  std::printf("| %s | %d | %d | %d | %d | %d | %d | %d |\n", name, tally.frames,
              tally.right, tally.unobservable, tally.no_contact,
              tally.ambiguous, tally.wrong, tally.sure_and_wrong);
  std::fflush(stdout);
}

// Grid and random contacts, by region of place and force.
struct Regions {
  static constexpr double kPlaces_mm[] = {10, 25, 108, 135};
  static constexpr double kForces_N[] = {0.05, 0.3, 2, 10};
  ColdStartTally at[3][3];

  void Add(double arc_mm, double force_N, const ColdStartTally& tally) {
    const int place = (arc_mm > kPlaces_mm[1]) + (arc_mm > kPlaces_mm[2]);
    const int force = (force_N > kForces_N[1]) + (force_N > kForces_N[2]);
    at[place][force].Add(tally);
  }
};

Regions Run(const Finger& finger, std::optional<int> contacts, int places,
            int forces, int random) {
  Scene scene;
  scene.contacts = contacts;
  ColdStart start(finger, scene);
  Regions regions;
  const double length = finger.front_length_mm / kPaper.front_length_mm;
  const double unit = ForceUnit(finger) / ForceUnit(kPaper);
  const auto add = [&](double place, double force) {
    regions.Add(place, force, start.Run(place * length, force * unit));
  };
  for (int i = 0; i < places; ++i) {
    for (int j = 0; j < forces; ++j) {
      add(10 + 125.0 * i / (places - 1),
          0.05 * std::pow(200, j / (forces - 1.0)));
    }
  }
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < random; ++i) {
    const double place = 10 + 125 * uniform(generator);
    add(place, 0.05 * std::pow(200, uniform(generator)));
  }
  return regions;
}

ColdStartTally Sum(const Regions& regions) {
  ColdStartTally sum;
  for (const auto& row : regions.at) {
    for (const ColdStartTally& tally : row) sum.Add(tally);
  }
  return sum;
}

void PrintRegions(const char* name, std::optional<int> contacts) {
  PrintHead(name);
  const Regions regions = Run(kPaper, contacts, 126, 60, 10000);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      char region[64];
      std::snprintf(region, sizeof(region), "%g..%g mm, %g..%g N",
                    Regions::kPlaces_mm[i], Regions::kPlaces_mm[i + 1],
                    Regions::kForces_N[j], Regions::kForces_N[j + 1]);
      PrintLine(region, regions.at[i][j]);
    }
  }
  PrintLine("all", Sum(regions));
}

Finger WithGauges(std::vector<std::pair<Side, double>> starts) {
  Finger finger = kPaper;
  finger.gauges.clear();
  for (const auto& [side, start] : starts) {
    finger.gauges.push_back({side, start, 18, 1, 0, 3e-4});
  }
  return finger;
}

void PrintOthers() {
  constexpr Side f = Side::kFront, b = Side::kBack;
  const std::vector<std::pair<const char*, Finger>> fingers = {
      {"printed_100mm: 2 back, 1 front",
       ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/printed_100mm.yaml")},
      {"2 back", WithGauges({{b, 30}, {b, 76}})},
      {"3 back", WithGauges({{b, 30}, {b, 53}, {b, 98}})},
      {"6 back",
       WithGauges({{b, 8}, {b, 30}, {b, 53}, {b, 76}, {b, 98}, {b, 120}})},
      {"4 front", WithGauges({{f, 18}, {f, 41}, {f, 63}, {f, 85}})},
      {"2 back, 2 front", WithGauges({{b, 30}, {b, 98}, {f, 18}, {f, 85}})},
      {"4 back, 4 front",
       ReadFinger(FINRAY_SOURCE_DIR
                  "/configs/fingers/paper_140mm_eight_gauges.yaml")},
  };
  PrintHead("finger, contacts: 1");
  for (const auto& [name, finger] : fingers) {
    PrintLine(name, Sum(Run(finger, 1, 64, 30, 2000)));
  }
}

}  // namespace
}  // namespace finray

int main() {
  finray::PrintRegions("paper_140mm, contacts: 1", 1);
  finray::PrintRegions("paper_140mm, contacts: auto", std::nullopt);
  finray::PrintOthers();
}
