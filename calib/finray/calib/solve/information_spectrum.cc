#include "finray/calib/solve/information_spectrum.h"

#include <lapacke.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <stdexcept>
#include <vector>

namespace finray {
namespace {

// Eigenvalues below this are rounding if the diagonal of the matrix is 1.
constexpr double kRounding = 1e-13;

// Memory at a multiple of 64 bytes. Elsewhere BLAS sums in another order, and
// the last digits would depend on where the heap has put a matrix.
class AlignedDoubles {
 public:
  explicit AlignedDoubles(lapack_int count)
      : memory_(static_cast<double*>(std::aligned_alloc(
            64, (static_cast<std::size_t>(count) + 7) / 8 * 64))) {
    if (!memory_) throw std::bad_alloc();
  }
  double* data() const { return memory_.get(); }

 private:
  struct Free {
    void operator()(double* memory) const { std::free(memory); }
  };
  std::unique_ptr<double, Free> memory_;
};

}  // namespace

InformationSpectrum::InformationSpectrum(const Eigen::MatrixXd& information) {
  const auto n = static_cast<lapack_int>(information.rows());
  if (n == 0) return;
  if (!information.allFinite()) {
    throw std::runtime_error(
        "the derivatives of the model by the parameters are not finite");
  }
  const Eigen::VectorXd root = information.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd size =
      root.unaryExpr([](double r) { return r > 0 ? 1 / r : 0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> even(
      size.asDiagonal() * information * size.asDiagonal());
  const Eigen::VectorXd kept = even.eigenvalues().unaryExpr(
      [](double value) { return value > kRounding ? value : 0; });
  const lapack_int work_size = 2 * n * n + 6 * n + 7;  // ample
  const AlignedDoubles memory(2 * n * n + n + work_size + 4 * 8);
  double* next = memory.data();
  const auto take = [&](lapack_int count) {
    double* const taken = next;
    next += (count + 7) / 8 * 8;
    return taken;
  };
  double* const factor = take(n * n);
  double* const right = take(n * n);
  double *const singular = take(n), *const work = take(work_size);
  std::vector<lapack_int> integers(4 * static_cast<std::size_t>(n) + 3);
  Eigen::Map<Eigen::MatrixXd>(factor, n, n) = kept.cwiseSqrt().asDiagonal() *
                                              even.eigenvectors().transpose() *
                                              root.asDiagonal();
  if (LAPACKE_dgejsv_work(LAPACK_COL_MAJOR, 'C', 'N', 'V', 'N', 'N', 'N', n, n,
                          factor, n, singular, nullptr, n, right, n, work,
                          work_size, integers.data()) != 0) {
    throw std::runtime_error("the information of the data has no eigenvalues");
  }
  // LAPACK scales the singular values so that they do not overflow; this takes
  // the scale out.
  values = (work[0] / work[1] * Eigen::Map<Eigen::VectorXd>(singular, n))
               .reverse()
               .cwiseAbs2();
  vectors = Eigen::Map<Eigen::MatrixXd>(right, n, n).rowwise().reverse();
}

Eigen::MatrixXd InUnits(const Eigen::MatrixXd& information,
                        const Eigen::VectorXd& unit) {
  return unit.asDiagonal() * information * unit.asDiagonal();
}

Eigen::MatrixXd DeterminedUnits(const Eigen::MatrixXd& information,
                                const Eigen::VectorXd& unit) {
  const InformationSpectrum spectrum(InUnits(information, unit));
  const auto weak =
      std::count_if(spectrum.values.begin(), spectrum.values.end(),
                    [](double value) { return value < kLeastMoved; });
  const Eigen::Index kept = unit.size() - weak;
  return unit.asDiagonal() * spectrum.vectors.rightCols(kept) *
         spectrum.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

Eigen::MatrixXd BoundedCovariance(const Eigen::MatrixXd& information) {
  const InformationSpectrum spectrum(information);
  const Eigen::MatrixXd root =
      spectrum.vectors * spectrum.values.cwiseMax(kLeastInformation)
                             .cwiseSqrt()
                             .cwiseInverse()
                             .asDiagonal();
  return root * root.transpose();
}

}  // namespace finray
