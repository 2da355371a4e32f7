// How what gauges read depends on the rows before: creep and hysteresis.

#include <tbb/parallel_for.h>

#include <cmath>
#include <utility>

#include "finray/calib/problem/parameters.h"
#include "finray/finger/gauge_play.h"

namespace finray {

void CalibrationParameters::ReadHistories(const Finger& finger,
                                          const CalibrationLogs& logs) {
  const std::size_t gauges = gains_V_per_rad.size();
  for (std::size_t log = 0; log < logs.paths.size(); ++log) {
    histories_.emplace_back(gauges);
    for (std::size_t j = 0; j < gauges; ++j) {
      histories_.back()[j].set_noise_V(finger.gauges[j].noise_V);
    }
  }
  RowChange change(finger.gauges);
  int log = -1;
  for (const CalibrationFrame& frame : logs.frames) {
    if (frame.log != log) change.Restart();
    log = frame.log;
    if (frame.IsBench()) continue;
    const double moved2 = change.Next(frame.gauges_V);
    for (std::size_t j = 0; j < gauges; ++j) {
      histories_[log][j].Set(frame.row, frame.time_s, frame.gauges_V[j],
                             moved2);
    }
  }
}

void CalibrationParameters::DriveHistories(
    std::shared_ptr<const Eigen::MatrixXd> signals_V, const Finger& finger,
    const CalibrationLogs& logs) {
  signals_V_ = std::move(signals_V);
  if (histories_.empty() || signals_V_ == nullptr) return;
  RowChange change(finger.gauges);
  int log = -1;
  std::vector<double> volts;
  for (std::size_t i = 0; i < logs.frames.size(); ++i) {
    const CalibrationFrame& frame = logs.frames[i];
    if (frame.log != log) change.Restart();
    log = frame.log;
    if (frame.IsBench()) continue;
    const auto signals = signals_V_->col(static_cast<Eigen::Index>(i));
    volts = frame.gauges_V;
    for (std::size_t j = 0; j < volts.size(); ++j) {
      const double signal = signals[static_cast<Eigen::Index>(j)];
      if (std::isfinite(signal)) volts[j] = signal;
    }
    const double moved2 = change.Next(volts);
    for (std::size_t j = 0; j < volts.size(); ++j) {
      histories_[log][j].Drive(frame.row, signals[static_cast<Eigen::Index>(j)],
                               moved2);
    }
  }
}

HistoryTerm CalibrationParameters::HistoryOf(const CalibrationFrame& frame,
                                             int gauge) {
  if (histories_.empty() || frame.IsBench()) return {};
  return {&histories_[frame.log][gauge], frame.row, &creep_shares[gauge],
          &ln_creep_times[gauge], &hystereses_rad[gauge]};
}

ReadingHistory::Values CalibrationParameters::HistoryValues(int gauge) const {
  return {creep_shares[gauge], ln_creep_times[gauge],
          std::abs(gains_V_per_rad[gauge]) * hystereses_rad[gauge]};
}

double CalibrationParameters::OfHistory(const CalibrationFrame& frame,
                                        int gauge) {
  const HistoryTerm term = HistoryOf(frame, gauge);
  if (term.history == nullptr) return 0;
  const ReadingHistory::Row behind =
      term.history->At(term.row, HistoryValues(gauge));
  return *term.share *
             (behind.lag.volts -
              *readings.offset_V(gauge, frame.log) / (1 + *term.share)) -
         behind.play.volts;
}

void CalibrationParameters::KeepHistoryStdAt(
    const std::vector<ReadingHistory::Values>& values) {
  kept_ = values;
  for (std::vector<ReadingHistory>& log : histories_) {
    for (std::size_t j = 0; j < kept_.size(); ++j) log[j].KeepStd(kept_[j]);
  }
}

void CalibrationParameters::FollowHistories() const {
  const std::size_t gauges = gains_V_per_rad.size();
  tbb::parallel_for(
      std::size_t{0}, histories_.size() * gauges, [&](std::size_t k) {
        const auto gauge = static_cast<int>(k % gauges);
        histories_[k / gauges][gauge].Follow(HistoryValues(gauge));
      });
}

bool CalibrationParameters::KeepHistory(
    std::shared_ptr<const Eigen::MatrixXd> signals_V, const Finger& finger,
    const CalibrationLogs& logs) {
  bool much = signals_V_ == nullptr;
  DriveHistories(std::move(signals_V), finger, logs);
  if (histories_.empty()) return false;
  constexpr double kMuch = 0.03;  // of the width
  std::vector<ReadingHistory::Values> values;
  for (int j = 0; j < static_cast<int>(gains_V_per_rad.size()); ++j) {
    values.push_back(HistoryValues(j));
    const double before = kept_.empty() ? 0 : kept_[j].width_V;
    much |= std::abs(values[j].width_V - before) >
            kMuch * std::abs(gains_V_per_rad[j]) * 1e-3;
  }
  KeepHistoryStdAt(values);
  return much;
}

void CalibrationParameters::KeepHistoryOf(const CalibrationParameters& other,
                                          const Finger& finger,
                                          const CalibrationLogs& logs) {
  DriveHistories(other.signals_V_, finger, logs);
  if (!histories_.empty() && !other.kept_.empty()) {
    KeepHistoryStdAt(other.kept_);
  }
}

std::vector<double> CalibrationParameters::HistoryStd_V(
    const CalibrationFrame& frame) const {
  std::vector<double> std_V;
  if (kept_.empty() || frame.IsBench()) return std_V;
  for (const ReadingHistory& history : histories_[frame.log]) {
    std_V.push_back(history.KeptStd_V(frame.row));
  }
  return std_V;
}

}  // namespace finray
