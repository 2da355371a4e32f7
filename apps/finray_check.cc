// Says what a finger YAML describes, draws it, and warns of what is
// implausible.

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "app.h"
#include "finger_picture.h"
#include "finray/calib/design/finger_check.h"
#include "finray/finger/geometry.h"
#include "finray/io/atomic_file.h"
#include "finray/io/number_text.h"

DEFINE_string(finger, "", "finger YAML");
DEFINE_string(out, "", "SVG to write: the finger to scale");
DEFINE_bool(strict, false, "exit code 4 if there is a warning");

namespace {

using namespace finray;

void PrintBeam(const Finger& finger, Side side) {
  std::printf("%s beam%s     %.6g mm", SideName(side),
              side == Side::kBack ? " " : "", BeamLength(finger, side));
  const auto& pieces = Pieces(finger, side);
  if (pieces.empty()) {
    std::printf(", EI %.6g N mm^2", BendingStiffness(finger, side));
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::printf("%s%.6g to %.4g mm", i == 0 ? ", EI in N mm^2: " : ", ",
                BendingStiffness(finger, side) * pieces[i].stiffness_ratio,
                pieces[i].end_mm);
  }
  if (std::isfinite(AxialStiffness(finger, side))) {
    std::printf(", EA %.4g N", AxialStiffness(finger, side));
  }
  if (side == Side::kBack) {
    std::printf(", base at x = %.6g mm, direction %.5g deg",
                BeamBase(finger, side).x(), BeamAngle(finger, side) / kDegree);
  }
  std::printf("\n");
}

// The last two columns of a rib.
std::string RibBendingText(const Rib& rib, double axial) {
  // Both columns start below their titles, whatever the one before is.
  const int gap = std::isfinite(axial)
                      ? 10 - static_cast<int>(FormatText("%.4g", axial).size())
                      : 5;
  if (!rib.Bends()) return FormatText("%*s%9s  -", gap, "", "rigid");
  return FormatText("%*s%9.5g  %.3g, %.3g", gap, "",
                    rib.bending_stiffness_N_mm2, rib.front_rigid_mm,
                    rib.back_rigid_mm);
}

void PrintRibs(const Finger& finger, const FingerCheck& check) {
  if (check.ribs.empty()) return;
  const bool bend = std::any_of(finger.ribs.begin(), finger.ribs.end(),
                                [](const Rib& rib) { return rib.Bends(); });
  std::printf(
      "rib   front_mm  back_mm  angle_deg  length_mm  gap_mm  "
      "at rest N  EA N%s\n",
      bend ? "      EI N mm^2  rigid ends mm" : "");
  for (std::size_t i = 0; i < check.ribs.size(); ++i) {
    const RibFigures& rib = check.ribs[i];
    const double axial = finger.ribs[i].axial_stiffness_N;
    std::printf(
        "%-4zu  %8.5g  %7.5g  %9.4g  %9.5g  %6.5g  %9.3g  %s", i + 1,
        rib.front_mm, rib.back_mm, rib.angle_deg, rib.length_mm, rib.nominal_mm,
        std::abs(rib.tension_N) < 1e-6 ? 0 : rib.tension_N,
        std::isfinite(axial) ? FormatText("%.4g", axial).c_str() : "rigid");
    if (bend) std::printf("%s", RibBendingText(finger.ribs[i], axial).c_str());
    std::printf("\n");
  }
}

void PrintGauges(const Finger& finger, const FingerCheck& check) {
  if (finger.gauges.empty()) return;
  std::printf("gauge  beam   from_mm  to_mm  V per rad  noise_rad");
  for (const HeightFigures& at : check.heights) {
    std::printf("  rad per N at %.3g mm", at.contact_mm);
  }
  std::printf("\n");
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    std::printf("%-5zu  %-5s  %7.5g  %5.5g  %9.4g  %9.2g", j + 1,
                SideName(gauge.beam), gauge.start_mm,
                gauge.start_mm + gauge.length_mm, gauge.gain_V_per_rad,
                1 / gauge.AngleWeight());
    for (const HeightFigures& at : check.heights) {
      std::printf("  %*.3g",
                  static_cast<int>(
                      FormatText("rad per N at %.3g mm", at.contact_mm).size()),
                  at.angle_rad_per_N[j]);
    }
    std::printf("\n");
  }
}

int Run() {
  const Finger finger = ReadFinger(Required("finger", FLAGS_finger));
  if (!FLAGS_out.empty()) {
    RefuseToOverwrite({FLAGS_finger}, {FLAGS_out});
    RefuseUnwritable(FLAGS_out);
    const std::string end = std::filesystem::path(FLAGS_out).extension();
    if (!end.empty() && end != ".svg") {
      throw InputError(FLAGS_out + ": the picture is an SVG, not " + end);
    }
  }
  const FingerCheck check =
      CheckFinger(finger, ReadPlates(FLAGS_finger), DiscretizationFlags());
  if (!FLAGS_out.empty()) {
    if (!DrawFinger(finger, FLAGS_out)) return kBadInput;
    std::printf("%s\n", FLAGS_out.c_str());
  }
  std::printf("finger         %s, %s\n", finger.name.c_str(),
              finger.calibration ? "calibrated" : "not calibrated");
  PrintBeam(finger, Side::kFront);
  PrintBeam(finger, Side::kBack);
  PrintRibs(finger, check);
  PrintGauges(finger, check);
  std::printf("stiffness     ");
  for (const HeightFigures& at : check.heights) {
    std::printf(" %.3g N per mm at %.3g mm%s", at.stiffness_N_per_mm,
                at.contact_mm, &at == &check.heights.back() ? "\n" : ",");
  }
  std::printf("limit load     %s %.3g N at %.3g mm\n",
              check.limit.folds ? "folds over at" : "none found up to",
              check.limit.force_N, check.limit.contact_mm);
  std::printf(
      "forces         %.2g N is easy (10 EI / l_0^2); estimates end at %.3g N "
      "(40 EI / l_0^2) unless the scene has force_max_N\n",
      10 * check.force_unit_N, 40 * check.force_unit_N);
  Warn(check.warnings);
  return FLAGS_strict && !check.warnings.empty() ? kGateFailed : kGood;
}

}  // namespace

const finray::App finray::kApp = {
    "Says what a finger YAML describes, draws it and warns of implausible "
    "numbers.\n"
    "finray_check --finger F.yaml [--out finger.svg]",
    Run};
