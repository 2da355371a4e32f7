#ifndef FINRAY_VIEW_CHANNEL_H_
#define FINRAY_VIEW_CHANNEL_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace finray {

/// How a page keeps the values of a channel: as codes of 8 or 16 bits. Code 0
/// is NaN; the others, 1 to n = 2^bits - 1, divide the range from `low` to
/// `high` evenly,
///
///   value = low + (high - low) (code - 1) / (n - 1),
///
/// or evenly in the logarithm,
///
///   value = low (high / low)^((code - 1) / (n - 1)).
///
/// A value within the range is off by at most half a step. A value beyond the
/// range gets its end.
struct ChannelScale {
  int bits = 16;
  bool logarithmic = false;
  double low = 0, high = 1;

  std::uint16_t Code(double value) const;
  double Value(std::uint16_t code) const;
  int codes() const { return (1 << bits) - 1; }
};

/// A channel before it is packed: one value for each frame, NaN where there is
/// none.
struct Channel {
  std::string name;
  int bits = 16;
  bool logarithmic = false;
  /// The range. Where low >= high it is that of the values (of the positive
  /// ones, for a logarithm).
  double low = 0, high = 0;
  std::vector<float> values;

  bool IsEmpty() const;  ///< No frame has a value.
  ChannelScale Scale() const;
};

/// The codes of a channel: of each bin of `frames_per_bin` frames the least and
/// the largest. A bin has the code 0 only if all its frames are NaN. With one
/// frame in a bin `most` is empty.
struct ChannelBins {
  std::vector<std::uint16_t> least, most;
};
ChannelBins BinChannel(const Channel& channel, const ChannelScale& scale,
                       std::size_t frames_per_bin);

/// Returns codes as base64 of a zlib stream: codes of 16 bits as differences to
/// the code before (modulo 2^16), all high bytes first and then all low bytes;
/// codes of 8 bits as they are.
std::string PackCodes(const std::vector<std::uint16_t>& codes, int bits);
/// The same of numbers of 32 bits, as differences and byte by byte, the highest
/// bytes first.
std::string PackWords(const std::vector<std::uint32_t>& words);

/// Returns a channel as a JSON object {name, bits, log, low, high, least,
/// most}.
std::string ChannelJson(const Channel& channel, std::size_t frames_per_bin);

/// Returns the times of bins as a JSON object. Times must not decrease.
///  - {start, step}: evenly spaced within 1 % of a step;
///  - {start, end, words}: start + (end - start) word / (2^32 - 1).
std::string TimeJson(const std::vector<double>& time_s,
                     std::size_t frames_per_bin);

}  // namespace finray

#endif  // FINRAY_VIEW_CHANNEL_H_
