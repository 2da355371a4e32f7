#include "finray/batch/result_rows.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "finray/io/csv_cells.h"
#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/scene/frame_columns.h"

namespace finray {
namespace {

constexpr std::size_t kLongestNumber = 32;

// Says whether a name is `pattern`, in which * stands for any text.
bool Fits(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == pattern.npos) return name == pattern;
  const std::string_view before = pattern.substr(0, star);
  if (name.substr(0, star) != before) return false;
  for (name.remove_prefix(star);; name.remove_prefix(1)) {
    if (Fits(name, pattern.substr(star + 1))) return true;
    if (name.empty()) return false;
  }
}

}  // namespace

// Calls column(name, value) for each column, where name() makes the name. Only
// this function knows which columns there are.
template <class Column>
void ResultColumns::ForEach(const Measurements& readings,
                            const FrameEstimate& estimate,
                            Column column) const {
  const auto named = [&column](const char* name, double value) {
    column([name] { return std::string(name); }, value);
  };
  for (int c = 0; c < contacts_; ++c) {
    const ContactEstimate& contact = estimate.contact[c];
    column([c] { return ContactArc(c); }, contact.arc_mm);
    column([c] { return ContactArcStd(c); }, contact.arc_std_mm);
    column([c] { return ContactArcNoise(c); }, contact.arc_noise_mm);
    column([c] { return NormalForce(c); }, contact.normal_N);
    column([c] { return NormalForceStd(c); }, contact.normal_std_N);
    column([c] { return NormalForceNoise(c); }, contact.normal_noise_N);
    if (friction_ != 0) {
      column([c] { return Friction(c); }, std::isfinite(contact.arc_mm)
                                              ? readings.FrictionOr(friction_)
                                              : std::nan(""));
    }
    column([c] { return ContactX(c); }, contact.pose.x());
    column([c] { return ContactY(c); }, contact.pose.y());
    column([c] { return ContactAngle(c); }, contact.pose.z());
    column([c] { return ContactArcLow(c); }, contact.arc_low_mm);
    column([c] { return ContactArcHigh(c); }, contact.arc_high_mm);
    column([c] { return NormalForceLow(c); }, contact.normal_low_N);
    column([c] { return NormalForceHigh(c); }, contact.normal_high_N);
  }
  for (std::size_t j = 0; j < gauges_.size(); ++j) {
    Gauge gauge = gauges_[j];
    if (!estimate.gauge_offset_V.empty()) {
      gauge.offset_V = estimate.gauge_offset_V[j];
    }
    column([j] { return GaugeAngle(static_cast<int>(j)); },
           gauge.Angle(readings.gauges_V[j]));
  }
  for (std::size_t i = 0; i < ribs_; ++i) {
    column([i] { return RibForce(static_cast<int>(i)); },
           estimate.rib_tension_N[i]);
  }
  for (std::size_t j = 0; j < estimate.gauge_offset_V.size(); ++j) {
    column([j] { return GaugeOffset(static_cast<int>(j)); },
           estimate.gauge_offset_V[j]);
    column([j] { return GaugeOffsetStd(static_cast<int>(j)); },
           estimate.gauge_offset_std_V[j]);
  }
  named("tip_x_mm", estimate.tip_pose.x());
  named("tip_y_mm", estimate.tip_pose.y());
  named("tip_angle_rad", estimate.tip_pose.z());
  named("chi2", estimate.chi2);
  named("chi2_p_value", estimate.p_value());
  named("iterations", estimate.iterations);
  if (limited_) named("search_ended", estimate.search_ended);
  if (!alternative_) return;
  for (int c = 0; c < contacts_; ++c) {
    const ContactEstimate& contact = estimate.alternative[c];
    column([c] { return AlternativeContactArc(c); }, contact.arc_mm);
    column([c] { return AlternativeNormalForce(c); }, contact.normal_N);
  }
  named("alternative_chi2", estimate.alternative_chi2);
}

ResultColumns::ResultColumns(const Finger& finger, const Scene& scene)
    : gauges_(finger.gauges),
      ribs_(finger.ribs.size()),
      alternative_(scene.contacts != 0),
      limited_(scene.search_iteration_limit.has_value()),
      friction_(scene.friction_coefficient) {
  if (scene.MostContacts(gauges_.size()) == 2) contacts_ = 2;
  Measurements readings;
  readings.gauges_V.resize(gauges_.size());
  FrameEstimate estimate;
  estimate.rib_tension_N.resize(ribs_);
  if (scene.gauge_offset_walk) {
    estimate.gauge_offset_V.resize(gauges_.size());
    estimate.gauge_offset_std_V.resize(gauges_.size());
  }
  ForEach(readings, estimate,
          [this](auto name, double) { names_.push_back(name()); });
}

void ResultColumns::Values(const Measurements& readings,
                           const FrameEstimate& estimate,
                           double* values) const {
  ForEach(readings, estimate, [&values](auto, double value) {
    *values++ = std::isfinite(value) ? value : std::nan("");
  });
}

ResultLayout::ResultLayout(const Finger& finger, const Scene& scene,
                           const FrameParser& log, const ResultFormat& format)
    : readings_(
          finger, log.names(), log.path(),
          {/*angles=*/true, /*gauges_may_lack=*/false, scene.UsesCamera()}),
      results_(finger, scene),
      digits_(format.digits) {
  for (std::size_t i = 0; i < log.names().size(); ++i) {
    outputs_.push_back({log.names()[i],
                        log.IsNumeric(i) ? Source::kNumber : Source::kText, i});
  }
  const auto put = [this](const Output& output) {
    const auto at = std::find_if(
        outputs_.begin(), outputs_.end(),
        [&output](const Output& old) { return old.name == output.name; });
    if (at == outputs_.end()) {
      outputs_.push_back(output);
    } else {
      *at = output;
    }
  };
  for (std::size_t i = 0; i < results_.names().size(); ++i) {
    put({results_.names()[i], Source::kEstimate, i});
  }
  put({"status", Source::kStatus, 0});
  if (!format.columns.empty()) Select(format.columns, log.path());
}

void ResultLayout::Select(const std::vector<std::string>& columns,
                          const std::string& path) {
  std::vector<Output> chosen;
  std::vector<std::string> names;
  for (const Output& output : outputs_) names.push_back(output.name);
  for (const std::string& pattern : columns) {
    bool fits = false;
    for (const Output& output : outputs_) {
      if (!Fits(output.name, pattern)) continue;
      fits = true;
      const bool known = std::any_of(
          chosen.begin(), chosen.end(),
          [&output](const Output& old) { return old.name == output.name; });
      if (!known) chosen.push_back(output);
    }
    if (!fits)
      throw InputError(path + ": --columns: " + NoColumn(pattern, names));
  }
  outputs_ = std::move(chosen);
}

char* ResultLayout::WriteNumber(double value, char* begin) const {
  char* const end = begin + kLongestNumber;
  return digits_ > 0 ? std::to_chars(begin, end, value,
                                     std::chars_format::general, digits_)
                           .ptr
                     : std::to_chars(begin, end, value).ptr;
}

std::string ResultLayout::HeaderCsv() const {
  std::string csv;
  for (const Output& output : outputs_) {
    if (&output != &outputs_.front()) csv += ',';
    AppendCsvText(output.name, &csv);
  }
  return csv + '\n';
}

void ResultLayout::Read(const FrameRows& rows, std::size_t row,
                        Measurements* readings) const {
  readings_.Read([&](std::size_t i) { return rows.at(row, i).number; },
                 readings);
}

void ResultLayout::Append(const FrameRows& log, std::size_t row,
                          const Measurements& readings,
                          const FrameEstimate& estimate,
                          std::vector<double>* values, std::string* csv) const {
  values->resize(results_.names().size());
  results_.Values(readings, estimate, values->data());
  const std::size_t begin = csv->size();
  // Cells wait here, because to append each costs a fifth of its digits.
  char waiting[512];
  char* end = waiting;
  const auto hand_over = [&] {
    csv->append(waiting, end);
    end = waiting;
  };
  // Makes room for a cell and its comma.
  const auto make_room = [&](std::size_t length) {
    const auto room = static_cast<std::size_t>(std::end(waiting) - end);
    if (length >= room) hand_over();
  };
  const auto put_number = [&](double value) {
    if (!std::isnan(value)) end = WriteNumber(value, end);
  };
  const auto put_text = [&](std::string_view text) {
    make_room(text.size());
    if (text.size() < sizeof waiting) {
      end = std::copy(text.begin(), text.end(), end);
    } else {
      csv->append(text);
    }
  };
  for (const Output& output : outputs_) {
    make_room(kLongestNumber);
    switch (output.source) {
      case Source::kEstimate:
        put_number((*values)[output.index]);
        break;
      case Source::kStatus:
        put_text(StatusName(estimate.status));
        break;
      case Source::kNumber: {
        const FrameRows::Cell& cell = log.at(row, output.index);
        cell.text.empty() ? put_number(cell.number) : put_text(cell.text);
        break;
      }
      case Source::kText:
        hand_over();
        AppendCsvText(log.at(row, output.index).text, csv);
        break;
    }
    *end++ = ',';
  }
  hand_over();
  // A blank line would be skipped when the table is read.
  if (outputs_.size() == 1 && csv->size() == begin + 1) {
    csv->insert(begin, outputs_[0].source == Source::kText ? "\"\"" : "nan");
  }
  csv->back() = '\n';
}

}  // namespace finray
