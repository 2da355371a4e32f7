#ifndef FINRAY_LADDER_PUT_LANES_H_
#define FINRAY_LADDER_PUT_LANES_H_

#include "finray/ladder/lanes.h"

namespace finray {

/// Puts a value into one lane, or into all if `lane` is negative.
template <class T>
void Put(double value, int lane, T* to) {
  constexpr int kLanes = sizeof(T) / sizeof(Number<T>);
  for (int i = 0; i < kLanes; ++i) {
    if (lane < 0 || lane == i) LaneOf(*to, i) = static_cast<Number<T>>(value);
  }
}
template <class T>
void Put(double value, T* to) {
  Put(value, -1, to);
}

}  // namespace finray

#endif  // FINRAY_LADDER_PUT_LANES_H_
