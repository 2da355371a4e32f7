#include "finray/batch/result_rows.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "finray/io/csv_cells.h"

namespace finray {

MeasurementColumns::Options ReaderOptions(const Scene& scene) {
  MeasurementColumns::Options options;
  options.camera = scene.UsesCamera();
  return options;
}

ResultLayout::ResultLayout(const Finger& finger, const Scene& scene,
                           const FrameParser& log)
    : readings_(finger, log.names(), log.path(), ReaderOptions(scene)),
      results_(finger, scene) {
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

void ResultWriter::Append(const ResultLayout& layout, const FrameRows& log,
                          std::size_t row, const Measurements& readings,
                          const FrameEstimate& estimate, std::string* csv) {
  values_.resize(layout.results_.names().size());
  layout.results_.Values(readings, estimate, values_.data());
  for (const ResultLayout::Output& output : layout.outputs_) {
    switch (output.source) {
      case ResultLayout::Source::kEstimate: {
        const double value = values_[output.index];
        if (std::isnan(value)) break;
        char text[32];
        csv->append(text, std::to_chars(text, text + sizeof text, value).ptr);
        break;
      }
      case ResultLayout::Source::kStatus:
        *csv += StatusName(estimate.status);
        break;
      case ResultLayout::Source::kNumber: {
        const FrameRows::Cell& cell = log.at(row, output.index);
        if (!std::isnan(cell.number)) *csv += cell.text;
        break;
      }
      case ResultLayout::Source::kText:
        AppendCsvText(log.at(row, output.index).text, csv);
        break;
    }
    *csv += ',';
  }
  csv->back() = '\n';
}

}  // namespace finray
