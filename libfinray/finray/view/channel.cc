#include "finray/view/channel.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "finray/view/json_text.h"

namespace finray {
namespace {

std::string Deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), 6) != Z_OK) {
    throw std::runtime_error("zlib cannot compress: out of memory");
  }
  packed.resize(size);
  return packed;
}

// Appends a byte of the differences of neighbouring words, `shift` bits up.
template <class Word>
void AppendPlane(const std::vector<Word>& words, int shift,
                 std::string* bytes) {
  Word before = 0;
  for (const Word word : words) {
    *bytes += static_cast<char>(static_cast<Word>(word - before) >> shift);
    before = word;
  }
}

}  // namespace

std::uint16_t ChannelScale::Code(double value) const {
  if (std::isnan(value)) return 0;
  double share = 0;
  if (high > low) {
    share = logarithmic
                ? std::log(std::max(value, low) / low) / std::log(high / low)
                : (value - low) / (high - low);
  }
  share = std::min(1.0, std::max(0.0, share));
  return static_cast<std::uint16_t>(1 + std::lround(share * (codes() - 1)));
}

double ChannelScale::Value(std::uint16_t code) const {
  if (code == 0) return std::nan("");
  const double share = static_cast<double>(code - 1) / (codes() - 1);
  return logarithmic ? low * std::pow(high / low, share)
                     : low + (high - low) * share;
}

bool Channel::IsEmpty() const {
  return std::all_of(values.begin(), values.end(),
                     [](float value) { return std::isnan(value); });
}

ChannelScale Channel::Scale() const {
  ChannelScale scale{bits, logarithmic, low, high};
  if (low < high) return scale;
  scale.low = std::numeric_limits<double>::infinity();
  scale.high = -scale.low;
  for (const float value : values) {
    if (!std::isfinite(value) || (logarithmic && value <= 0)) continue;
    scale.low = std::min<double>(scale.low, value);
    scale.high = std::max<double>(scale.high, value);
  }
  if (scale.low > scale.high) scale.low = scale.high = logarithmic ? 1 : 0;
  return scale;
}

ChannelBins BinChannel(const Channel& channel, const ChannelScale& scale,
                       std::size_t frames_per_bin) {
  ChannelBins bins;
  const std::vector<float>& values = channel.values;
  for (std::size_t first = 0; first < values.size(); first += frames_per_bin) {
    const std::size_t end = std::min(values.size(), first + frames_per_bin);
    std::uint16_t least = 0, most = 0;
    for (std::size_t i = first; i < end; ++i) {
      const std::uint16_t code = scale.Code(values[i]);
      if (code == 0) continue;
      least = least == 0 ? code : std::min(least, code);
      most = std::max(most, code);
    }
    bins.least.push_back(least);
    if (frames_per_bin > 1) bins.most.push_back(most);
  }
  return bins;
}

std::string PackCodes(const std::vector<std::uint16_t>& codes, int bits) {
  std::string bytes;
  bytes.reserve(codes.size() * static_cast<std::size_t>(bits / 8));
  if (bits == 8) {
    for (const std::uint16_t code : codes) bytes += static_cast<char>(code);
  } else {
    AppendPlane(codes, 8, &bytes);
    AppendPlane(codes, 0, &bytes);
  }
  return Base64(Deflated(bytes));
}

std::string PackWords(const std::vector<std::uint32_t>& words) {
  std::string bytes;
  bytes.reserve(4 * words.size());
  for (const int shift : {24, 16, 8, 0}) AppendPlane(words, shift, &bytes);
  return Base64(Deflated(bytes));
}

std::string ChannelJson(const Channel& channel, std::size_t frames_per_bin) {
  const ChannelScale scale = channel.Scale();
  const ChannelBins bins = BinChannel(channel, scale, frames_per_bin);
  const auto packed = [&](const std::vector<std::uint16_t>& codes) {
    return '"' + PackCodes(codes, channel.bits) + '"';
  };
  JsonObject json;
  json.Add("name", JsonText(channel.name))
      .Add("bits", std::to_string(channel.bits))
      .Add("log", channel.logarithmic ? "true" : "false")
      .Add("low", JsonNumber(scale.low))
      .Add("high", JsonNumber(scale.high))
      .Add("least", packed(bins.least));
  if (frames_per_bin > 1) json.Add("most", packed(bins.most));
  return json.str();
}

std::string TimeJson(const std::vector<double>& time_s,
                     std::size_t frames_per_bin) {
  std::vector<double> times;
  for (std::size_t i = 0; i < time_s.size(); i += frames_per_bin) {
    times.push_back(time_s[i]);
  }
  const double start = times.front();
  const double span = times.back() - start;
  const double step =
      times.size() > 1 ? span / static_cast<double>(times.size() - 1) : 1;
  bool even = step > 0;
  for (std::size_t i = 0; even && i < times.size(); ++i) {
    const double place = start + step * static_cast<double>(i);
    even = std::abs(times[i] - place) <= 0.01 * step;
  }
  JsonObject json;
  json.Add("start", JsonNumber(start));
  if (even) return json.Add("step", JsonNumber(step)).str();
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> words;
  for (const double time : times) {
    words.push_back(static_cast<std::uint32_t>(
        span > 0 ? std::round((time - start) / span * kMost) : 0));
  }
  return json.Add("end", JsonNumber(times.back()))
      .Add("words", '"' + PackWords(words) + '"')
      .str();
}

}  // namespace finray
