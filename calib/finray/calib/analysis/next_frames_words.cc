#include <cmath>

#include "finray/calib/analysis/next_frames.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

struct Measurement {
  ResidualFamily family;
  const char* words;
  const char* columns;
};
constexpr Measurement kMeasurements[] = {
    {ResidualFamily::kForce, "the reference force", "force_N"},
    {ResidualFamily::kObject, "the object's centre",
     "object_x_mm, object_y_mm"},
    {ResidualFamily::kContact, "the contact location", "contact_1_mm"},
    {ResidualFamily::kPin, "the rib pins", "rib_<i>_front_x_mm, ..."},
    {ResidualFamily::kTip, "the tip", "tip_x_mm, tip_y_mm"},
};

// Returns words like "the reference force (force_N)".
std::string Spoken(ResidualFamily family) {
  for (const Measurement& measurement : kMeasurements) {
    if (measurement.family != family) continue;
    return std::string(measurement.words) + " (" + measurement.columns + ")";
  }
  return ResidualFamilyName(family);
}

// Returns words like "front stiffness": the name without its unit, which stands
// behind the number.
std::string Spoken(const CalibrationParameter& parameter) {
  std::string name = parameter.name;
  for (const char* suffix : {"_N_mm2", "_V_per_rad", "_V", "_mm"}) {
    const std::string end = suffix;
    if (name.size() > end.size() &&
        name.compare(name.size() - end.size(), end.size(), end) == 0) {
      name.resize(name.size() - end.size());
      break;
    }
  }
  for (char& c : name) c = c == '_' ? ' ' : c;
  return name;
}

// Says where the stage goes, as the logs count it.
std::string PlaceWords(const std::vector<Eigen::Vector2d>& object_mm) {
  if (object_mm.empty()) return "";
  const Eigen::Vector2d &first = object_mm.front(), &last = object_mm.back();
  if (object_mm.size() == 1) {
    return FormatText(" (object at %.1f, %.1f mm)", first.x(), first.y());
  }
  return FormatText(" (object from %.1f, %.1f to %.1f, %.1f mm)", first.x(),
                    first.y(), last.x(), last.y());
}

}  // namespace

std::string DescribeNextFrames(CalibrationProblem& problem,
                               const FrameAdvice& advice) {
  std::string words = std::to_string(FrameAdvice::kFrames) + " frames ";
  if (advice.known_gains) {
    words = "gauge gains known from a bench test (a tight prior, or fixed)";
  } else if (advice.free) {
    words += "without contact";
  } else {
    words += std::isnan(advice.contact_mm)
                 ? "spread over the finger"
                 : "at " + FormatText("%.0f mm", advice.contact_mm);
    words += " with " + FormatText("%.2g N", advice.normal_N) +
             PlaceWords(advice.object_mm);
  }
  for (std::size_t i = 0; i < advice.added.size(); ++i) {
    words += (i == 0 ? " and " : " and with ") + Spoken(advice.added[i]);
  }
  if (!advice.added.empty()) words += " recorded";
  if (advice.force_std_after_N) {
    return words + FormatText(
                       " would shrink the predicted force std from %.2g N to "
                       "%.2g N",
                       *advice.force_std_before_N, *advice.force_std_after_N);
  }
  const CalibrationParameter& p = problem.parameters().all()[advice.parameter];
  const bool percent = p.is_log || p.family == ParameterFamily::kGaugeGain;
  const double per = percent ? std::abs(p.Value(*p.variable)) / 100 : 1;
  const std::string unit = percent ? "%" : p.unit;
  const std::string after =
      FormatText("%.2g ", advice.parameter_std_after / per);
  if (std::isinf(advice.parameter_std_after)) {
    return words + " would tell more about " + Spoken(p) + ", but not all";
  }
  if (std::isinf(advice.parameter_std_before)) {
    return words + " would determine " + Spoken(p) + ", now unknown, to " +
           after + unit;
  }
  return words + " would shrink the std of " + Spoken(p) + " from " +
         FormatText("%.2g ", advice.parameter_std_before / per) + unit +
         " to " + after + unit;
}

std::string NextWords(const NextRecording& next) {
  if (next.enough) {
    return FormatText(
        "enough recorded: predicted force std %.2g N, of which the calibration "
        "adds %.2g N and the noise of one frame %.2g N",
        next.force_std_N(), next.force_calibration_N, next.force_noise_N);
  }
  return next.advice.empty()
             ? "no 20 frames would shrink what is known worst by a tenth"
             : next.advice[0].words;
}

}  // namespace finray
