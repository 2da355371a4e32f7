// Where sensing and calibration stop holding: noise, quantisation, offsets,
// gains, gauges twice or dead, places, forces, stiffness, units and starts far
// from the usual. The tables of docs/extremes.md.
//
//   extremes_study [sensing|calibration|all [frames [seeds]]]
//
// `frames` at each of 18 places (200), logs of each calibration (2).

#include <cstdio>
#include <cstdlib>
#include <string>

#include "studies/calibration_extremes_tables.h"
#include "studies/sensing_extremes_tables.h"

int main(int argc, char** argv) {
  using namespace finray;
  const std::string what = argc > 1 ? argv[1] : "all";
  const int frames = argc > 2 ? std::atoi(argv[2]) : 200;
  const int seeds = argc > 3 ? std::atoi(argv[3]) : 2;
  if (what != "calibration") {
    std::printf("## Sensing, %d frames at each of 18 places\n", frames);
    NoiseTable(frames);
    QuantisedTable(frames);
    OffsetTable(frames);
    UnitsTable(frames);
    LayoutTable(frames);
    PlacesTable(frames);
    ConditionTable();
  }
  if (what != "sensing") {
    std::printf("\n## Calibration, worst of %d logs\n", seeds);
    CalibrationNoiseTable(seeds);
    CalibrationQuantisedTable(seeds);
    CalibrationOffsetTable(seeds);
    CalibrationLayoutTable(seeds);
    CalibrationStartTable(seeds);
    CalibrationUnitsTable();
  }
  return 0;
}
