#ifndef FINRAY_ESTIMATION_PARABOLA_SLOPE_H_
#define FINRAY_ESTIMATION_PARABOLA_SLOPE_H_

#include <algorithm>
#include <cstddef>

namespace finray {

/// The slope at node `k` of the parabola through it and its neighbours, or
/// through three nodes at an end. There are `count` >= 3 nodes, at `place(i)`
/// with the numbers or vectors `value(i)`.
template <class PlaceOf, class ValueOf>
auto ParabolaSlope(std::size_t count, std::size_t k, const PlaceOf& place,
                   const ValueOf& value) {
  using Value = decltype(value(k));
  const std::size_t middle = std::clamp<std::size_t>(k, 1, count - 2);
  const double a = place(middle - 1), b = place(middle), c = place(middle + 1);
  const Value left = (value(middle) - value(middle - 1)) / (b - a),
              right = (value(middle + 1) - value(middle)) / (c - b);
  return Value(left + (right - left) * ((2 * place(k) - a - b) / (c - a)));
}

}  // namespace finray

#endif  // FINRAY_ESTIMATION_PARABOLA_SLOPE_H_
