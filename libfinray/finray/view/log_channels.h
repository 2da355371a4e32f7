#ifndef FINRAY_VIEW_LOG_CHANNELS_H_
#define FINRAY_VIEW_LOG_CHANNELS_H_

#include <string>
#include <string_view>
#include <vector>

#include "finray/estimation/frame_estimate.h"
#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/finger/point_contact.h"
#include "finray/view/channel.h"

namespace finray {

/// What a page shows of the results of one log.
struct LogChannels {
  std::string name;
  std::size_t frames = 0;
  /// The times of the frames; the number of the frame, from 0, where the log
  /// has no time_s that never decreases.
  std::vector<double> time_s;
  bool has_time = true;
  /// contact_<c>_mm, normal_<c>_N and their std. `..._below` and `..._above` is
  /// how far the interval reaches below and above the value. force_N is the
  /// reference force. friction_<c> is the tangential over the normal force.
  /// alternative_* is a second solution. chi2_p_value.
  /// gauge_<j>_residual_std: reading less that of the estimate in std of the
  /// gauge's noise, at most kMostResidual. Channels without any value are left
  /// out.
  std::vector<Channel> channels;
  /// 1 << status of each frame.
  std::vector<std::uint16_t> status;
  /// The largest normal_<c>_N of the frames that are ok, or of all if none is:
  /// those of other frames may be far off. 0 if there is none.
  double most_force_N = 0;
  /// The least and the largest friction_<c> of contacts; 0 without any.
  double least_friction = 0, most_friction = 0;
  /// The contacts of each frame with two.
  struct Pair {
    std::size_t frame;
    std::vector<PointContact> contacts;
  };
  std::vector<Pair> pairs;

  static constexpr double kMostResidual = 12;
};

/// Reads D/<log>.frames.csv. With a finger it finds the residuals of the gauges
/// by solving each frame at its estimate, unless the result has no gauge;
/// nullptr leaves them out. Throws InputError for a file that is not such a
/// result or does not belong to the finger.
LogChannels ReadLogChannels(const std::string& path, const Finger* finger,
                            const Discretization& discretization);

/// Returns "a" for D/a.frames.csv.
std::string ResultName(const std::string& path);

/// Returns the status with this name; throws InputError with `place` if there
/// is none.
FrameStatus StatusNamed(std::string_view name, const std::string& place);

}  // namespace finray

#endif  // FINRAY_VIEW_LOG_CHANNELS_H_
