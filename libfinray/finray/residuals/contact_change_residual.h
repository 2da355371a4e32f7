#ifndef FINRAY_RESIDUALS_CONTACT_CHANGE_RESIDUAL_H_
#define FINRAY_RESIDUALS_CONTACT_CHANGE_RESIDUAL_H_

#include <ceres/sized_cost_function.h>

namespace finray {

/// A contact changes little from one frame to the next:
///
///   r = ((l_{t+1} - l_t) / q_l, (f_{t+1} - f_t) / q_f).
///
/// Parameter blocks: (l_c, f_c) of frame t (2, mm and N), the same of t + 1.
class ContactChangeResidual : public ceres::SizedCostFunction<2, 2, 2> {
 public:
  /// q_l and q_f, the std of the change from frame to frame, above 0.
  ContactChangeResidual(double contact_std_mm, double normal_std_N)
      : weight_{1 / contact_std_mm, 1 / normal_std_N} {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double weight_[2];  // 1 / mm, 1 / N
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_CONTACT_CHANGE_RESIDUAL_H_
