// Where sensing and calibration stop holding: noise, quantisation, offsets,
// gains, gauges twice or dead, places, forces, stiffness, units and starts far
// from the usual. The tables of docs/evidence/extremes.md.
//
//   extremes_study [TABLES [FRAMES [LOGS]]]
//
// TABLES: how the names of those to be printed begin, such as sensing or
// calibration/offsets (all but slow, which takes minutes a row); FRAMES at each
// of 18 places (50); LOGS of each calibration (1).

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "studies/calibration_extremes_tables.h"
#include "studies/sensing_extremes_tables.h"

int main(int argc, char** argv) {
  using namespace finray;
  const std::string which = argc > 1 ? argv[1] : "";
  const int frames = argc > 2 ? std::atoi(argv[2]) : 50;
  const int logs = argc > 3 ? std::atoi(argv[3]) : 1;
  const std::vector<std::pair<std::string, std::function<void()>>> tables = {
      {"sensing/noise", [=] { NoiseTable(frames); }},
      {"sensing/quantised", [=] { QuantisedTable(frames); }},
      {"sensing/offsets", [=] { OffsetTable(frames); }},
      {"sensing/units", [=] { UnitsTable(frames); }},
      {"sensing/gauges", [=] { LayoutTable(frames); }},
      {"sensing/places", [=] { PlacesTable(frames); }},
      {"sensing/condition", [] { ConditionTable(); }},
      {"calibration/noise", [=] { CalibrationNoiseTable(logs); }},
      {"calibration/quantised", [=] { CalibrationQuantisedTable(logs); }},
      {"calibration/offsets", [=] { CalibrationOffsetTable(logs); }},
      {"calibration/gains", [=] { CalibrationGainTable(logs); }},
      {"calibration/gauges", [=] { CalibrationLayoutTable(logs); }},
      {"calibration/starts", [=] { CalibrationStartTable(logs); }},
      {"calibration/units", [] { CalibrationUnitsTable(); }},
      {"slow/calibration", [] { CalibrationSlowTable(); }},
  };
  for (const auto& [name, print] : tables) {
    if (name.compare(0, which.size(), which) != 0) continue;
    if (which.empty() && name.compare(0, 4, "slow") == 0) continue;
    std::printf("\n## %s\n\n", name.c_str());
    print();
  }
  return 0;
}
