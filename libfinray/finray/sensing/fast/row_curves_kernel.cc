// Compiled once for every instruction set; see CMakeLists.txt.
#include <limits>

#include "finray/ladder/registers.h"
#include "finray/sensing/fast/row_curves.h"

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

V WithinOne(V share) {
  share = share < 0 ? V{} : share;
  return share > 1 ? V{} + 1.0 : share;
}

struct Nearest {
  V chi2 = V{} + std::numeric_limits<double>::infinity();
  V to{}, share{};
};

// The whitened misfit c_0 + c_1 t + c_2 t^2 + c_3 t^3 of one value.
struct Cubic {
  V c[4];
};

// kWidth rows.
class Rows {
 public:
  Rows(const RowCurves& curves, const double* measured, const double* weights,
       int row)
      : curves_(curves), measured_(measured), weights_(weights), row_(row) {}

  // The nearest points of the chords.
  Nearest OnChords() const {
    Nearest nearest;
    V kept[kKept];  // misfits at the nodes where chords begin
    for (int j = 0; j < curves_.values && j < kKept; ++j) kept[j] = Off(0, j);
    for (int k = 0; k + 1 < curves_.forces; ++k) {
      V along{}, square{}, misfit{};
      for (int j = 0; j < curves_.values; ++j) {
        if (weights_[j] == 0) continue;
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
    int end[kWidth];
    for (int lane = 0; lane < kWidth; ++lane) {
      end[lane] =
          nearest->to[lane] > 1 ? static_cast<int>(nearest->to[lane]) : 1;
    }
    Cubic kept[kKept];
    for (int j = 0; j < curves_.values && j < kKept; ++j) {
      kept[j] = CubicOf(j, end);
    }
    V t = nearest->share;
    nearest->chi2 = V{} + std::numeric_limits<double>::infinity();
    auto goes_on = t == t;
    for (int i = 0; i < kRefinements; ++i) {
      V chi2{}, slope{}, curvature{};
      for (int j = 0; j < curves_.values; ++j) {
        if (weights_[j] == 0) continue;
        const Cubic cubic = j < kKept ? kept[j] : CubicOf(j, end);
        const V* c = cubic.c;
        const V off = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
        const V by_share = c[1] + t * (2.0 * c[2] + t * (3.0 * c[3]));
        chi2 += off * off;
        slope += off * by_share;
        curvature += by_share * by_share;
      }
      goes_on &= chi2 < nearest->chi2;
      nearest->chi2 = goes_on ? chi2 : nearest->chi2;
      nearest->share = goes_on ? t : nearest->share;
      goes_on &= curvature > 0;
      t = goes_on ? WithinOne(t - slope / curvature) : t;
    }
  }

 private:
  int At(int force, int value) const {
    return (force * curves_.values + value) * curves_.rows + row_;
  }

  // The whitened misfit of a node, measured less its value.
  V Off(int force, int j) const {
    return weights_[j] *
           (measured_[j] - Row::Load(curves_.value + At(force, j)));
  }

  Cubic CubicOf(int j, const int end[kWidth]) const {
    V from{}, to{}, slope_from{}, slope_to{};
    for (int lane = 0; lane < kWidth; ++lane) {
      const int k = end[lane];
      const double width = curves_.force_N[k] - curves_.force_N[k - 1];
      const int a = At(k - 1, j) + lane, b = At(k, j) + lane;
      from[lane] = curves_.value[a];
      to[lane] = curves_.value[b];
      slope_from[lane] = width * curves_.by_force[a];
      slope_to[lane] = width * curves_.by_force[b];
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

}  // namespace

void RowMinimaOf(const RowCurves& curves, const double* measured,
                 const double* weights, const RowMinima& minima) {
  for (int row = 0; row < curves.rows; row += kWidth) {
    const Rows rows(curves, measured, weights, row);
    Nearest nearest = rows.OnChords();
    rows.Refine(&nearest);
    Row::Store(nearest.chi2, minima.chi2 + row);
    Row::Store(nearest.to, minima.to + row);
    Row::Store(nearest.share, minima.share + row);
  }
}

}  // namespace FINRAY_ISA
}  // namespace finray
