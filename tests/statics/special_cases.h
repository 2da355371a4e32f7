#ifndef FINRAY_TESTS_STATICS_SPECIAL_CASES_H_
#define FINRAY_TESTS_STATICS_SPECIAL_CASES_H_

#include <string>
#include <vector>

#include "finray/ladder/ladder.h"
#include "test_finger.h"

namespace finray {

/// The paper's finger with every rib's length off nominal.
inline Finger PrestressedPaperFinger() {
  Finger finger = PaperFinger();
  const double error_mm[] = {0.3, -0.4, 0.5, -0.2, 0.25};
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    finger.ribs[i].length_mm += error_mm[i];
  }
  return finger;
}

/// A finger and what touches it.
struct Case {
  std::string name;
  Finger finger;
  std::vector<PointContact> contacts;
};

/// One contact over the whole beam and range of forces.
inline std::vector<Case> GridCases() {
  std::vector<Case> cases;
  for (double arc = 5; arc <= 135; arc += 5) {
    for (const double force : {0.05, 0.2, 1.0, 3.0, 8.0, 20.0}) {
      cases.push_back(
          {"l_c " + std::to_string(arc) + ", f_c " + std::to_string(force),
           PaperFinger(),
           {{arc, force, 0}}});
    }
  }
  return cases;
}

/// Friction, several contacts, ends, ribs, prestress, elastic ribs, unequal
/// beams, no ribs.
inline std::vector<Case> SpecialCases() {
  const Finger paper = PaperFinger();
  Finger elastic = PrestressedPaperFinger();
  elastic.ribs[1].axial_stiffness_N = 500;
  elastic.ribs[3].axial_stiffness_N = 80;
  Finger unequal = paper;
  unequal.front_stiffness_N_mm2 = 8000;
  unequal.back_stiffness_N_mm2 = 21000;
  unequal.gauges[0].beam = Side::kFront;
  Finger bare = paper;
  bare.ribs.clear();
  return {
      {"friction", paper, {{52.3, 4, 0.4}}},
      {"friction towards the base", paper, {{97, 6, -0.6}}},
      {"two contacts", paper, {{40.5, 3, 0.2}, {101, 2, -0.1}}},
      {"two contacts, listed from the tip", paper, {{101, 2, 0}, {20, 6, 0}}},
      {"two contacts in one element", paper, {{64, 2, 0}, {66.5, 3, 0.3}}},
      {"two contacts in one place", paper, {{70, 2, 0}, {70, 1, 0}}},
      {"on a rib", paper, {{61, 5, 0.1}}},
      {"at the base", paper, {{0, 5, 0}}},
      {"at the tip", paper, {{140, 3, 0.2}}},
      {"prestress alone", PrestressedPaperFinger(), {}},
      {"prestress and contact", PrestressedPaperFinger(), {{77, 4, 0.3}}},
      {"elastic ribs", elastic, {{50, 5, 0}}},
      {"unequal beams", unequal, {{88, 5, 0.2}}},
      {"no ribs", bare, {{60, 1, 0.1}}},
  };
}

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_SPECIAL_CASES_H_
