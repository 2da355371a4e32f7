// A residual of one's own beside those of the gauges: a camera sees the tip.
// usage: own_residual FINGER.yaml

#include <ceres/ceres.h>

#include <cstdio>
#include <memory>

#include "finray/finray.h"
#include "finray/residuals.h"

namespace {

constexpr double kTipStd_mm = 0.02;

// (tip of the finger - tip seen) / std, from the state of the finger.
class TipResidual final : public ceres::SizedCostFunction<2, 2> {
 public:
  TipResidual(const finray::FrameResiduals& finger, double x_mm, double y_mm)
      : state_(finger.State()),
        row_(finger.tip_row()),
        x_mm_(x_mm),
        y_mm_(y_mm),
        values_(finger.state_size()),
        by_contact_(2 * finger.state_size()) {}

  bool Evaluate(double const* const* contact, double* residuals,
                double** jacobians) const override {
    const bool derive = jacobians != nullptr && jacobians[0] != nullptr;
    double* by_contact[] = {by_contact_.data()};
    if (!state_->Evaluate(contact, values_.data(),
                          derive ? by_contact : nullptr)) {
      return false;
    }
    residuals[0] = (values_[row_] - x_mm_) / kTipStd_mm;
    residuals[1] = (values_[row_ + 1] - y_mm_) / kTipStd_mm;
    for (int i = 0; derive && i < 4; ++i) {
      jacobians[0][i] = by_contact_[2 * row_ + i] / kTipStd_mm;
    }
    return true;
  }

 private:
  std::unique_ptr<ceres::CostFunction> state_;
  int row_;
  double x_mm_, y_mm_;
  mutable std::vector<double> values_, by_contact_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: own_residual FINGER.yaml\n");
    return 1;
  }
  try {
    // What a lab would measure: gauges and tip under 1.5 N at 80 mm.
    const finray::Finger finger = finray::Finger::Read(argv[1]);
    finray::Table load(1);
    load.Set("contact_1_mm", {80});
    load.Set("normal_1_N", {1.5});
    const finray::Table seen = finray::Simulator(finger).Simulate(load).frames;
    std::vector<double> volts;
    for (int j = 1; j <= finger.gauges(); ++j) {
      volts.push_back(seen.At("gauge_" + std::to_string(j) + "_V")[0]);
    }

    const finray::FrameResiduals residuals(finger);
    double contact[] = {70, 1};  // l_c in mm and f_c in N, to start from
    ceres::Problem problem;
    problem.AddResidualBlock(residuals.Gauges(volts), nullptr, contact);
    problem.AddResidualBlock(new TipResidual(residuals, seen.At("tip_x_mm")[0],
                                             seen.At("tip_y_mm")[0]),
                             nullptr, contact);
    problem.SetParameterLowerBound(contact, 0, 0);
    problem.SetParameterUpperBound(contact, 0, finger.front_length_mm());
    problem.SetParameterLowerBound(contact, 1, 0);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    std::printf("contact at %.3f mm with %.4f N, chi2 %.2g\n", contact[0],
                contact[1], 2 * summary.final_cost);
    return summary.IsSolutionUsable() ? 0 : 3;
  } catch (const finray::Error& error) {
    std::fprintf(stderr, "own_residual: %s\n", error.what());
    return error.exit_code();
  }
}
