#ifndef FINRAY_BATCH_RESULT_ROWS_H_
#define FINRAY_BATCH_RESULT_ROWS_H_

#include <string>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "finray/io/frame_parser.h"
#include "finray/scene/measurement_columns.h"

namespace finray {

/// The numeric columns that an estimate fills in, in this order: contact_<c>_*,
/// normal_<c>_*, friction_<c>, gauge angles, ribs, gauge offsets where
/// they wander, tip, chi2, chi2_p_value, iterations, search_ended,
/// alternative_*. They depend only on the finger and the scene. The second
/// contact has columns if FrameEstimator may find one: contacts 2, or auto with
/// at least four gauges and no object_std_mm.
class ResultColumns {
 public:
  ResultColumns(const Finger& finger, const Scene& scene);

  const std::vector<std::string>& names() const { return names_; }
  /// Writes their values to values[0 .. names().size() - 1], NaN where there is
  /// none.
  void Values(const Measurements& readings, const FrameEstimate& estimate,
              double* values) const;

 private:
  template <class Column>
  void ForEach(const Measurements& readings, const FrameEstimate& estimate,
               Column column) const;

  std::vector<Gauge> gauges_;
  std::size_t ribs_;
  int contacts_ = 1;
  bool alternative_, limited_;
  double friction_;
  std::vector<std::string> names_;
};

/// What is written of a result.
struct ResultFormat {
  /// Columns in the order in which they are written; a name may hold * for any
  /// text. Empty: all.
  std::vector<std::string> columns;
  /// Significant digits of numbers that are computed or converted; 0: as many
  /// as read back as the same double.
  int digits = 0;
};

/// Maps the columns of a log to those of its result. Columns of the log stay as
/// they are; ResultColumns and `status` replace columns of the same name or
/// follow at the end. Any number of threads may use one layout.
class ResultLayout {
 public:
  /// Throws InputError if a gauge of the finger has no column, or if a column
  /// of the format is none of the result's.
  ResultLayout(const Finger& finger, const Scene& scene, const FrameParser& log,
               const ResultFormat& format = {});

  /// Returns the header line of the result.
  std::string HeaderCsv() const;
  void Read(const FrameRows& rows, std::size_t row,
            Measurements* readings) const;
  /// Appends a row of the result with its line end. Numbers of the estimate
  /// and converted ones of the log have the format's digits, its other numbers
  /// stay as they were. A value that is not finite becomes an empty cell.
  /// `values` is memory for the next rows.
  void Append(const FrameRows& log, std::size_t row,
              const Measurements& readings, const FrameEstimate& estimate,
              std::vector<double>* values, std::string* csv) const;

 private:
  // The source of a result's cell: a number of the estimate, its status, or a
  // column of the log.
  enum class Source { kEstimate, kStatus, kNumber, kText };
  struct Output {
    std::string name;
    Source source;
    std::size_t index;
  };

  // Keeps the outputs that the format names.
  void Select(const std::vector<std::string>& columns, const std::string& path);
  // Writes at most kLongestNumber characters, and returns their end.
  char* WriteNumber(double value, char* begin) const;

  MeasurementColumns readings_;
  ResultColumns results_;
  int digits_;
  std::vector<Output> outputs_;
};

}  // namespace finray

#endif  // FINRAY_BATCH_RESULT_ROWS_H_
