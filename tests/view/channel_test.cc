#include "finray/view/channel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <random>

#include "finray/view/json_text.h"

namespace finray {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::string FromBase64(const std::string& text) {
  const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<unsigned>(digits.find(c));
    bits += 6;
    if (bits >= 8) bytes += static_cast<char>(word >> (bits -= 8));
  }
  return bytes;
}

std::string Inflated(const std::string& packed, std::size_t size) {
  std::string bytes(size, '\0');
  uLongf length = size;
  EXPECT_EQ(
      uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                 reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
      Z_OK);
  EXPECT_EQ(length, size);
  return bytes;
}

TEST(ChannelScale, IsOffByHalfAStepAtMost) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-3, 140);
  for (const int bits : {8, 16}) {
    const ChannelScale scale{bits, false, -3, 140};
    const double step = 143.0 / (scale.codes() - 1);
    double worst = 0;
    for (int i = 0; i < 10000; ++i) {
      const double value = uniform(random);
      worst = std::max(worst, std::abs(scale.Value(scale.Code(value)) - value));
    }
    EXPECT_LE(worst, 0.5 * step * (1 + 1e-9));
    EXPECT_GT(worst, 0.45 * step);  // the bound is tight
  }
}

TEST(ChannelScale, ALogarithmIsOffByHalfAStepOfTheRatio) {
  const ChannelScale scale{8, true, 1e-12, 1};
  const double step = std::pow(1e12, 1.0 / 254);
  for (double value = 1e-12; value < 1; value *= 1.37) {
    const double ratio = scale.Value(scale.Code(value)) / value;
    EXPECT_LE(std::abs(std::log(ratio)), 0.5 * std::log(step) * (1 + 1e-9));
  }
  EXPECT_EQ(scale.Value(scale.Code(0)), 1e-12);
}

TEST(ChannelScale, NaNAndTheEndsOfTheRange) {
  const ChannelScale scale{16, false, 2, 5};
  EXPECT_EQ(scale.Code(std::nan("")), 0);
  EXPECT_TRUE(std::isnan(scale.Value(0)));
  EXPECT_EQ(scale.Value(scale.Code(2)), 2);
  EXPECT_EQ(scale.Value(scale.Code(5)), 5);
  EXPECT_EQ(scale.Value(scale.Code(-1e30)), 2);
  EXPECT_EQ(scale.Value(scale.Code(INFINITY)), 5);
  const ChannelScale constant{16, false, 2, 2};
  EXPECT_EQ(constant.Value(constant.Code(2)), 2);
}

TEST(Channel, RangeIsThatOfItsFiniteValues) {
  Channel channel{"x", 16, false, 0, 0, {3, NAN, -1, 2, INFINITY}};
  EXPECT_EQ(channel.Scale().low, -1);
  EXPECT_EQ(channel.Scale().high, 3);
  channel.logarithmic = true;
  EXPECT_EQ(channel.Scale().low, 2);
  EXPECT_FALSE(channel.IsEmpty());
  channel.values = {NAN, NAN};
  EXPECT_TRUE(channel.IsEmpty());
}

TEST(Channel, BinsKeepLeastAndLargestAndGaps) {
  std::mt19937 random(2);
  std::normal_distribution<float> normal;
  Channel channel{"x", 16, false, -6, 6, {}};
  for (int i = 0; i < 1003; ++i) {
    channel.values.push_back(i / 16 % 5 == 3 || i % 7 == 0 ? NAN
                                                           : normal(random));
  }
  channel.values[500] = 5.9f;  // a spike of one frame
  const ChannelScale scale = channel.Scale();
  for (const std::size_t size : {1, 4, 16, 64}) {
    const ChannelBins bins = BinChannel(channel, scale, size);
    ASSERT_EQ(bins.least.size(), (1003 + size - 1) / size);
    ASSERT_EQ(bins.most.size(), size > 1 ? bins.least.size() : 0);
    for (std::size_t b = 0; b < bins.least.size(); ++b) {
      float least = NAN, most = NAN;
      for (std::size_t i = b * size;
           i < std::min<std::size_t>(1003, (b + 1) * size); ++i) {
        least = std::fmin(least, channel.values[i]);
        most = std::fmax(most, channel.values[i]);
      }
      EXPECT_EQ(bins.least[b], scale.Code(least)) << size << " " << b;
      if (size > 1) {
        EXPECT_EQ(bins.most[b], scale.Code(most)) << size << " " << b;
      }
    }
  }
}

TEST(PackCodes, AreDifferencesInBytePlanes) {
  const std::vector<std::uint16_t> codes = {0, 65535, 3, 3, 40000};
  const std::string bytes = Inflated(FromBase64(PackCodes(codes, 16)), 10);
  std::uint16_t code = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    code = static_cast<std::uint16_t>(
        code + (static_cast<unsigned char>(bytes[i]) << 8 |
                static_cast<unsigned char>(bytes[5 + i])));
    EXPECT_EQ(code, codes[i]);
  }
  EXPECT_EQ(Inflated(FromBase64(PackCodes({1, 2, 255}, 8)), 3), "\1\2\377");
}

TEST(TimeJson, EvenTimesAreTwoNumbers) {
  std::vector<double> times;
  for (int i = 0; i < 100; ++i) times.push_back(5 + 0.05 * i + 1e-4 * (i % 3));
  EXPECT_THAT(TimeJson(times, 1), StartsWith("{\"start\":5,\"step\":"));
  EXPECT_THAT(TimeJson(times, 4), StartsWith("{\"start\":5,\"step\":"));
  times[50] += 0.02;  // late
  EXPECT_THAT(TimeJson(times, 1), HasSubstr("\"words\":"));
}

TEST(TimeJson, UnevenTimesAreGoodToAFractionOfTheirSpan) {
  const std::vector<double> times = {10, 10, 11.5, 700, 86410};
  const std::string json = TimeJson(times, 1);
  const std::string key = "\"words\":\"";
  const std::size_t begin = json.find(key) + key.size();
  const std::string bytes = Inflated(
      FromBase64(json.substr(begin, json.find('"', begin) - begin)), 20);
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    std::uint32_t difference = 0;
    for (std::size_t plane = 0; plane < 4; ++plane) {
      difference =
          difference << 8 | static_cast<unsigned char>(bytes[5 * plane + i]);
    }
    word += difference;
    EXPECT_NEAR(10 + 86400 * (word / 4294967295.0), times[i],
                86400 / 4294967295.0);
  }
}

TEST(TimeJson, OneFrame) {
  EXPECT_EQ(TimeJson({3}, 1), "{\"start\":3,\"step\":1}");
}

TEST(JsonText, IsSafeInAScript) {
  EXPECT_EQ(JsonText("</script><b>"), "\"\\u003c/script>\\u003cb>\"");
  EXPECT_EQ(JsonText("a\"\\\n"), "\"a\\u0022\\u005c\\u000a\"");
  EXPECT_EQ(JsonText("µ€😀"), "\"µ€😀\"");
  EXPECT_EQ(JsonText("\xFF\xC3\xED\xA0\x80"), "\"?????\"");
  EXPECT_EQ(JsonNumber(std::nan("")), "null");
  EXPECT_EQ(JsonObject().Add("a", "1").Add("b", JsonNumbers({1, 2.5})).str(),
            "{\"a\":1,\"b\":[1,2.5]}");
}

TEST(Base64, EveryRemainder) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace finray
