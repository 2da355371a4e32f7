#include "finray/view/log_channels.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "finray/io/error.h"
#include "finray/io/frame_reader.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/io/message_text.h"
#include "finray/io/number_text.h"
#include "finray/scene/frame_columns.h"
#include "finray/scene/history_filter.h"
#include "finray/scene/measured_force.h"
#include "finray/scene/measurement_columns.h"
#include "finray/view/estimate_solver.h"

namespace finray {
namespace {

// Results may be rounded or scaled, so a contact may lie this far along, as a
// share of l_0.
constexpr double kEnd = 1.01;

constexpr std::size_t kBlockRows = 4096;
constexpr int kMostContacts = 2;
// Smaller p-values are drawn alike.
constexpr double kLeastPValue = 1e-12;

using ColumnAt = std::optional<std::size_t>;

// Reads rows of a result and appends them to channels.
class ResultRows {
 public:
  ResultRows(const FrameParser& parser, const Finger* finger,
             const Discretization& discretization, LogChannels* log)
      : path_(parser.path()), names_(parser.names()), log_(*log) {
    if (finger != nullptr) length_mm_ = finger->front_length_mm;
    status_ = Needed("status");
    time_ = At("time_s");
    log_.has_time = time_.has_value();
    AddContacts();
    AddForce();
    AddValue("chi2_p_value");
    Channel& p = log_.channels.back();
    p.bits = 8;
    p.logarithmic = true;
    p.low = kLeastPValue;
    p.high = 1;
    // A result may have been written without its gauges.
    if (finger != nullptr && HasGauges(*finger)) {
      AddResiduals(*finger, discretization);
    }
  }

  void Add(const FrameRows& rows, std::size_t row, int line) {
    const auto number = [&](const ColumnAt& at) {
      return at ? rows.at(row, *at).number : std::nan("");
    };
    const FrameStatus status = StatusNamed(
        rows.at(row, *status_).text, path_ + ":" + std::to_string(line) + ": ");
    log_.status.push_back(
        static_cast<std::uint16_t>(1 << static_cast<int>(status)));
    AddTime(number(time_));
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const Value& value = values_[i];
      const double from = value.from ? number(value.from) : 0;
      const double above = number(value.at) - from;
      Push(i, value.below ? -above : above);
    }
    if (force_) Push(*force_, ReferenceForce(rows, row));
    contacts_.clear();
    for (const ContactAt& contact : contact_at_) {
      PointContact point;
      point.arc_mm = number(contact.arc);
      point.normal_N = number(contact.normal);
      if (!std::isfinite(point.arc_mm) || !std::isfinite(point.normal_N)) break;
      if (point.arc_mm > kEnd * length_mm_) {
        throw InputError(path_ + ":" + std::to_string(line) +
                         ": a contact at " +
                         FormatText("%.4g mm, and the finger ends at %.4g mm; "
                                    "is it the finger of the result?",
                                    point.arc_mm, length_mm_));
      }
      const double friction = number(contact.friction);
      if (std::isfinite(friction)) point.friction = friction;
      AddFriction(point.friction);
      double& most_N = status == FrameStatus::kOk ? most_sure_N_ : most_N_;
      most_N = std::max(most_N, point.normal_N);
      contacts_.push_back(point);
    }
    if (contacts_.size() > 1) log_.pairs.push_back({log_.frames, contacts_});
    log_.most_force_N = most_sure_N_ > 0 ? most_sure_N_ : most_N_;
    if (solver_) AddResiduals(rows, row, status);
    ++log_.frames;
  }

 private:
  struct Value {
    ColumnAt at, from;
    bool below = false;
  };
  struct ContactAt {
    ColumnAt arc, normal, friction;
  };

  ColumnAt At(const std::string& name) const {
    const auto at = std::find(names_.begin(), names_.end(), name);
    if (at == names_.end()) return {};
    return static_cast<std::size_t>(at - names_.begin());
  }
  ColumnAt Needed(const std::string& name) const {
    const ColumnAt at = At(name);
    if (!at) {
      throw InputError(path_ + ": " + NoColumn(name, names_) +
                       "; expected a <log>.frames.csv of finray_estimate");
    }
    return at;
  }

  bool HasGauges(const Finger& finger) const {
    for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
      if (At(GaugeVolts(j)) || At(GaugeAngle(j))) return true;
    }
    return false;
  }

  // Appends a channel whose values are pushed in the order of the channels.
  Channel& NewChannel(const std::string& name) {
    Channel& channel = log_.channels.emplace_back();
    channel.name = name;
    return channel;
  }
  void AddValue(const std::string& name, ColumnAt from = {}, bool below = false,
                const std::string& shown = "") {
    NewChannel(shown.empty() ? name : shown);
    values_.push_back({At(name), from, below});
  }
  // A length that spans powers of ten: a std, or half an interval.
  void AddSpread(const std::string& name, ColumnAt from = {},
                 bool below = false, const std::string& shown = "") {
    if (!At(name)) return;
    AddValue(name, from, below, shown);
    log_.channels.back().bits = 8;
    log_.channels.back().logarithmic = true;
  }
  void AddContacts() {
    Needed(ContactArc(0));
    Needed(NormalForce(0));
    for (int c = 0; c < kMostContacts && At(ContactArc(c)); ++c) {
      contact_at_.push_back(
          {At(ContactArc(c)), Needed(NormalForce(c)), At(Friction(c))});
      AddWithSpread(ContactArc(c), ContactArcStd(c), ContactArcLow(c),
                    ContactArcHigh(c));
      AddWithSpread(NormalForce(c), NormalForceStd(c), NormalForceLow(c),
                    NormalForceHigh(c));
      for (const std::string& name :
           {Friction(c), AlternativeContactArc(c), AlternativeNormalForce(c)}) {
        if (At(name)) AddValue(name);
      }
    }
  }
  void AddWithSpread(const std::string& value, const std::string& std,
                     const std::string& low, const std::string& high) {
    AddValue(value);
    AddSpread(std);
    AddSpread(low, At(value), true, value + "_below");
    AddSpread(high, At(value), false, value + "_above");
  }
  void AddFriction(double friction) {
    log_.least_friction =
        has_friction_ ? std::min(log_.least_friction, friction) : friction;
    log_.most_friction =
        has_friction_ ? std::max(log_.most_friction, friction) : friction;
    has_friction_ = true;
  }
  void AddForce() {
    force_at_ = At("force_N");
    force_x_at_ = At("force_x_N");
    force_y_at_ = At("force_y_N");
    if (!force_at_ && !(force_x_at_ && force_y_at_)) return;
    NewChannel("force_N");
    force_ = values_.size();
    // It has a place among the channels but no column of its own.
    values_.push_back({});
  }
  double ReferenceForce(const FrameRows& rows, std::size_t row) const {
    const auto read = [&](const ColumnAt& at) {
      return at ? rows.at(row, *at).number : std::nan("");
    };
    return MeasuredForce::Of(read(force_at_),
                             {read(force_x_at_), read(force_y_at_)})
        .magnitude_N;
  }

  void AddResiduals(const Finger& finger,
                    const Discretization& discretization) {
    RequireTimeForCreep(finger, names_, path_);
    columns_.emplace(finger, names_, path_,
                     MeasurementColumns::Options{true, false, false});
    history_.emplace(finger);
    solver_.emplace(finger, discretization);
    first_residual_ = log_.channels.size();
    for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
      Channel& channel =
          NewChannel(IndexedColumn("gauge_", j, "_residual_std"));
      channel.bits = 8;
      channel.low = -LogChannels::kMostResidual;
      channel.high = LogChannels::kMostResidual;
      if (const ColumnAt at = At(GaugeOffset(j))) offset_at_.push_back(at);
    }
    found_.resize(finger.gauges.size());
  }
  void AddResiduals(const FrameRows& rows, std::size_t row,
                    FrameStatus status) {
    columns_->Read([&](std::size_t i) { return rows.at(row, i).number; },
                   &readings_);
    if (!history_->empty()) history_->Remove(&readings_);
    const bool solved = status == FrameStatus::kOk ||
                        status == FrameStatus::kNoContact ||
                        status == FrameStatus::kUnobservable;
    // An unobservable frame may have a force but no place.
    const bool placed = status == FrameStatus::kNoContact || !contacts_.empty();
    if (solved && placed) {
      if (status == FrameStatus::kNoContact) contacts_.clear();
      offsets_V_.clear();
      if (offset_at_.size() == found_.size()) {
        for (const ColumnAt& at : offset_at_) {
          offsets_V_.push_back(rows.at(row, *at).number);
        }
      }
      solver_->FindResiduals(readings_, contacts_, offsets_V_, found_.data());
    } else {
      std::fill(found_.begin(), found_.end(), std::nanf(""));
    }
    for (std::size_t j = 0; j < found_.size(); ++j) {
      Push(first_residual_ + j, found_[j]);
    }
  }

  void AddTime(double time_s) {
    if (std::isnan(time_s)) {  // a row that could not be read
      time_s = log_.time_s.empty() ? std::nan("") : log_.time_s.back();
    }
    if (!log_.time_s.empty() && time_s < log_.time_s.back()) {
      log_.has_time = false;
    }
    log_.time_s.push_back(time_s);
  }
  void Push(std::size_t channel, double value) {
    std::vector<float>& values = log_.channels[channel].values;
    values.resize(log_.frames + 1, std::nanf(""));
    values[log_.frames] = static_cast<float>(value);
  }

  std::string path_;
  std::vector<std::string> names_;
  LogChannels& log_;
  ColumnAt status_, time_, force_at_, force_x_at_, force_y_at_;
  std::vector<Value> values_;  // by channel
  std::vector<ContactAt> contact_at_;
  std::optional<std::size_t> force_;  // its channel
  std::size_t first_residual_ = 0;
  double length_mm_ = std::numeric_limits<double>::infinity();
  double most_sure_N_ = 0, most_N_ = 0;
  bool has_friction_ = false;  // a contact has been read
  std::optional<MeasurementColumns> columns_;
  std::optional<HistoryFilter> history_;
  std::optional<EstimateSolver> solver_;
  std::vector<ColumnAt> offset_at_;
  // Memory, reused by the next row.
  Measurements readings_;
  std::vector<PointContact> contacts_;
  std::vector<double> offsets_V_;
  std::vector<float> found_;
};

// Without times that never decrease, frames are numbered.
void CheckTimes(LogChannels* log) {
  std::vector<double>& times = log->time_s;
  // Rows before the first time that could be read.
  const auto first = std::find_if(times.begin(), times.end(), [](double time) {
    return !std::isnan(time);
  });
  if (first == times.end()) log->has_time = false;
  if (!log->has_time) {
    for (std::size_t i = 0; i < times.size(); ++i) {
      times[i] = static_cast<double>(i);
    }
    return;
  }
  std::fill(times.begin(), first, *first);
}

}  // namespace

std::string ResultName(const std::string& path) {
  std::string name = std::filesystem::path(path).filename().string();
  for (const char* end : {".gz", ".csv", ".frames"}) {
    const std::string tail = end;
    if (name.size() > tail.size() &&
        name.compare(name.size() - tail.size(), tail.size(), tail) == 0) {
      name.resize(name.size() - tail.size());
    }
  }
  return name;
}

FrameStatus StatusNamed(std::string_view name, const std::string& place) {
  std::vector<std::string> names;
  for (const FrameStatus status :
       {FrameStatus::kOk, FrameStatus::kNoContact, FrameStatus::kUnobservable,
        FrameStatus::kNotConverged, FrameStatus::kBadInput}) {
    if (name == StatusName(status)) return status;
    names.push_back(StatusName(status));
  }
  throw InputError(place + "no status " + ShownText(name) + ", expected " +
                   Joined(names) + DidYouMean(std::string(name), names));
}

LogChannels ReadLogChannels(const std::string& path, const Finger* finger,
                            const Discretization& discretization) {
  LogChannels log;
  log.name = ResultName(path);
  ColumnMapping as_written;
  as_written.is_result = true;
  FrameReader reader(path, as_written);
  ResultRows result(reader.parser(), finger, discretization, &log);
  LineBlock block;
  FrameRows rows;
  while (reader.ReadLines(kBlockRows, &block)) {
    rows.Clear();
    for (std::size_t i = 0; i < block.size(); ++i) {
      reader.parser().Parse(block.at(i), &rows);
      result.Add(rows, i, block.at(i).number);
    }
    if (!block.error.empty()) throw InputError(block.error);
    block.Clear();
  }
  CheckTimes(&log);
  log.channels.erase(
      std::remove_if(log.channels.begin(), log.channels.end(),
                     [](const Channel& channel) { return channel.IsEmpty(); }),
      log.channels.end());
  return log;
}

}  // namespace finray
