#include "finray/view/log_channels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "finray/finger/finger_yaml.h"
#include "finray/io/error.h"
#include "finray/scene/simulation.h"
#include "finray/view/log_page.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class LogChannelsTest : public testing::Test {
 protected:
  const Channel* Find(const LogChannels& log, const std::string& name) {
    for (const Channel& channel : log.channels) {
      if (channel.name == name) return &channel;
    }
    return nullptr;
  }
  LogChannels Read(const std::string& csv, const Finger* finger = nullptr) {
    return ReadLogChannels(folder_.Write("a.frames.csv", csv), finger, {});
  }
  void ExpectError(const std::string& csv, const std::string& words,
                   const Finger* finger = nullptr) {
    try {
      Read(csv, finger);
      ADD_FAILURE() << words;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
    }
  }

  const Finger finger_ =
      ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml");
  TempFolder folder_;
};

TEST_F(LogChannelsTest, ValuesSpreadsGapsAndStatus) {
  const LogChannels log = Read(
      "time_s,contact_1_mm,contact_1_low_mm,contact_1_high_mm,normal_1_N,"
      "chi2_p_value,force_x_N,force_y_N,status\n"
      "0,50,49,53,2,0.5,3,4,ok\n"
      "0.1,,,,0,1e-20,,,no_contact\n"
      ",,,,,,,,bad_input\n"
      "0.3,60,59,61,1,0.9,0,1,unobservable\n");
  EXPECT_EQ(log.name, "a");
  EXPECT_EQ(log.frames, 4u);
  EXPECT_TRUE(log.has_time);
  EXPECT_THAT(log.time_s, ElementsAre(0, 0.1, 0.1, 0.3));
  EXPECT_THAT(log.status, ElementsAre(1, 2, 16, 4));
  EXPECT_EQ(log.most_force_N, 2);
  const Channel* place = Find(log, "contact_1_mm");
  ASSERT_NE(place, nullptr);
  EXPECT_EQ(place->values[0], 50);
  EXPECT_TRUE(std::isnan(place->values[1]));
  EXPECT_EQ(Find(log, "contact_1_mm_below")->values[0], 1);
  EXPECT_EQ(Find(log, "contact_1_mm_above")->values[0], 3);
  EXPECT_EQ(Find(log, "force_N")->values[0], 5);
  EXPECT_TRUE(std::isnan(Find(log, "force_N")->values[1]));
  EXPECT_EQ(Find(log, "contact_1_std_mm"), nullptr);
  EXPECT_EQ(Find(log, "gauge_1_residual_std"), nullptr);
}

TEST_F(LogChannelsTest, WithoutGoodTimesFramesAreNumbered) {
  const std::string head = "time_s,contact_1_mm,normal_1_N,status\n";
  LogChannels log = Read(head + "1,,0,no_contact\n0.5,,0,no_contact\n");
  EXPECT_FALSE(log.has_time);
  EXPECT_THAT(log.time_s, ElementsAre(0, 1));
  log = Read("contact_1_mm,normal_1_N,status\n,0,no_contact\n,0,no_contact\n");
  EXPECT_FALSE(log.has_time);
  EXPECT_THAT(log.time_s, ElementsAre(0, 1));
}

TEST_F(LogChannelsTest, ResidualsAreWhatWasAddedToTheReadings) {
  FrameTable frames(3);
  frames.MutableNumbers("contact_1_mm") = {60, 80, 100};
  frames.MutableNumbers("normal_1_N") = {2, 3, 1};
  Simulate(finger_, {}, {}, &frames);
  frames.MutableNumbers("gauge_2_V")[1] += 3 * finger_.gauges[1].noise_V;
  frames.MutableNumbers("gauge_3_V")[2] += 100 * finger_.gauges[2].noise_V;
  const LogChannels log = Read(frames.ToCsv(), &finger_);
  const Channel* second = Find(log, "gauge_2_residual_std");
  ASSERT_NE(second, nullptr);
  EXPECT_NEAR(second->values[0], 0, 1e-6);
  EXPECT_NEAR(second->values[1], 3, 1e-4);
  // The page cuts it, the channel does not.
  EXPECT_NEAR(Find(log, "gauge_3_residual_std")->values[2], 100, 1e-3);
  EXPECT_EQ(Find(log, "gauge_3_residual_std")->Scale().high,
            LogChannels::kMostResidual);
}

TEST_F(LogChannelsTest, WhatIsNoResult) {
  ExpectError("time_s,gauge_1_V\n0,1\n", "expected a <log>.frames.csv");
  ExpectError("contact_1_mm,normal_1_N,status\n1,1,fine\n",
              "a.frames.csv:2: no status 'fine', expected ok, no_contact");
  ExpectError("contact_1_mm,normal_1_N,status\n1,x,ok\n", "a.frames.csv:2:2");
  ExpectError("contact_1_mm,normal_1_N,status\n", "no rows");
  ExpectError("gauge_1_V,contact_1_mm,normal_1_N,status\n0,1,1,ok\n",
              "gauge_2_V", &finger_);
  // A result without gauges is fine.
  EXPECT_EQ(Read("contact_1_mm,normal_1_N,status\n1,1,ok\n", &finger_).frames,
            1u);
}

// Noise in all channels, which compresses least.
LogChannels NoisyLog(std::size_t frames, int channels) {
  LogChannels log;
  log.name = "noisy";
  log.frames = frames;
  std::uint32_t random = 1;
  const auto next = [&] {
    random = random * 1664525 + 1013904223;
    return static_cast<float>(random >> 8);
  };
  for (std::size_t i = 0; i < frames; ++i) {
    log.time_s.push_back(1e-3 * static_cast<double>(i));
    log.status.push_back(static_cast<std::uint16_t>(1 << (i / 1000 % 5)));
  }
  for (int c = 0; c < channels; ++c) {
    Channel channel;
    channel.name = "channel_" + std::to_string(c);
    channel.bits = c % 2 == 0 ? 16 : 8;
    channel.values.resize(frames);
    for (float& value : channel.values) value = next();
    log.channels.push_back(std::move(channel));
  }
  return log;
}

TEST(LogPageJson, KeepsEveryFrameWhereItFitsAndBinsWhereNot) {
  const LogChannels log = NoisyLog(20000, 10);
  const std::string whole = LogPageJson({{&log, {}}}, nullptr, {});
  EXPECT_THAT(whole, HasSubstr("\"frames_per_bin\":1,"));
  const std::size_t limit = whole.size() / 3;
  const std::string small = LogPageJson({{&log, {}}}, nullptr, {}, limit);
  EXPECT_LT(small.size(), limit);
  EXPECT_THAT(small, HasSubstr("\"frames_per_bin\":8,"));
  // What cannot fit ends with one bin.
  EXPECT_THAT(LogPageJson({{&log, {}}}, nullptr, {}, 1),
              HasSubstr("\"frames_per_bin\":65536,"));
}

TEST(LogPageJson, SlowAMillionFramesOfNoiseAreWithin30MB) {
  const LogChannels log = NoisyLog(1'000'000, 25);
  const std::string json = LogPageJson({{&log, {}}}, nullptr, {});
  EXPECT_LT(json.size(), 29'100'000u);
}

}  // namespace
}  // namespace finray
