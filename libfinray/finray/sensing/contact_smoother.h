#ifndef FINRAY_SENSING_CONTACT_SMOOTHER_H_
#define FINRAY_SENSING_CONTACT_SMOOTHER_H_

#include <optional>
#include <vector>

#include "finray/scene/scene.h"
#include "finray/sensing/contact_linearization.h"
#include "finray/sensing/frame_estimate.h"

namespace finray {

/// Smooths one contact over frames that follow each other: the least of
///
///   sum_t chi2_t(x_t) + sum_t |(x_t - x_{t-1}) / q|^2,    x = (l_c, f_c),
///
/// with q the scene's std of the change from frame to frame. Gauss-Newton over
/// the whole run, each frame linearised in equilibrium
/// (contact_linearization.h) and the block tridiagonal system solved in one
/// sweep there and back, which gives the covariance of every frame too. Frames
/// that noise does not explain count as little as they are worth
/// (FrameEstimate::noise_scale). A run
/// ends where there is no contact, where there are two and where a frame is not
/// solved.
class ContactSmoother {
 public:
  /// The scene has smoothing. Throws InputError as EquilibriumSolver.
  ContactSmoother(const Finger& finger, const Scene& scene,
                  const Discretization& discretization);

  /// A frame's x and its covariance.
  struct Belief {
    Eigen::Vector2d mean;
    Eigen::Matrix2d covariance;
  };

  /// Smooths the runs of `count` frames. Changes l_c, f_c, their std, poses and
  /// rib tensions; chi2, dof and the alternative remain those of the frame
  /// alone. `before`: the frame before the first, if there was a contact.
  void Smooth(const Measurements* readings, std::size_t count,
              const std::optional<Belief>& before, FrameEstimate* estimates);

  /// Whether the last call has set the frame.
  bool HasSmoothed(std::size_t frame) const { return smoothed_[frame]; }

  /// The last frame of the last call, if it had a contact: `before` of the
  /// next.
  const std::optional<Belief>& last() const { return last_; }

 private:
  struct Frame {
    PackedReadings measurement;
    Eigen::Vector2d x;
    Eigen::Matrix2d information;  // of the frame alone
    Eigen::Vector2d gradient;
    double chi2;
    Eigen::Vector3d pose, tip_pose;
    std::vector<double> rib_tension_N;
    // Of the elimination: pivots there and back, and the right-hand side.
    Eigen::Matrix2d forward, backward;
    Eigen::Vector2d right, step;
  };
  bool SmoothRun(const Measurements* readings, std::size_t count,
                 const std::optional<Belief>& before, FrameEstimate* estimates);
  bool Linearize(std::size_t count);
  double Cost(std::size_t count, const std::optional<Belief>& before) const;
  void Eliminate(std::size_t count, double damping,
                 const std::optional<Belief>& before);
  Eigen::Matrix2d Covariance(std::size_t t) const;

  Finger finger_;
  Scene scene_;
  EquilibriumSolver solver_;
  ContactLinearization at_;
  std::vector<PointContact> contacts_;
  Eigen::Matrix2d change_information_;  // 1 / q^2
  std::vector<Frame> frames_;
  std::vector<bool> smoothed_;
  std::optional<Belief> last_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_CONTACT_SMOOTHER_H_
