// The parts of a live page, without a server.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <sstream>
#include <thread>

#include "finray/estimation/zeroed_finger.h"
#include "finray/finger/finger_yaml.h"
#include "finray/statics/equilibrium.h"
#include "finray/view/live_feed.h"
#include "finray/view/live_hub.h"
#include "finray/view/live_server.h"
#include "finray/view/live_update.h"
#include "finray/view/live_zero.h"

namespace finray {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::vector<std::string> Texts(const LiveHub::News& news) {
  std::vector<std::string> texts;
  for (const LiveHub::Update& update : news.updates) texts.push_back(*update);
  return texts;
}

TEST(LiveHub, AReaderGetsEachUpdateOnceAndASlowOneTheLast) {
  LiveHub hub;
  hub.Publish("before");
  LiveHub::Reader fast, slow;
  for (LiveHub::Reader* reader : {&fast, &slow}) {
    const LiveHub::News news = hub.Next(reader, milliseconds(0));
    EXPECT_THAT(Texts(news), testing::ElementsAre("before"));
    EXPECT_TRUE(news.past);
  }
  EXPECT_TRUE(hub.Next(&fast, milliseconds(0)).updates.empty());
  hub.Publish("a");
  hub.Publish("b");
  const LiveHub::News news = hub.Next(&fast, milliseconds(0));
  EXPECT_THAT(Texts(news), testing::ElementsAre("a", "b"));
  EXPECT_FALSE(news.past);
  EXPECT_TRUE(hub.Next(&fast, milliseconds(0)).updates.empty());
  for (int i = 0; i < 1000; ++i) hub.Publish(std::to_string(i));
  const auto last = Texts(hub.Next(&slow, milliseconds(0)));
  EXPECT_EQ(last.size(), LiveHub::kUpdates);
  EXPECT_EQ(last.back(), "999");
}

TEST(LiveHub, ANewReaderGetsAllThatIsKept) {
  LiveHub hub;
  constexpr std::size_t kMore = 100;
  for (std::size_t i = 0; i < LiveHub::kKept + kMore; ++i) {
    hub.Publish(std::to_string(i));
  }
  LiveHub::Reader reader;
  std::size_t next = kMore;
  while (reader.in_past) {
    const LiveHub::News news = hub.Next(&reader, milliseconds(0));
    EXPECT_TRUE(news.past);
    ASSERT_LE(news.updates.size(), LiveHub::kUpdates);
    for (const std::string& text : Texts(news)) {
      ASSERT_EQ(text, std::to_string(next++));
    }
    // One more comes while it reads.
    if (next == kMore + LiveHub::kUpdates) {
      hub.Publish(std::to_string(LiveHub::kKept + kMore));
    }
  }
  EXPECT_EQ(next, LiveHub::kKept + kMore + 1);
}

TEST(LiveHub, ClosingWakesReaders) {
  LiveHub hub;
  std::thread closer([&] { hub.Close(); });
  LiveHub::Reader reader;
  const LiveHub::News news = hub.Next(&reader, milliseconds(60000));
  EXPECT_TRUE(news.updates.empty());
  EXPECT_TRUE(news.closed);
  closer.join();
}

TEST(LiveHub, TheEndComesWithTheLastUpdates) {
  LiveHub hub;
  LiveHub::Reader reader;
  hub.Publish("a");
  EXPECT_FALSE(hub.Next(&reader, milliseconds(0)).closed);
  hub.Publish("b");
  hub.Close();
  const LiveHub::News news = hub.Next(&reader, milliseconds(0));
  EXPECT_THAT(Texts(news), testing::ElementsAre("b"));
  EXPECT_TRUE(news.closed);
  // A late one first gets the past.
  LiveHub many;
  for (std::size_t i = 0; i <= LiveHub::kUpdates; ++i) many.Publish("a");
  many.Close();
  LiveHub::Reader late;
  EXPECT_FALSE(many.Next(&late, milliseconds(0)).closed);
  EXPECT_TRUE(many.Next(&late, milliseconds(0)).closed);
}

TEST(LiveFeed, KeepsTheOrderAndCountsWhatFindsItFull) {
  LiveFeed feed(2);
  Measurements readings;
  readings.gauges_V = {1, 2};
  FrameEstimate estimate;
  for (std::size_t i = 0; i < LiveFeed::kRows + 3; ++i) {
    readings.time_s = static_cast<double>(i);
    feed.Push(readings, estimate, i);
  }
  EXPECT_EQ(feed.missed(), 3u);
  LiveRow row;
  for (std::size_t i = 0; i < LiveFeed::kRows; ++i) {
    ASSERT_TRUE(feed.Pop(&row));
    EXPECT_EQ(row.time_s, static_cast<double>(i));
  }
  EXPECT_FALSE(feed.Pop(&row));
}

TEST(LiveFeed, TwoThreads) {
  LiveFeed feed(1);
  constexpr int kCount = 100000;
  std::thread writer([&] {
    Measurements readings;
    readings.gauges_V = {0};
    for (int i = 0; i < kCount; ++i) {
      readings.time_s = readings.gauges_V[0] = i;
      feed.Push(readings, {}, 0);
    }
  });
  LiveRow row;
  double before = -1;
  int seen = 0;
  while (before < kCount - 1 &&
         seen + static_cast<int>(feed.missed()) < kCount) {
    if (!feed.Pop(&row)) continue;
    ++seen;
    ASSERT_GT(row.time_s, before);
    ASSERT_EQ(row.gauges_V[0], row.time_s);
    before = row.time_s;
  }
  writer.join();
}

// Returns the residuals, in std, of an update: the last of its values.
std::vector<double> ResidualsOf(const std::string& update) {
  const std::string key = "\"last\":[";
  const auto begin = update.find(key) + key.size();
  std::stringstream cells(
      update.substr(begin, update.find(']', begin) - begin));
  std::vector<double> values;
  for (std::string cell; std::getline(cells, cell, ',');) {
    values.push_back(cell == "null" ? std::nan("") : std::stod(cell));
  }
  return {values.end() - 4, values.end()};
}

TEST(LiveUpdates, ResidualsHaveTheStdOfHysteresis) {
  const Finger finger =
      ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml");
  LiveFeed feed(4);
  LiveUpdates updates(finger, {}, 0);
  Measurements readings;
  readings.gauges_V = {0.02, 0.03, 0.04, 0.02};
  FrameEstimate estimate;
  estimate.status = FrameStatus::kOk;
  estimate.contact[0].arc_mm = 60;
  estimate.contact[0].normal_N = 1;
  feed.Push(readings, estimate, 1);
  const auto plain = ResidualsOf(updates.Next(&feed, "", false));
  for (const Gauge& gauge : finger.gauges) {
    readings.history_std_V.push_back(2 * gauge.noise_V);
  }
  readings.history_std_V[3] = 0;
  feed.Push(readings, estimate, 1);
  const auto wide = ResidualsOf(updates.Next(&feed, "", false));
  for (std::size_t j = 0; j < 4; ++j) {
    ASSERT_GT(std::abs(plain[j]), 1) << j;
    EXPECT_NEAR(plain[j] / wide[j], j < 3 ? std::sqrt(5) : 1, 1e-3) << j;
  }
}

class LiveZeroTest : public testing::Test {
 protected:
  std::unique_ptr<LiveEstimator> Make(const Finger& finger) {
    return std::make_unique<LiveEstimator>(
        std::make_unique<FrameEstimator>(finger, Scene()), Scene(), parser_,
        ResultFormat());
  }
  // Offers rows until the result is there.
  std::unique_ptr<LiveEstimator> Run(LiveZero* zero, double spread_V) {
    std::unique_ptr<LiveEstimator> made;
    for (int i = 0; i < 60000 && zero->busy(); ++i) {
      Measurements row;
      for (std::size_t j = 0; j < finger_.gauges.size(); ++j) {
        row.gauges_V.push_back(touch_V_[j] + (i % 2 ? spread_V : -spread_V));
      }
      rows_.push_back(row);
      zero->Offer(row);
      made = zero->Take();
      std::this_thread::sleep_for(milliseconds(1));
    }
    return made;
  }

  const Finger finger_ =
      ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml");
  const FrameParser parser_{
      "stdin",
      CsvLine{"time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V", 1},
      {}};
  std::vector<Measurements> rows_;
  std::vector<double> touch_V_{0, 0.01, 0.02, 0.03};  // what gauges read
};

TEST_F(LiveZeroTest, OffsetsAreThoseOfFinrayZero) {
  LiveZero zero(finger_, {}, [&](const Finger& f) { return Make(f); });
  EXPECT_EQ(zero.Take(), nullptr);
  EXPECT_THAT(zero.Request(), StartsWith("Zeroing: the next 100 rows"));
  EXPECT_THAT(zero.Request(), HasSubstr("already"));
  const auto made = Run(&zero, 1e-4);
  ASSERT_NE(made, nullptr);
  rows_.resize(LiveZero::kRows);
  const ZeroedFinger expected = ZeroGauges(finger_, {}, rows_, "stdin");
  for (std::size_t j = 0; j < finger_.gauges.size(); ++j) {
    EXPECT_EQ(made->estimator->finger().gauges[j].offset_V,
              expected.finger.gauges[j].offset_V);
    EXPECT_EQ(zero.finger().gauges[j].offset_V,
              expected.finger.gauges[j].offset_V);
  }
  EXPECT_THAT(zero.message(), StartsWith("Zeroed by 100 rows; moved by"));
  EXPECT_FALSE(zero.busy());
}

TEST_F(LiveZeroTest, AFingerThatMovesIsNotZeroed) {
  LiveZero zero(finger_, {}, [&](const Finger& f) { return Make(f); });
  zero.Request();
  EXPECT_EQ(Run(&zero, 0.1), nullptr);
  EXPECT_THAT(zero.message(), HasSubstr("Not zeroed: gauge_1_V varies by"));
  EXPECT_THAT(zero.message(), HasSubstr("at rest, and its gauges show it."));
  EXPECT_EQ(zero.finger().gauges[0].offset_V, finger_.gauges[0].offset_V);
  EXPECT_THAT(zero.Request(), StartsWith("Zeroing"));  // once more
}

TEST_F(LiveZeroTest, AFingerThatIsTouchedIsNotZeroed) {
  EquilibriumSolver solver(finger_, {});
  ASSERT_TRUE(solver.Solve({{60, 2}}));
  touch_V_.clear();
  for (std::size_t j = 0; j < finger_.gauges.size(); ++j) {
    touch_V_.push_back(
        finger_.gauges[j].Volts(solver.gauge_angle(static_cast<int>(j))));
  }
  LiveZero zero(finger_, {}, [&](const Finger& f) { return Make(f); });
  zero.Request();
  EXPECT_EQ(Run(&zero, 1e-4), nullptr);
  EXPECT_THAT(zero.message(),
              HasSubstr("Not zeroed: a contact of 2 N at 60 mm explains"));
  EXPECT_THAT(zero.message(), Not(HasSubstr("--allow_touch")));
  EXPECT_EQ(zero.finger().gauges[0].offset_V, finger_.gauges[0].offset_V);
}

// For ThreadSanitizer: the worker reads a parser that the estimating thread is
// still teaching the decimal mark.
TEST_F(LiveZeroTest, TheWorkerMakesItsEstimatorWhileTheDecimalMarkIsLearned) {
  FrameParser parser(
      "stdin", CsvLine{"time_s;gauge_1_V;gauge_2_V;gauge_3_V;gauge_4_V", 1},
      {});
  std::unique_ptr<LiveEstimator> made;
  std::thread worker([&] {
    made = std::make_unique<LiveEstimator>(
        std::make_unique<FrameEstimator>(finger_, Scene()), Scene(), parser,
        ResultFormat());
  });
  parser.LearnDecimal({"1;0;0;0;0", 2});
  EXPECT_FALSE(parser.decimal_settled());
  parser.LearnDecimal({"2;0,5;0;0;0", 3});
  EXPECT_TRUE(parser.decimal_settled());
  worker.join();
  EXPECT_THAT(made->rows.Next({"3;0,25;0;0;0", 4}), StartsWith("3,0.25,0,0,0"));
}

TEST(LiveServer, ItEndsWhereNobodyHasConnected) {
  for (int i = 0; i < 50; ++i) {
    const LiveHub hub;
    const LiveServer server({}, {}, &hub);
    EXPECT_GT(server.port(), 0);
  }
}

TEST(LiveServer, OnlyThisMachineIsALoopback) {
  for (const char* address : {"127.0.0.1", "127.1.2.3", "localhost", "::1"}) {
    EXPECT_TRUE(IsLoopback(address)) << address;
  }
  for (const char* address :
       {"0.0.0.0", "::", "192.168.1.2", "example.org", ""}) {
    EXPECT_FALSE(IsLoopback(address)) << address;
  }
}

}  // namespace
}  // namespace finray
