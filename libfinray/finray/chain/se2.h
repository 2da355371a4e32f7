#ifndef FINRAY_CHAIN_SE2_H_
#define FINRAY_CHAIN_SE2_H_

#include <Eigen/Core>
#include <cmath>

namespace finray {

// SE(2), the planar subgroup of the paper's SE(3): poses, exp and ln of (1) and
// (4), Adjoint, Lie bracket. Twists and wrenches have three components instead
// of six:
//
//   twist  (omega, v_x, v_y)   rad and mm; v is the velocity of the point of
//                              the body that passes the origin of S,
//   wrench (m, f_x, f_y)       N mm and N; m is the moment about that origin,
//
// so that twist . wrench is power. The scalar is a template parameter, as it
// may be a ceres::Jet.

template <typename T>
using Vector2 = Eigen::Matrix<T, 2, 1>;
template <typename T>
using Twist = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Wrench = Eigen::Matrix<T, 3, 1>;

/// The z component of a x b.
template <typename A, typename B>
typename A::Scalar Cross(const A& a, const B& b) {
  return a[0] * b[1] - a[1] * b[0];
}

/// a turned by 90 degrees counter-clockwise: e_z x a.
template <typename T>
Vector2<T> Turned(const Vector2<T>& a) {
  return Vector2<T>(-a[1], a[0]);
}

/// An element of SE(2): p -> R p + t with R = [c -s; s c].
template <typename T>
struct Pose {
  T c = T(1), s = T(0);
  Vector2<T> t = Vector2<T>(T(0), T(0));

  Vector2<T> Rotate(const Vector2<T>& p) const {
    return Vector2<T>(c * p[0] - s * p[1], s * p[0] + c * p[1]);
  }
  Vector2<T> operator*(const Vector2<T>& p) const { return Rotate(p) + t; }
  Pose operator*(const Pose& b) const {
    return {c * b.c - s * b.s, s * b.c + c * b.s, *this * b.t};
  }
  Pose Inverse() const {
    Pose inverse{c, -s, t};
    inverse.t = -inverse.Rotate(t);
    return inverse;
  }
};

/// The pose with axes turned by `angle` and its origin at `t`.
template <typename T>
Pose<T> MakePose(const T& angle, const Vector2<T>& t) {
  using std::cos;
  using std::sin;
  return {cos(angle), sin(angle), t};
}

/// The twist of unit rotation about a point, zeta of (1): (1, -e_z x point).
template <typename T>
Twist<T> RevoluteTwist(const Vector2<T>& point) {
  return Twist<T>(T(1), point[1], -point[0]);
}

/// The wrench of a force at a point, (8) and (15).
template <typename T>
Wrench<T> ForceWrench(const Vector2<T>& point, const Vector2<T>& force) {
  return Wrench<T>(Cross(point, force), force[0], force[1]);
}

/// The velocity that a twist gives to a point: Gamma of (21) times the twist.
template <typename T>
Vector2<T> Velocity(const Twist<T>& twist, const Vector2<T>& point) {
  return Vector2<T>(twist[1] - twist[0] * point[1],
                    twist[2] + twist[0] * point[0]);
}

/// The exponential of a twist's matrix, as in (1).
template <typename T>
Pose<T> Exp(const Twist<T>& twist) {
  using std::cos;
  using std::sin;
  const T& w = twist[0];
  const T c = cos(w), s = sin(w);
  // sin(w) / w and (1 - cos(w)) / w. Near 0 the quotients lose digits, so there
  // a series serves.
  T a, b;
  const T w2 = w * w;
  if (w2 < T(1e-2)) {
    a = 1. - w2 / 6. * (1. - w2 / 20. * (1. - w2 / 42. * (1. - w2 / 72.)));
    b = w / 2. *
        (1. - w2 / 12. * (1. - w2 / 30. * (1. - w2 / 56. * (1. - w2 / 90.))));
  } else {
    a = s / w;
    b = (T(1) - c) / w;
  }
  return {c, s,
          Vector2<T>(a * twist[1] - b * twist[2], b * twist[1] + a * twist[2])};
}

/// h cot(h) with h = angle / 2, and half its derivative by h in *slope if that
/// is not null.
template <typename T>
T HalfAngleCotangent(const T& angle, T* slope = nullptr) {
  using std::cos;
  using std::sin;
  const T h = angle / T(2), h2 = h * h;
  if (h2 < T(1e-3)) {
    if (slope) {
      *slope =
          -h / T(3) *
          (T(1) + h2 * (T(2. / 15) + h2 * (T(2. / 105) + h2 * T(4. / 1575))));
    }
    return T(1) -
           h2 * (T(1. / 3) +
                 h2 * (T(1. / 45) + h2 * (T(2. / 945) + h2 * T(1. / 4725))));
  }
  const T cot = cos(h) / sin(h);
  if (slope) *slope = (cot - h * (T(1) + cot * cot)) / T(2);
  return h * cot;
}

/// The inverse of Exp, ln of (4), with |omega| <= pi.
template <typename T>
Twist<T> Log(const Pose<T>& g) {
  using std::atan2;
  const T w = atan2(g.s, g.c);
  const T a = HalfAngleCotangent(w), b = w / T(2);
  return Twist<T>(w, a * g.t[0] + b * g.t[1], a * g.t[1] - b * g.t[0]);
}

/// The derivative of Log: d Log(g) = LogJacobian(g) xi for (dg g^-1)^vee = xi.
/// At g = 1 it is the identity, which the paper takes everywhere in (5).
inline Eigen::Matrix3d LogJacobian(const Pose<double>& g) {
  const double w = std::atan2(g.s, g.c);
  double slope;
  const double a = HalfAngleCotangent(w, &slope), b = w / 2;
  Eigen::Matrix2d inverse, d_inverse;  // of the matrix that takes v to t
  inverse << a, b, -b, a;
  d_inverse << slope, 0.5, -0.5, slope;
  Eigen::Matrix3d jacobian;
  jacobian << 1, 0, 0, 0, a, b, 0, -b, a;
  jacobian.block<2, 1>(1, 0) = d_inverse * g.t + inverse * Turned<double>(g.t);
  return jacobian;
}

/// Ad(g) twist: a twist given in the frame of g, seen from S.
template <typename T>
Twist<T> Adjoint(const Pose<T>& g, const Twist<T>& twist) {
  const Vector2<T> v = g.Rotate(Vector2<T>(twist[1], twist[2]));
  return Twist<T>(twist[0], v[0] + twist[0] * g.t[1], v[1] - twist[0] * g.t[0]);
}

/// The Lie bracket [a, b] = d Ad(exp(a e)) b / de at e = 0.
template <typename T>
Twist<T> Bracket(const Twist<T>& a, const Twist<T>& b) {
  return Twist<T>(T(0), b[0] * a[2] - a[0] * b[2], a[0] * b[1] - b[0] * a[1]);
}

}  // namespace finray

#endif  // FINRAY_CHAIN_SE2_H_
