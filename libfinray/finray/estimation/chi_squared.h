#ifndef FINRAY_ESTIMATION_CHI_SQUARED_H_
#define FINRAY_ESTIMATION_CHI_SQUARED_H_

namespace finray {

/// P(X > chi2) for a chi-squared X with `dof` degrees of freedom. It uses the
/// finite sums for whole and half orders of the incomplete gamma function (DLMF
/// 8.4.8, 8.4.11 with 8.8.2). NaN if dof < 1 or chi2 is NaN.
double ChiSquaredTail(double chi2, int dof);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_CHI_SQUARED_H_
