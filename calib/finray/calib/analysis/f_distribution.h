#ifndef FINRAY_CALIB_ANALYSIS_F_DISTRIBUTION_H_
#define FINRAY_CALIB_ANALYSIS_F_DISTRIBUTION_H_

namespace finray {

/// Returns P(X > f) if X has Fisher's distribution with (d1, d2) degrees of
/// freedom. That is the regularized incomplete beta function I_x(d2/2, d1/2) at
/// x = d2 / (d2 + d1 f), by the continued fraction DLMF 8.17.22. With d1 = 1 it
/// is the two-sided tail of Student's t, with f = t^2. Returns NaN if a number
/// of degrees is below 1 or f is NaN.
double FTail(double f, int d1, int d2);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_F_DISTRIBUTION_H_
