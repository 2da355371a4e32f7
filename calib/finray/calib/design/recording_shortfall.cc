#include "finray/calib/design/recording_shortfall.h"

#include "finray/io/number_text.h"

namespace finray {

std::string RecordingShortfall::Remedy() const {
  if (rows > 0) {
    return FormatText(
        "about %zu rows would suffice (--most_frames), or larger forces, a "
        "wider stage or tighter priors",
        rows);
  }
  if (2 * noisy > draws) {
    return "the noise of one frame is larger than the target, so no "
           "calibration helps: take a larger --force_N, average frames, or "
           "other gauges";
  }
  std::string words = FormatText(
      "no number of rows suffices (%d times as many meet it in %.1f %%)",
      kMostTimes, 100 * met);
  const auto say = [&](int fingers, const std::string& why) {
    if (fingers == 0) return;
    words += FormatText("%s in %d of %d fingers within the priors ",
                        words.find(':') == std::string::npos ? ":" : ";",
                        fingers, draws) +
             why;
  };
  say(noisy,
      "the noise of one frame is larger than the target (take a larger "
      "--force_N, average frames, or other gauges)");
  say(out_of_reach,
      "most places press harder than --force_max_N or do not touch (record a "
      "short log first and plan with --from it, or give tighter priors of the "
      "stiffness)");
  const int others = missing - noisy - out_of_reach;
  say(others, "these places leave " + parameter +
                  " to its prior (reach other places by --x_mm and --y_mm, "
                  "other loads by --force_max_N, or measure it and give a "
                  "tighter prior)");
  return words;
}

}  // namespace finray
