#ifndef FINRAY_ESTIMATION_ROW_CURVES_H_
#define FINRAY_ESTIMATION_ROW_CURVES_H_

#include "finray/ladder/round_up.h"

namespace finray {

/// The values of a GaugeTable's rows over force, as plain arrays with the rows
/// innermost, so that vector lanes are rows. A row is a curve of cubic Hermite
/// polynomials through its nodes.
struct RowCurves {
  /// Rows are padded to a multiple of this, the widest vector.
  static constexpr int kPadding = 8;
  static constexpr int Padded(int rows) { return RoundUp(rows, kPadding); }

  int rows, forces, values;
  const double* force_N;
  /// [force][value][row]; NaN where a row has no such node.
  const double *value, *by_force;
};

struct RowBoxes;

/// The nearest point of each row: the index of the node at the end of its chord
/// (0: none was found) and the share of the way there.
struct RowMinima {
  double *chi2, *to, *share;  ///< [row]
};

/// Minimises chi2 = sum_j w_j^2 (value_j - measured_j)^2 along each row: first
/// on the chords between its nodes, then by Gauss-Newton on the cubic above the
/// nearest one. A row whose chi2 is `most_chi2` or more may get a larger one,
/// or none: `boxes` say which chords may lead below that, and only those are
/// searched. `set` counts from the best instruction set of this machine.
void FindRowMinima(const RowCurves& curves, const RowBoxes& boxes,
                   const double* measured, const double* weights,
                   double most_chi2, const RowMinima& minima, int set = 0);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_ROW_CURVES_H_
