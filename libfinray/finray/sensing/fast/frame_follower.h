#ifndef FINRAY_SENSING_FAST_FRAME_FOLLOWER_H_
#define FINRAY_SENSING_FAST_FRAME_FOLLOWER_H_

#include <vector>

#include "finray/sensing/contact_search.h"
#include "finray/sensing/fast/frame_group_fit.h"
#include "finray/sensing/fast/rival_map.h"

namespace finray {

/// Frames of one contact without a search: each is fitted from where the one
/// before it ended (FrameGroupFit), and what comes of it is taken only where a
/// search could find nothing else: a minimum inside all bounds where no other
/// contact explains the frame as well (RivalMap). All other frames are to be
/// searched.
class FrameFollower {
 public:
  /// For scenes that may have one contact and measure nothing but gauges.
  static bool Serves(const Scene& scene);

  FrameFollower(const Finger& finger, const Scene& scene,
                const Discretization& discretization,
                const ContactSearch& search);

  /// Whether frames may be followed from a solution with all gauges, the std of
  /// whose l_c is given; if so, that is where the next ones start.
  bool Start(const ContactSolution& solution, double arc_std_mm, int gauges);

  /// Fits frames that follow each other, all with all gauges measured.
  void Fit(const std::vector<PackedReadings>& frames, std::size_t count);

  /// Of the last call, frame by frame.
  const FrameFit& fit(std::size_t frame) const { return fits_[frame]; }
  /// Whether a search would find just that. `arc_std_mm` as above.
  bool IsCertain(std::size_t frame, double arc_std_mm) const;

 private:
  const ContactSearch& search_;
  int gauges_;
  RivalMap rivals_;
  FrameGroupFit group_;
  Eigen::MatrixXd angles_rad_, weights_;
  std::vector<FrameFit> fits_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_FRAME_FOLLOWER_H_
