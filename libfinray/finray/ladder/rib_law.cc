#include "finray/ladder/rib_law.h"

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace finray {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLargestBow = 0.04;  // of the rib's length

// A reaction as the frame keeps it, behind the turns.
constexpr int kReactionNumbers = sizeof(RibReaction) / sizeof(double);
static_assert(kReactionNumbers == kJointValues - kJointStiffness);
double* Numbers(RibReaction& reaction) {
  return reinterpret_cast<double*>(&reaction);
}

// g(y) = sqrt(y) coth(sqrt(y)) and p(y) = (g - 1) / y with two derivatives.
struct ColumnFunctions {
  double g[3], p[3];
};

// The power series of g about 0; 2 y g' = g - g^2 + y gives its coefficients.
constexpr int kTerms = 26;
std::array<double, kTerms> SeriesOfColumn() {
  std::array<double, kTerms> c{};
  c[0] = 1;
  for (int n = 1; n < kTerms; ++n) {
    double sum = n == 1 ? 1 : 0;
    for (int i = 1; i < n; ++i) sum -= c[i] * c[n - i];
    c[n] = sum / (2 * n + 1);
  }
  return c;
}

ColumnFunctions ColumnAt(double y) {
  ColumnFunctions at{};
  constexpr double kNear = 2;  // the series converges for |y| < pi^2
  if (std::abs(y) < kNear) {
    static const std::array<double, kTerms> c = SeriesOfColumn();
    double* p = at.p;
    for (int n = kTerms - 1; n >= 1; --n) {
      p[2] = p[2] * y + 2 * p[1];
      p[1] = p[1] * y + p[0];
      p[0] = p[0] * y + c[n];
    }
    at.g[0] = 1 + y * p[0];
    at.g[1] = p[0] + y * p[1];
    at.g[2] = 2 * p[1] + y * p[2];
    return at;
  }
  const double u = std::sqrt(std::abs(y));
  double* g = at.g;
  g[0] = y > 0 ? u / std::tanh(u) : u / std::tan(u);
  g[1] = (g[0] - g[0] * g[0] + y) / (2 * y);
  g[2] = (1 - g[1] - 2 * g[0] * g[1]) / (2 * y);
  at.p[0] = (g[0] - 1) / y;
  at.p[1] = (g[1] - at.p[0]) / y;
  at.p[2] = (g[2] - 2 * at.p[1]) / y;
  return at;
}

// A symmetric matrix: front, front by back, back.
template <class J>
struct Pair {
  J ff, fb, bb;
};

// G and dG/dT. B takes the turns of the ends to those of the part that bends,
// against the line between its own ends; R is what the rigid ends and that line
// shorten the rib by.
template <class J>
void Column(const J& length, const J& stiffness, const double end[2],
            const J& tension, Pair<J>* G, Pair<J>* by_tension) {
  const J bent = length - (end[0] + end[1]);
  const J y = tension * bent * bent / (4.0 * stiffness);
  const ColumnFunctions at = ColumnAt(y.a);
  const auto lift = [&y](const double* f) { return J(f[0], f[1] * y.v); };
  const J g = lift(at.g), d_g = lift(at.g + 1);
  const J p = lift(at.p), d_p = lift(at.p + 1);
  const J front = end[0] / bent, back = end[1] / bent;
  const auto turned = [&](const J& alike, const J& opposite) {
    const J own = 0.5 * (alike + opposite), other = 0.5 * (alike - opposite);
    return Pair<J>{own * ((1.0 + front) * (1.0 + front) + front * front) +
                       2.0 * other * front * (1.0 + front),
                   own * ((1.0 + front) * back + front * (1.0 + back)) +
                       other * ((1.0 + front) * (1.0 + back) + front * back),
                   own * ((1.0 + back) * (1.0 + back) + back * back) +
                       2.0 * other * back * (1.0 + back)};
  };
  const J size = stiffness / bent, d_size = 0.25 * bent;
  const Pair<J> k = turned(2.0 / p * size, 2.0 * g * size);
  const Pair<J> d_k = turned(-2.0 * d_p / (p * p) * d_size, 2.0 * d_g * d_size);
  const Pair<J> r = {end[0] * (1.0 + front), end[0] * back,
                     end[1] * (1.0 + back)};
  *G = {k.ff + tension * r.ff, k.fb + tension * r.fb, k.bb + tension * r.bb};
  *by_tension = {d_k.ff + r.ff, d_k.fb + r.fb, d_k.bb + r.bb};
}

// Turns G and G_T into H and H_T. False if the rib buckles on its springs.
template <class J>
bool PutSpringsInSeries(const RibLaw& law, const std::array<J, 2>& stiffness,
                        Pair<J>* G, Pair<J>* by_tension) {
  const bool springs[2] = {std::isfinite(law.hinge_stiffness[0]),
                           std::isfinite(law.hinge_stiffness[1])};
  if (!springs[0] && !springs[1]) return true;
  // The rows of (k + G) alpha = k a, or alpha = a at a clamped end.
  const J of_G[2][2] = {{G->ff, G->fb}, {G->fb, G->bb}};
  J k[2] = {J(1), J(1)}, row[2][2] = {{J(1), J(0)}, {J(0), J(1)}};
  for (int i = 0; i < 2; ++i) {
    if (!springs[i]) continue;
    k[i] = stiffness[i];
    row[i][i] = of_G[i][i] + k[i];
    row[i][1 - i] = of_G[i][1 - i];
  }
  const J determinant = row[0][0] * row[1][1] - row[0][1] * row[1][0];
  if (!(row[0][0].a > 0 && row[1][1].a > 0 && determinant.a > 0)) return false;
  const J w[2][2] = {
      {row[1][1] * k[0] / determinant, -(row[0][1] * k[1]) / determinant},
      {-(row[1][0] * k[0]) / determinant, row[0][0] * k[1] / determinant}};
  *G = {of_G[0][0] * w[0][0] + of_G[0][1] * w[1][0],
        of_G[0][0] * w[0][1] + of_G[0][1] * w[1][1],
        of_G[1][0] * w[0][1] + of_G[1][1] * w[1][1]};
  const Pair<J> t = *by_tension;
  const auto between = [&](int i, int j) {
    return w[0][i] * (t.ff * w[0][j] + t.fb * w[1][j]) +
           w[1][i] * (t.fb * w[0][j] + t.bb * w[1][j]);
  };
  *by_tension = {between(0, 0), between(0, 1), between(1, 1)};
  return true;
}

// J counts derivatives by T and, if it has more than one, by L, EI and k.
template <int kCount>
RibReaction ReactBending(const RibLaw& law, double tension,
                         const double turn[2]) {
  using J = ceres::Jet<double, kCount>;
  const auto variable = [](double value, int which) {
    return which < kCount ? J(value, which) : J(value);
  };
  RibReaction reaction;
  const auto fail = [&] {
    std::fill_n(Numbers(reaction), kReactionNumbers,
                std::numeric_limits<double>::quiet_NaN());
    return reaction;
  };
  const double bent = law.length - law.end[0] - law.end[1];
  const double y = tension * bent * bent / (4 * law.bending_stiffness);
  // Written so that a NaN fails.
  if (!(bent > 0 && law.bending_stiffness > 0 && y > -kPi * kPi)) return fail();
  Pair<J> H, H_T;
  Column(variable(law.length, 1), variable(law.bending_stiffness, 2), law.end,
         variable(tension, 0), &H, &H_T);
  if (!PutSpringsInSeries<J>(law,
                             {variable(law.hinge_stiffness[0], 3),
                              variable(law.hinge_stiffness[1], 3)},
                             &H, &H_T)) {
    return fail();
  }
  const J moment[2] = {H.ff * turn[0] + H.fb * turn[1],
                       H.fb * turn[0] + H.bb * turn[1]};
  const J by_T[2] = {H_T.ff * turn[0] + H_T.fb * turn[1],
                     H_T.fb * turn[0] + H_T.bb * turn[1]};
  const J bow = 0.5 * (turn[0] * by_T[0] + turn[1] * by_T[1]);
  reaction.stiffness[0] = H.ff.a;
  reaction.stiffness[1] = H.fb.a;
  reaction.stiffness[2] = H.bb.a;
  for (int i = 0; i < 2; ++i) {
    reaction.moment[i] = moment[i].a;
    reaction.moment_by_tension[i] = by_T[i].a;
  }
  reaction.bow = bow.a;
  reaction.bow_by_tension = bow.v[0];
  for (int by = 0; by < 3 && by + 1 < kCount; ++by) {
    reaction.by[by][0] = moment[0].v[by + 1];
    reaction.by[by][1] = moment[1].v[by + 1];
    reaction.by[by][2] = bow.v[by + 1];
  }
  return reaction;
}

RibReaction ReactRigid(const RibLaw& law, const double turn[2]) {
  RibReaction reaction{};
  for (int i = 0; i < 2; ++i) {
    reaction.stiffness[2 * i] = law.hinge_stiffness[i];
    reaction.moment[i] = law.hinge_stiffness[i] * turn[i];
    reaction.by[kByHinge][i] = turn[i];
  }
  return reaction;
}

}  // namespace

RibReaction React(const RibLaw& law, double tension, const double turn[2],
                  bool derivatives) {
  if (law.bending_stiffness == 0) return ReactRigid(law, turn);
  return derivatives ? ReactBending<4>(law, tension, turn)
                     : ReactBending<1>(law, tension, turn);
}

template <class T>
void ReactInFrame(LadderFrame<T>& frame, int rib, bool derivatives) {
  T* joint = frame.joints + kJointValues * rib;
  const RibLaw law = {
      frame.rib_length[rib],
      frame.rib_bending[rib],
      {frame.rib_end[0][rib], frame.rib_end[1][rib]},
      {frame.hinge_stiffness[0][rib], frame.hinge_stiffness[1][rib]}};
  const double turn[2] = {joint[kJointTurn], joint[kJointTurn + 1]};
  RibReaction reaction = React(law, frame.state.q[6 + rib], turn, derivatives);
  const double* numbers = Numbers(reaction);
  const int count = derivatives ? kJointValues : kJointBy;
  for (int i = kJointStiffness; i < count; ++i) {
    joint[i] = static_cast<T>(numbers[i - kJointStiffness]);
  }
}

bool BendsTooFar(const LadderFrame<double>& frame) {
  if (!frame.joined) return false;
  for (int rib = 0; rib < frame.ribs; ++rib) {
    const double bow = frame.joints[kJointValues * rib + kJointBow];
    // Written so that a NaN is too far.
    if (!(bow <= kLargestBow * frame.rib_length[rib])) return true;
  }
  return false;
}

template void ReactInFrame(LadderFrame<double>&, int, bool);
template void ReactInFrame(LadderFrame<float>&, int, bool);

}  // namespace finray
