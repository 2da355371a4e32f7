#include "finray/calib/weak_direction_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "finray/calib/identifiability.h"

namespace finray {
namespace {

// What the fitted logs have.
struct Contents {
  bool contacts = false, free_frames = false, force = false, place = false;
  double lowest_mm = 1e300, highest_mm = -1e300;
};

Contents Survey(const CalibrationProblem& problem) {
  Contents has;
  const auto& frames = problem.logs().frames;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CalibrationFrame& frame = frames[i];
    if (frame.held_out || frame.IsBench()) continue;
    (frame.contact ? has.contacts : has.free_frames) = true;
    if (!frame.contact) continue;
    has.force |= std::isfinite(frame.force_N) || frame.force_xy_N.allFinite();
    has.place |= frame.object_mm.allFinite() || std::isfinite(frame.contact_mm);
    const double arc = problem.contact(static_cast<int>(i))[0];
    if (std::isfinite(arc)) {
      has.lowest_mm = std::min(has.lowest_mm, arc);
      has.highest_mm = std::max(has.highest_mm, arc);
    }
  }
  return has;
}

std::string Remedy(const CalibrationProblem& problem, const Contents& has) {
  const double length = problem.finger().front_length_mm;
  if (!has.contacts) return "record frames in which the finger is loaded";
  if (!has.force) {
    return "record the reference force (force_N); without it only ratios of "
           "stiffness show";
  }
  if (!has.place) {
    return "record where the object is (object_x_mm, object_y_mm) or where it "
           "touches (contact_1_mm), or fix the gauge gains from a bench test";
  }
  if (!has.free_frames) {
    return "record frames without contact; they fix the offsets";
  }
  if (has.highest_mm - has.lowest_mm < 0.3 * length) {
    return "record contacts at more heights along the finger";
  }
  return "record more frames with larger loads, spread over the finger, or "
         "give "
         "a tighter prior";
}

}  // namespace

void DescribeWeakDirection(CalibrationProblem& problem,
                           WeakDirection* direction) {
  double by_family[kParameterFamilies] = {};  // sum of squared shares
  double sign[kParameterFamilies] = {};
  bool one_sign[kParameterFamilies];
  std::fill(std::begin(one_sign), std::end(one_sign), true);
  const auto& all = problem.parameters().all();
  for (const auto& component : direction->components) {
    const int family = static_cast<int>(all[component.parameter].family);
    by_family[family] += component.share * component.share;
    if (sign[family] * component.share < 0) one_sign[family] = false;
    sign[family] = component.share;
  }
  const auto share = [&](ParameterFamily family) {
    return by_family[static_cast<int>(family)];
  };
  const auto same_sign = [&](ParameterFamily family) {
    return one_sign[static_cast<int>(family)];
  };
  const bool both_beams = share(ParameterFamily::kFrontStiffness) > 0.1 &&
                          share(ParameterFamily::kBackStiffness) > 0.1 &&
                          sign[0] * sign[1] > 0;
  const double beams = share(ParameterFamily::kFrontStiffness) +
                       share(ParameterFamily::kBackStiffness);
  const double gains = share(ParameterFamily::kGaugeGain);
  std::string words;
  if (both_beams && beams > 0.9) {
    words = "front and back stiffness and all forces scale together";
  } else if (both_beams && gains > 0.1 && beams + gains > 0.8 &&
             same_sign(ParameterFamily::kGaugeGain)) {
    words = "all gauge gains scale together against front and back stiffness";
  } else {
    for (const auto& component : direction->components) {
      char text[160];
      std::snprintf(text, sizeof text, "%s%s (%+.2f)",
                    words.empty() ? "" : ", ",
                    all[component.parameter].name.c_str(), component.share);
      words += text;
    }
    words =
        (direction->components.size() == 1 ? "alone: " : "together: ") + words;
  }
  direction->words = words;
  direction->remedy = Remedy(problem, Survey(problem));
}

}  // namespace finray
