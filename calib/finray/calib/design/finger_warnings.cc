#include <algorithm>
#include <cmath>
#include <utility>

#include "finray/calib/design/finger_check.h"
#include "finray/finger/geometry.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// People make flexures from soft rubber to steel, from foil to a block.
constexpr double kSoftest_GPa = 1e-3, kStiffest_GPa = 250;
constexpr double kThinnest_mm = 0.05;
// A beam that is thicker than this share of its length also shears.
constexpr double kThickest = 0.05;
constexpr double kLeastBackAngle_deg = 95, kMostBackAngle_deg = 145;
constexpr double kSteepestRib_deg = 60;
// Ribs nearly cross where they come closer than this share of the finger.
constexpr double kLeastRibGap = 0.02;
constexpr double kMostPrestress = 0.02;  // of the rib's length
constexpr double kMostStiffnessRatio = 30;
// Loads of EI / l_0^2 that no force sensor of a lab sees, or no hand presses.
constexpr double kLeastUnit_N = 1e-3, kMostUnit_N = 100;
constexpr double kCoarseNoise_rad = 5e-3;

class WarningList {
 public:
  explicit WarningList(std::vector<Warning> list = {})
      : list_(std::move(list)) {}
  void Add(const char* code, const std::string& text,
           const std::string& remedy) {
    list_.push_back({code, text, remedy});
  }
  std::vector<Warning> Take() { return std::move(list_); }

 private:
  std::vector<Warning> list_;
};

void CheckPlates(const Finger& finger, const std::vector<WrittenPlate>& plates,
                 WarningList* list) {
  for (const WrittenPlate& plate : plates) {
    const std::string name = plate.name + ": ";
    if (plate.youngs_modulus_GPa > kStiffest_GPa ||
        plate.youngs_modulus_GPa < kSoftest_GPa) {
      list->Add("modulus",
                name + FormatText("a modulus of %g GPa; no strip has %s",
                                  plate.youngs_modulus_GPa,
                                  plate.youngs_modulus_GPa > kStiffest_GPa
                                      ? "more than 250 GPa"
                                      : "less than 0.001 GPa"),
                "is it in MPa? The key is in GPa: steel 200, carbon 60 to 150, "
                "PETG 2, TPU 0.03");
    }
    const double length = BeamLength(finger, plate.side);
    if (plate.thickness_mm > kThickest * length) {
      list->Add("thickness",
                name + FormatText("%g mm thick is %.0f %% of its length",
                                  plate.thickness_mm,
                                  100 * plate.thickness_mm / length),
                "the model neglects shear, which such a beam shows; are all "
                "lengths in mm?");
    } else if (plate.thickness_mm < kThinnest_mm) {
      list->Add(
          "thickness",
          name + FormatText("%g mm is thinner than foil", plate.thickness_mm),
          "is it in m? thickness_mm is in mm, and stiffness goes with its "
          "cube");
    }
    if (plate.width_mm < plate.thickness_mm) {
      list->Add("width",
                name + FormatText("%g mm wide and %g mm thick", plate.width_mm,
                                  plate.thickness_mm),
                "thickness_mm is measured in the plane of the finger, width_mm "
                "across it; are they exchanged?");
    }
  }
}

void CheckStiffness(const Finger& finger, WarningList* list) {
  const double ratio =
      finger.front_stiffness_N_mm2 / finger.back_stiffness_N_mm2;
  if (std::max(ratio, 1 / ratio) > kMostStiffnessRatio) {
    list->Add("stiffness_ratio",
              FormatText("one beam is %.0f times as stiff as the other",
                         std::max(ratio, 1 / ratio)),
              "check both stiffnesses; E w t^3 / 12 in N mm^2");
  }
  const double unit_N = ForceUnit(finger);
  if (unit_N < kLeastUnit_N || unit_N > kMostUnit_N) {
    list->Add("stiffness",
              FormatText("a force of %.2g N bends the finger by about its "
                         "own length (EI / l_0^2)",
                         unit_N),
              "check the bending stiffness: N mm^2, not N m^2 (1e6 times as "
              "much)");
  }
}

void CheckLimit(const FingerCheck& figures, WarningList* list) {
  if (figures.limit.folds) {
    list->Add("folds",
              FormatText("the finger folds over at %.3g N at %g mm",
                         figures.limit.force_N, figures.limit.contact_mm),
              "keep forces below it: force_max_N of the scene");
  }
}

void CheckAngles(const Finger& finger, const FingerCheck& figures,
                 WarningList* list) {
  const double back_deg = finger.back_angle_rad / kDegree;
  if (back_deg < kLeastBackAngle_deg || back_deg > kMostBackAngle_deg) {
    list->Add(
        "back_angle",
        FormatText("back_angle_deg %.4g makes a base of %.3g mm for a "
                   "finger of %g mm",
                   back_deg, figures.back_base_mm, finger.front_length_mm),
        "it is the direction of the back beam from +x; 100 to 130 is "
        "usual");
  }
  for (std::size_t i = 0; i < figures.ribs.size(); ++i) {
    const RibFigures& rib = figures.ribs[i];
    if (std::abs(rib.angle_deg) > kSteepestRib_deg) {
      list->Add("rib_angle",
                FormatText("rib %zu leaves the front beam at %.0f deg", i + 1,
                           rib.angle_deg),
                "check angle_deg or back_mm; back_mm counts from the base of "
                "the back beam");
    }
  }
}

// The least distance of two segments that do not cross lies at an end of one.
double PointToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                      const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double share =
      std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - share * along).norm();
}

void CheckRibs(const Finger& finger, const FingerCheck& figures,
               WarningList* list) {
  const auto front = [&](std::size_t i) {
    return UndeformedPoint(finger, Side::kFront, finger.ribs[i].front_mm);
  };
  const auto back = [&](std::size_t i) {
    return UndeformedPoint(finger, Side::kBack, finger.ribs[i].back_mm);
  };
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    const RibFigures& rib = figures.ribs[i];
    if (std::abs(rib.length_mm / rib.nominal_mm - 1) > kMostPrestress) {
      list->Add("prestress",
                FormatText("rib %zu is %.4g mm long in a gap of %.4g mm and "
                           "carries %.3g N at rest",
                           i + 1, rib.length_mm, rib.nominal_mm, rib.tension_N),
                "without length_mm a rib fits its gap");
    }
    if (i == 0) continue;
    const double gap =
        std::min({PointToSegment(front(i), front(i - 1), back(i - 1)),
                  PointToSegment(back(i), front(i - 1), back(i - 1)),
                  PointToSegment(front(i - 1), front(i), back(i)),
                  PointToSegment(back(i - 1), front(i), back(i))});
    if (gap < kLeastRibGap * finger.front_length_mm) {
      list->Add("ribs_close",
                FormatText("ribs %zu and %zu nearly cross: they come within "
                           "%.2g mm",
                           i, i + 1, gap),
                "check front_mm and angle_deg of both");
    }
  }
  if (finger.ribs.empty()) {
    list->Add("no_ribs", "the finger has no ribs",
              "list them under `ribs:`, from base to tip");
  }
}

void CheckGauges(const Finger& finger, const FingerCheck& figures,
                 WarningList* list) {
  const std::vector<Gauge>& gauges = finger.gauges;
  if (gauges.size() < 2) {
    list->Add("few_gauges",
              FormatText("%zu gauge%s cannot tell place and force of a contact",
                         gauges.size(), gauges.size() == 1 ? "" : "s"),
              "a contact takes two gauges, two contacts take four");
  }
  for (std::size_t j = 0; j < gauges.size(); ++j) {
    const Gauge& gauge = gauges[j];
    const double end_mm = gauge.start_mm + gauge.length_mm;
    for (std::size_t k = 0; k < j; ++k) {
      const Gauge& other = gauges[k];
      if (other.beam == gauge.beam && other.start_mm < end_mm &&
          gauge.start_mm < other.start_mm + other.length_mm) {
        list->Add("gauges_overlap",
                  FormatText("gauges %zu and %zu overlap on the %s beam", k + 1,
                             j + 1, SideName(gauge.beam)),
                  "start_mm counts from the base of its own beam");
      }
    }
    const double noise_rad = 1 / gauge.AngleWeight();
    if (noise_rad > kCoarseNoise_rad) {
      list->Add(
          "noise",
          FormatText("gauge %zu has a noise of %.2g rad", j + 1, noise_rad),
          "check noise_V (the std of one reading) and gain_V_per_rad");
    }
    double most = 0;
    for (const HeightFigures& at : figures.heights) {
      most = std::max(most, std::abs(at.angle_rad_per_N[j]));
    }
    // At a usual load, ten times EI / l_0^2.
    if (most * 10 * figures.force_unit_N < 10 * noise_rad) {
      list->Add("gauge_deaf",
                FormatText("gauge %zu turns by %.2g rad per N at most, and its "
                           "noise is %.2g rad",
                           j + 1, most, noise_rad),
                "move it, or record with less noise");
    }
  }
  const bool as_delivered =
      !gauges.empty() &&
      std::all_of(gauges.begin(), gauges.end(), [](const Gauge& gauge) {
        return gauge.gain_V_per_rad == 1 && gauge.offset_V == 0;
      });
  if (as_delivered && !finger.calibration) {
    list->Add("uncalibrated",
              "all gains are 1 V per rad and all offsets 0: nobody has "
              "calibrated these gauges",
              "calibrate the finger before it senses");
  }
}

}  // namespace

std::vector<Warning> StiffnessWarnings(
    const Finger& finger, const std::vector<WrittenPlate>& plates) {
  WarningList list;
  CheckPlates(finger, plates, &list);
  CheckStiffness(finger, &list);
  return list.Take();
}

std::vector<Warning> FingerWarnings(const Finger& finger,
                                    const std::vector<WrittenPlate>& plates,
                                    const FingerCheck& figures) {
  WarningList list(StiffnessWarnings(finger, plates));
  CheckLimit(figures, &list);
  CheckAngles(finger, figures, &list);
  CheckRibs(finger, figures, &list);
  CheckGauges(finger, figures, &list);
  return list.Take();
}

}  // namespace finray
