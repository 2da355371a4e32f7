#ifndef FINRAY_LADDER_RIB_LAW_H_
#define FINRAY_LADDER_RIB_LAW_H_

#include "finray/ladder/ladder_frame.h"

namespace finray {

// A rib that resists the turns a = (a_F, a_B) of its beams against the line
// between its hinges. With the tension T along that line its energy is
//
//   Phi(T, a) = a' H(T) a / 2,
//   m = H a                               the moments of its ends,
//   d = L (1 + T / EA) - a' H_T a / 2     the distance of its hinges,
//
// where H_T = dH/dT, and a' H_T a / 2 is how much bending shortens the line.
//
// On hinge springs alone H = diag(k_F, k_B). A rib that bends is a beam-column
// of length L_e = L - e_F - e_B between rigid ends of lengths e_F, e_B. Between
// its ends EI w'''' = T w'', so turns of w' are small against the line between
// the hinges while that line turns at will, and with
//
//   y = T L_e^2 / 4 EI,   g(y) = sqrt(y) coth(sqrt(y)),
//
// the stiffness against turns of both ends alike is 2 y / (g - 1) EI / L_e, and
// against opposite turns 2 g EI / L_e. For T = 0 they are 6 and 2; g = -inf at
// y = -pi^2, where the rib buckles. With the turns alpha of its ends,
//
//   G = B' K(T) B + T R   for rigid ends (rib_law.cc),
//   alpha = W a, W = (k + G)^-1 k,  H = G W,  H_T = W' G_T W  for springs
//   k in series. A clamped end has alpha = a.
//
// All numbers are in units of the ladder.

struct RibLaw {
  double length, bending_stiffness;  ///< L and EI; 0: the rib is rigid.
  double end[2];                     ///< e_F, e_B.
  double hinge_stiffness[2];         ///< Infinite: the end is clamped.
};

/// How a rib answers T and a.
struct RibReaction {
  double stiffness[3];          ///< H: front, front by back, back.
  double moment[2];             ///< m = H a.
  double moment_by_tension[2];  ///< H_T a, which is d(bow)/da too.
  double bow, bow_by_tension;   ///< a' H_T a / 2, and its derivative by T.
  /// Derivatives of (m_F, m_B, bow) by L, by EI and by the k of both springs.
  double by[3][3];
};

/// Past its buckling load the rib has no answer: all numbers are NaN. Without
/// `derivatives`, `by` is not filled.
RibReaction React(const RibLaw& law, double tension, const double turn[2],
                  bool derivatives);

/// Fills the joint of a rib from its turns and its tension.
template <class T>
void ReactInFrame(LadderFrame<T>& frame, int rib, bool derivatives);

/// Says that a rib bends so far that the equations above do not hold: bending
/// shortens it by more than 4 %, as an arc of half a rad at both ends does.
bool BendsTooFar(const LadderFrame<double>& frame);

}  // namespace finray

#endif  // FINRAY_LADDER_RIB_LAW_H_
