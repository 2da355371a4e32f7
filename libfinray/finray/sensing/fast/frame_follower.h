#ifndef FINRAY_SENSING_FAST_FRAME_FOLLOWER_H_
#define FINRAY_SENSING_FAST_FRAME_FOLLOWER_H_

#include <memory>
#include <vector>

#include "finray/sensing/contact_search.h"
#include "finray/sensing/fast/rival_map.h"

namespace finray {

/// Fits frames with one contact without a search. Each fit starts where the one
/// before ended (GaugeSurface). Its result is accepted only where a search
/// would find the same: a minimum inside all bounds, where no other contact
/// explains the frame as well (RivalMap). The caller must search all other
/// frames.
class FrameFollower {
 public:
  /// Says whether the follower can be used: the scene must allow one contact
  /// and measure no object place.
  static bool Serves(const Scene& scene);

  /// `rivals` are those of another follower whose search has the same tables,
  /// or null.
  FrameFollower(const Finger& finger, const ContactSearch& search,
                std::shared_ptr<const RivalMap> rivals = nullptr);
  const std::shared_ptr<const RivalMap>& rivals() const { return rivals_; }

  /// Says whether frames may be followed from a solution with all gauges; if
  /// so, the next frames start there. `arc_std_mm` is the std of the solution's
  /// l_c.
  bool Start(const ContactSolution& solution, double arc_std_mm, int gauges);

  /// Fits consecutive frames. All gauges of all frames must have a reading.
  void Fit(const PackedReadings* frames, std::size_t count);

  /// The result of the last call for a frame, without contacts if there is
  /// none.
  const ContactSolution& fit(std::size_t frame) const { return fits_[frame]; }
  /// Says whether a search would find the same contact. `arc_std_mm` as above;
  /// `scale` is the factor of all std by which the frame is not explained
  /// (FrameEstimate::noise_scale).
  bool IsCertain(std::size_t frame, double arc_std_mm, double scale) const;

 private:
  const ContactSearch& search_;
  int gauges_;
  std::shared_ptr<const RivalMap> rivals_;
  PointContact last_;
  std::vector<ContactSolution> fits_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_FRAME_FOLLOWER_H_
