#ifndef FINRAY_LADDER_ROUND_UP_H_
#define FINRAY_LADDER_ROUND_UP_H_

namespace finray {

/// Returns the least multiple that is not below `value`. Arrays that vector
/// lanes run over are padded to it.
constexpr int RoundUp(int value, int multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

}  // namespace finray

#endif  // FINRAY_LADDER_ROUND_UP_H_
