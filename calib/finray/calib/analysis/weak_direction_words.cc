#include "finray/calib/analysis/weak_direction_words.h"

#include <algorithm>
#include <cmath>

#include "finray/calib/analysis/identifiability.h"
#include "finray/io/number_text.h"

namespace finray {

void DescribeWeakDirection(CalibrationProblem& problem,
                           WeakDirection* direction) {
  double by_family[kParameterFamilies] = {};  // sums of squared shares
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
    words = kGainsAgainstStiffness;
  } else {
    for (const auto& component : direction->components) {
      words +=
          FormatText("%s%s (%+.2f)", words.empty() ? "" : ", ",
                     all[component.parameter].name.c_str(), component.share);
    }
    words =
        (direction->components.size() == 1 ? "alone: " : "together: ") + words;
  }
  direction->words = words;
  direction->how_far =
      direction->null
          ? "the data do not say how far"
          : FormatText("the data leave a std of %.3g times the prior's",
                       direction->std_over_prior);
}

}  // namespace finray
