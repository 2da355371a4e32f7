// Do errors follow the std that each frame reports, and are they as small as
// the gauges allow? The paper's finger, l_c 25..108 mm, f_c 0.5..8 N, gauge
// noise 1e-4 and 3e-4 rad, 2000 frames a cell, seed 1. Cells for which other
// places read alike are shown apart.
//
//   build/test/tests/coverage_study

#include <cstdio>

#include "studies/coverage.h"

namespace finray {
namespace {

constexpr int kRepeats = 2000;

void PrintLine(const char* name, const std::vector<CoverageCell>& cells,
               double length_mm) {
  ErrorTally arc, force;
  int used = 0, not_ok = 0;
  double worst = 1;
  std::vector<double> p_values;
  for (const CoverageCell& cell : cells) {
    if (!cell.local(length_mm)) continue;
    ++used;
    arc.Add(cell.arc);
    force.Add(cell.force);
    not_ok += cell.not_ok;
    p_values.insert(p_values.end(), cell.p_values.begin(), cell.p_values.end());
    for (const double spread : {cell.arc.spread(), cell.force.spread()}) {
      if (std::abs(spread - 1) > std::abs(worst - 1)) worst = spread;
    }
  }
  std::printf(
      "| %s | %d of %zu | %.1f, %.1f | %.1f, %.1f | %.3f, %.3f | %.3f | %.3f, "
      "%.3f | %.2f | %d |\n",
      name, used, cells.size(), 100 * arc.share_1(), 100 * arc.share_196(),
      100 * force.share_1(), 100 * force.share_196(), arc.spread(),
      force.spread(), worst, arc.bias(), force.bias(),
      KolmogorovSmirnov(p_values), not_ok);
}

void Run(double noise_rad) {
  const Finger finger = PaperFingerWithNoise(noise_rad);
  const std::vector<double> arcs = Range(25, 108, 12);
  const std::vector<double> forces = {0.5, 1, 1.5, 2, 3, 4, 6, 8};
  const std::vector<CoverageCell> cells =
      CoverageStudy(finger, arcs, forces, kRepeats, 1);
  const double length = finger.front_length_mm;
  std::printf("\ngauge noise %g rad\n\n", noise_rad);
  std::printf(
      "| l_c, mm | cells | l_c within 1, 1.96 std, %% | f_c within 1, 1.96 "
      "std, %% | spread over bound, l_c, f_c | worst cell | bias in std, l_c, "
      "f_c | KS of p | not ok |\n|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const auto first = cells.begin() + i * forces.size();
    char name[16];
    std::snprintf(name, sizeof(name), "%.1f", arcs[i]);
    PrintLine(name, {first, first + forces.size()}, length);
  }
  PrintLine("all", cells, length);
  std::printf(
      "\n| left out: l_c, mm | f_c, N | bounds, mm, N | distance of other "
      "places, std | l_c over 5 bounds off, %% | l_c within 1.96 std, %% | not "
      "ok, %% "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const CoverageCell& cell : cells) {
    if (cell.local(length)) continue;
    std::printf("| %.1f | %.1f | %.2f, %.3f | %.1f | %.2f | %.1f | %.1f |\n",
                cell.arc_mm, cell.force_N, cell.arc_bound_mm,
                cell.force_bound_N, cell.distance, 100.0 * cell.far / kRepeats,
                100 * cell.arc.share_196(), 100.0 * cell.not_ok / kRepeats);
  }
}

}  // namespace
}  // namespace finray

int main() {
  for (const double noise_rad : {1e-4, 3e-4}) finray::Run(noise_rad);
}
