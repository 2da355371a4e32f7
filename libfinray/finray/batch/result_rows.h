#ifndef FINRAY_BATCH_RESULT_ROWS_H_
#define FINRAY_BATCH_RESULT_ROWS_H_

#include <string>
#include <vector>

#include "finray/batch/result_columns.h"
#include "finray/io/frame_parser.h"
#include "finray/scene/measurement_columns.h"

namespace finray {

/// What the scene needs of a log.
MeasurementColumns::Options ReaderOptions(const Scene& scene);

/// From the columns of a log to those of its result: those of the log as they
/// are, ResultColumns and `status` in their old places or behind. Any number of
/// threads may use one.
class ResultLayout {
 public:
  /// Throws InputError if a gauge of the finger has no column.
  ResultLayout(const Finger& finger, const Scene& scene,
               const FrameParser& log);

  /// The first line of the result.
  std::string HeaderCsv() const;
  void Read(const FrameRows& rows, std::size_t row,
            Measurements* readings) const;

 private:
  friend class ResultWriter;

  // Where a cell of the result comes from: a number of the estimate, its
  // status, or a column of the log.
  enum class Source { kEstimate, kStatus, kNumber, kText };
  struct Output {
    std::string name;
    Source source;
    std::size_t index;
  };

  MeasurementColumns readings_;
  ResultColumns results_;
  std::vector<Output> outputs_;
};

/// Writes rows of a result. Numbers of the estimate are the shortest that read
/// back as the same double, those of the log stay as they were; what is not
/// finite is an empty cell.
class ResultWriter {
 public:
  /// Appends a row with its line end.
  void Append(const ResultLayout& layout, const FrameRows& log, std::size_t row,
              const Measurements& readings, const FrameEstimate& estimate,
              std::string* csv);

 private:
  std::vector<double> values_;  // kept for the next row's
};

}  // namespace finray

#endif  // FINRAY_BATCH_RESULT_ROWS_H_
