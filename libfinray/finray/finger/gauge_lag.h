#ifndef FINRAY_FINGER_GAUGE_LAG_H_
#define FINRAY_FINGER_GAUGE_LAG_H_

#include <cmath>

namespace finray {

/// The lagging part z of a signal u(t) that runs linearly from sample to
/// sample:
///
///   tau dz/dt = u - (1 + c) z.
///
/// Before the first sample the signal has stood still: z = u / (1 + c). With
/// the time constant tau and the share c of a gauge that creeps
///
///  - the signal s of its angle gives, with c = 0 here, the y of
///    V = offset + gain (s + c y), tau dy/dt = s - y;
///  - its readings u = V - offset give z = gain y, so V - c z is what it would
///    read without creep.
///
/// T is double or a ceres::Jet, for derivatives by c and tau.
template <class T>
class GaugeLag {
 public:
  GaugeLag(const T& share, const T& time_constant_s)
      : share_(share), time_constant_s_(time_constant_s) {}

  /// Takes the next sample and returns z. A time that is NaN, or before the
  /// last one, counts as the last one.
  T Next(double time_s, const T& u) {
    using std::exp;
    if (!started_) {
      z_ = u / (1.0 + share_);
      started_ = true;
    } else if (time_s > time_s_) {
      const T x = (1.0 + share_) * (time_s - time_s_) / time_constant_s_;
      const T decay = exp(-x);
      // (1 - exp(-x)) / x, by its series where the difference cancels.
      const T mean = x > 1e-3
                         ? T((1.0 - decay) / x)
                         : T(1.0 - x * (1.0 - x * (1.0 - x / 4.0) / 3.0) / 2.0);
      z_ = decay * z_ +
           (u_ * (mean - decay) + u * (1.0 - mean)) / (1.0 + share_);
    }
    if (std::isnan(time_s_) || time_s > time_s_) time_s_ = time_s;
    u_ = u;
    return z_;
  }
  /// The next sample is the first of another log.
  void Restart() {
    started_ = false;
    time_s_ = std::nan("");
  }

 private:
  T share_, time_constant_s_;
  bool started_ = false;
  double time_s_ = std::nan("");
  T u_{}, z_{};
};

}  // namespace finray

#endif  // FINRAY_FINGER_GAUGE_LAG_H_
