#ifndef FINRAY_ESTIMATION_ROW_BOXES_H_
#define FINRAY_ESTIMATION_ROW_BOXES_H_

#include <vector>

#include "finray/estimation/row_curves.h"

namespace finray {

/// Where the values of a group of kRows rows lie, chord by chord. A box bounds
/// each value over all contacts nearer to a row of the group than to others,
/// with forces from one end of the chord to the other, and over the next row on
/// either side. The cubics of rows lie in the hull of their Bezier points.
/// Between rows and beyond the last ones, a box reaches further by the second
/// differences of rows at the ends of the chord. It holds all values as far as
/// these show how they bend (RowBoxesTest).
///
/// chi2 of readings m is then no less, for all these contacts, than
///
///   sum_j w_j^2 max(low_j - m_j, m_j - high_j, 0)^2.
struct RowBoxes {
  static constexpr int kRows = RowCurves::kPadding;

  RowBoxes() = default;
  explicit RowBoxes(const RowCurves& curves);

  int chords = 0;  ///< Those of a row, padded to RowCurves::kPadding.
  /// [group][value][chord]; infinite and reversed where rows have no chord.
  std::vector<double> low, high;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_ROW_BOXES_H_
