// Compiled once for every instruction set; see CMakeLists.txt.
#include <algorithm>
#include <limits>

#include "finray/estimation/row_boxes.h"
#include "finray/ladder/registers.h"

namespace finray {
inline namespace FINRAY_ISA {
namespace {

constexpr int kWidth = kRegisterWidth;
using Row = Doubles<kWidth>;
using V = Row::Vector;
static_assert(RowCurves::kPadding % kWidth == 0);

constexpr int kRefinements = 4;
// The first kKept values keep their terms. Those of the others are formed anew.
constexpr int kKept = 16;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

V WithinOne(V share) {
  share = share < 0 ? V{} : share;
  return share > 1 ? V{} + 1.0 : share;
}

// Says whether chi2 falls by these changes of shares as slope and curvature
// say, but for 1e-6 (1 + chi2). No lane is NaN: rows without a chord do not
// change.
bool IsSmall(const V& change) {
  constexpr double kSmall = 1e-4;
  return Row::Greatest(change) < kSmall && Row::Least(change) > -kSmall;
}

struct Nearest {
  V chi2 = V{} + kInfinity;
  V to{}, share{};
};

// The whitened misfit c_0 + c_1 t + c_2 t^2 + c_3 t^3 of one value.
struct Cubic {
  V c[4];
};

// The chords from `first` to before `end`.
struct Chords {
  int first, end;
};

// Returns the least range of chords that holds all whose box is nearer than
// most_chi2.
Chords ChordsNear(const RowBoxes& boxes, int values, int group,
                  const double* measured, const double* weights,
                  double most_chi2) {
  V first = V{} + static_cast<double>(boxes.chords), end{};
  V chord;
  for (int lane = 0; lane < kWidth; ++lane) chord[lane] = lane;
  const int stride = boxes.chords;
  const double* low = boxes.low.data() + group * values * stride;
  const double* high = boxes.high.data() + group * values * stride;
  for (int k = 0; k < stride; k += kWidth, low += kWidth, high += kWidth) {
    V chi2{};
    for (int j = 0; j < values; ++j) {
      const V below = Row::Load(low + j * stride) - measured[j];
      const V above = measured[j] - Row::Load(high + j * stride);
      V off = below > above ? below : above;
      off = weights[j] * (off > 0 ? off : V{});
      chi2 += off * off;
    }
    const auto near = chi2 < most_chi2;
    first = near & (chord < first) ? chord : first;
    end = near ? chord + 1.0 : end;
    chord += static_cast<double>(kWidth);
  }
  return {static_cast<int>(Row::Least(first)),
          static_cast<int>(Row::Greatest(end))};
}

// kWidth rows of kValues values, or of as many as there are if it is 0. A
// number that the compiler knows keeps them all in registers.
template <int kValues>
class Rows {
 public:
  Rows(const RowCurves& curves, const double* measured, const double* weights,
       int row)
      : curves_(curves), measured_(measured), weights_(weights), row_(row) {}

  // The nearest points of the chords.
  Nearest OnChords(const Chords& chords) const {
    Nearest nearest;
    V kept[kKept];  // misfits at the nodes where chords begin
    for (int j = 0; j < values() && j < kKept; ++j) {
      kept[j] = Off(chords.first, j);
    }
    for (int k = chords.first; k < chords.end; ++k) {
      V along{}, square{}, misfit{};
      for (int j = 0; j < values(); ++j) {
        const V from = j < kKept ? kept[j] : Off(k, j);
        const V to = Off(k + 1, j);
        const V edge = from - to;
        along += edge * from;
        square += edge * edge;
        misfit += from * from;
        if (j < kKept) kept[j] = to;
      }
      const V share = WithinOne(square > 0 ? along / square : V{});
      const V chi2 = misfit + share * (share * square - 2.0 * along);
      const auto better = chi2 < nearest.chi2;  // false without the node
      nearest.chi2 = better ? chi2 : nearest.chi2;
      nearest.share = better ? share : nearest.share;
      nearest.to = better ? V{} + static_cast<double>(k + 1) : nearest.to;
    }
    return nearest;
  }

  // The nearest points of the cubics above the nearest chords.
  void Refine(Nearest* nearest) const {
    // Neighbouring rows end at the same few nodes.
    const Chords ends = {
        std::max(1, static_cast<int>(Row::Least(nearest->to))),
        std::max(1, static_cast<int>(Row::Greatest(nearest->to))) + 1};
    Cubic kept[kKept];
    for (int j = 0; j < values() && j < kKept; ++j) {
      kept[j] = CubicOf(j, nearest->to, ends);
    }
    V t = nearest->share;
    nearest->chi2 = V{} + kInfinity;
    auto goes_on = nearest->to > 0;
    for (int i = 0; i < kRefinements; ++i) {
      V chi2{}, slope{}, curvature{};
      const V twice = 2.0 * t, thrice = 3.0 * t * t;
      for (int j = 0; j < values(); ++j) {
        const Cubic other = j < kKept ? Cubic() : CubicOf(j, nearest->to, ends);
        const V* c = j < kKept ? kept[j].c : other.c;
        const V off = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
        const V by_share = c[1] + twice * c[2] + thrice * c[3];
        chi2 += off * off;
        slope += off * by_share;
        curvature += by_share * by_share;
      }
      goes_on &= chi2 < nearest->chi2;
      nearest->chi2 = goes_on ? chi2 : nearest->chi2;
      nearest->share = goes_on ? t : nearest->share;
      goes_on &= curvature > 0;
      const V next = goes_on ? WithinOne(t - slope / curvature) : t;
      const V change = next - t;
      if (IsSmall(change)) {
        const V expected = chi2 + change * (2.0 * slope + change * curvature);
        nearest->chi2 =
            goes_on ? (expected > 0 ? expected : V{}) : nearest->chi2;
        nearest->share = goes_on ? next : nearest->share;
        break;
      }
      t = next;
    }
  }

 private:
  int values() const { return kValues > 0 ? kValues : curves_.values; }

  int At(int force, int value) const {
    return (force * curves_.values + value) * curves_.rows + row_;
  }

  // The whitened misfit of a node, measured less its value.
  V Off(int force, int j) const {
    return weights_[j] *
           (measured_[j] - Row::Load(curves_.value + At(force, j)));
  }

  // The cubic of the chord to node `to`, one of `ends`.
  Cubic CubicOf(int j, const V& to_node, const Chords& ends) const {
    V from{}, to{}, slope_from{}, slope_to{};
    for (int k = ends.first; k < ends.end; ++k) {
      const double width = curves_.force_N[k] - curves_.force_N[k - 1];
      const int a = At(k - 1, j), b = At(k, j);
      const auto here = to_node == static_cast<double>(k);
      from = here ? Row::Load(curves_.value + a) : from;
      to = here ? Row::Load(curves_.value + b) : to;
      slope_from = here ? width * Row::Load(curves_.by_force + a) : slope_from;
      slope_to = here ? width * Row::Load(curves_.by_force + b) : slope_to;
    }
    const V rise = to - from;
    const double w = weights_[j];
    return {{w * (from - measured_[j]), w * slope_from,
             w * (3.0 * rise - 2.0 * slope_from - slope_to),
             w * (slope_from + slope_to - 2.0 * rise)}};
  }

  const RowCurves& curves_;
  const double *measured_, *weights_;
  const int row_;
};

template <int kValues>
void FindMinima(const RowCurves& curves, const RowBoxes& boxes,
                const double* measured, const double* weights, double most_chi2,
                const RowMinima& minima) {
  const int values = kValues > 0 ? kValues : curves.values;
  for (int group = 0; group * RowBoxes::kRows < curves.rows; ++group) {
    const Chords chords =
        ChordsNear(boxes, values, group, measured, weights, most_chi2);
    for (int i = 0; i < RowBoxes::kRows; i += kWidth) {
      const int row = group * RowBoxes::kRows + i;
      Nearest nearest;
      if (chords.first < chords.end) {
        const Rows<kValues> rows(curves, measured, weights, row);
        nearest = rows.OnChords(chords);
        rows.Refine(&nearest);
      }
      Row::Store(nearest.chi2, minima.chi2 + row);
      Row::Store(nearest.to, minima.to + row);
      Row::Store(nearest.share, minima.share + row);
    }
  }
}

}  // namespace

void RowMinimaOf(const RowCurves& curves, const RowBoxes& boxes,
                 const double* measured, const double* weights,
                 double most_chi2, const RowMinima& minima) {
  // Most fingers have four gauges.
  if (curves.values == 4) {
    FindMinima<4>(curves, boxes, measured, weights, most_chi2, minima);
  } else {
    FindMinima<0>(curves, boxes, measured, weights, most_chi2, minima);
  }
}

}  // namespace FINRAY_ISA
}  // namespace finray
