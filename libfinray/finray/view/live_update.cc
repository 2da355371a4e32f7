#include "finray/view/live_update.h"

#include <cmath>

#include "finray/io/number_text.h"
#include "finray/io/versions.h"
#include "finray/scene/frame_columns.h"
#include "finray/view/json_text.h"

namespace finray {
namespace {

// As many digits as a page can show.
std::string Shown(double value) {
  return std::isfinite(value) ? FormatText("%.5g", value) : "null";
}

std::string ShownAll(const std::vector<double>& values) {
  JsonArray array;
  for (const double value : values) array.Add(Shown(value));
  return array.str();
}

}  // namespace

LiveUpdates::LiveUpdates(const Finger& finger,
                         const Discretization& discretization, double friction)
    : friction_(friction),
      nodes_(finger),
      solver_(finger, discretization),
      found_(finger.gauges.size()) {
  for (int c = 0; c < 2; ++c) {
    for (const std::string& name :
         {ContactArc(c), ContactArcStd(c), ContactArc(c) + "_below",
          ContactArc(c) + "_above", NormalForce(c), NormalForceStd(c),
          NormalForce(c) + "_below", NormalForce(c) + "_above"}) {
      names_.push_back(name);
    }
  }
  names_.push_back("force_N");
  names_.push_back("chi2_p_value");
  for (int j = 0; j < static_cast<int>(found_.size()); ++j) {
    names_.push_back(IndexedColumn("gauge_", j, "_residual_std"));
  }
}

std::string LiveUpdates::PageJson(const std::string& name) const {
  JsonArray names;
  for (const std::string& channel : names_) names.Add(JsonText(channel));
  return JsonObject()
      .Add("version", JsonText(FINRAY_VERSION))
      .Add("live", "true")
      .Add("name", JsonText(name))
      .Add("channels", names.str())
      .Add("nodes", std::to_string(nodes_.size()))
      .Add("finger", nodes_.Json())
      .str();
}

void LiveUpdates::Take(const LiveRow& row) {
  ++rows_;
  mask_ |= 1u << static_cast<int>(row.status);
  latency_.Add(row.latency_ns);
  last_.clear();
  for (const ContactEstimate& contact : row.contact) {
    last_.insert(last_.end(),
                 {contact.arc_mm, contact.arc_std_mm,
                  contact.arc_mm - contact.arc_low_mm,
                  contact.arc_high_mm - contact.arc_mm, contact.normal_N,
                  contact.normal_std_N, contact.normal_N - contact.normal_low_N,
                  contact.normal_high_N - contact.normal_N});
  }
  last_.push_back(row.force_N);
  last_.push_back(row.p_value);
  last_.resize(names_.size(), std::nan(""));
  for (std::size_t i = 0; i < last_.size(); ++i) {
    least_[i] = std::fmin(least_[i], last_[i]);
    most_[i] = std::fmax(most_[i], last_[i]);
  }
}

std::string LiveUpdates::Shape() {
  const bool solved = row_.status == FrameStatus::kOk ||
                      row_.status == FrameStatus::kNoContact ||
                      row_.status == FrameStatus::kUnobservable;
  std::vector<PointContact> contacts;
  for (const ContactEstimate& contact : row_.contact) {
    if (!std::isfinite(contact.arc_mm) || !std::isfinite(contact.normal_N)) {
      break;
    }
    contacts.push_back({contact.arc_mm, contact.normal_N, FrictionOf(row_)});
  }
  if (!solved || (contacts.empty() && row_.status != FrameStatus::kNoContact)) {
    return "null";
  }
  Measurements readings;
  readings.gauges_V = row_.gauges_V;
  readings.history_std_V = row_.history_std_V;
  readings.gauge_readings = row_.gauge_readings;
  solver_.FindResiduals(readings, contacts, {}, found_.data());
  const std::size_t first = names_.size() - found_.size();
  for (std::size_t j = 0; j < found_.size(); ++j) {
    least_[first + j] = most_[first + j] = last_[first + j] = found_[j];
  }
  if (solver_.solver().status() != SolveStatus::kSolved) return "null";
  return ShownAll(nodes_.Places(solver_.solver(), contacts));
}

std::string LiveUpdates::Next(LiveFeed* feed, const std::string& message,
                              bool zeroing) {
  least_.assign(names_.size(), std::nan(""));
  most_ = least_;
  mask_ = 0;
  bool any = false;
  // No more than the queue holds, though rows may come meanwhile.
  for (std::size_t i = 0; i < LiveFeed::kRows && feed->Pop(&row_); ++i) {
    Take(row_);
    any = true;
  }
  if (!any) return "";
  const Clock::time_point now = Clock::now();
  const auto seconds = [](Clock::duration time) {
    return std::chrono::duration<double>(time).count();
  };
  if (seconds(now - rate_from_) > 1) {
    rate_ =
        static_cast<double>(rows_ - rows_before_) / seconds(now - rate_from_);
    rows_before_ = rows_;
    rate_from_ = now;
  }
  // A log without times has those of the clock. In one with times, a row that
  // cannot be read has that of the row before.
  timed_ = timed_ || std::isfinite(row_.time_s);
  if (!timed_) time_s_ = seconds(now - start_);
  if (std::isfinite(row_.time_s)) time_s_ = row_.time_s;
  const std::string shape = Shape();
  return JsonObject()
      .Add("rows", std::to_string(rows_))
      .Add("time", JsonNumber(time_s_))
      .Add("status", std::to_string(static_cast<int>(row_.status)))
      .Add("mask", std::to_string(mask_))
      .Add("least", ShownAll(least_))
      .Add("most", ShownAll(most_))
      .Add("last", ShownAll(last_))
      .Add("friction", Shown(FrictionOf(row_)))
      .Add("shape", shape)
      .Add("rate", Shown(rate_))
      .Add("latency", ShownAll({1e-3 * latency_.Quantile(0.5),
                                1e-3 * latency_.Quantile(0.99),
                                1e-3 * static_cast<double>(latency_.max())}))
      .Add("missed", std::to_string(feed->missed()))
      .Add("message", JsonText(message))
      .Add("zeroing", zeroing ? "true" : "false")
      .str();
}

}  // namespace finray
