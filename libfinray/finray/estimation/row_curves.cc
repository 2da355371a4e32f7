#include "finray/estimation/row_curves.h"

#include "finray/ladder/instruction_set.h"

namespace finray {

// Each compilation of row_curves_kernel.cc has one of these.
using FindMinima = void(const RowCurves& curves, const RowBoxes& boxes,
                        const double* measured, const double* weights,
                        double most_chi2, const RowMinima& minima);
inline namespace generic {
FindMinima RowMinimaOf;
}
namespace avx2 {
FindMinima RowMinimaOf;
}
namespace avx512 {
FindMinima RowMinimaOf;
}

void FindRowMinima(const RowCurves& curves, const RowBoxes& boxes,
                   const double* measured, const double* weights,
                   double most_chi2, const RowMinima& minima, int set) {
  static constexpr FindMinima* kFind[] = FINRAY_COMPILATIONS(RowMinimaOf);
  kFind[BestInstructionSet() + set](curves, boxes, measured, weights, most_chi2,
                                    minima);
}

}  // namespace finray
