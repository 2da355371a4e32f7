#include "finray/view/live_zero.h"

#include <utility>

#include "finray/estimation/zeroed_finger.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"

namespace finray {

LiveZero::LiveZero(const Finger& finger, const Discretization& discretization,
                   Make make, double friction)
    : discretization_(discretization),
      make_(std::move(make)),
      friction_(friction),
      finger_(finger) {
  free_rows_.reserve(kRows);
}

LiveZero::~LiveZero() {
  if (worker_.joinable()) worker_.join();
}

std::string LiveZero::Request() {
  // Held from here on: the outcome of this request comes after its message.
  const std::lock_guard<std::mutex> lock(mutex_);
  State idle = State::kIdle;
  if (!state_.compare_exchange_strong(idle, State::kAsked)) {
    return "The gauges are being zeroed already.";
  }
  message_ = "Zeroing: the next " + std::to_string(kRows) +
             " rows have to be of the free finger at rest.";
  return message_;
}

std::string LiveZero::message() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return message_;
}

Finger LiveZero::finger() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return finger_;
}

void LiveZero::Collect(const Measurements& raw) {
  if (state_.load(std::memory_order_acquire) != State::kAsked) return;
  free_rows_.push_back(raw);
  if (free_rows_.size() < kRows) return;
  if (worker_.joinable()) worker_.join();  // that of an earlier request is done
  state_.store(State::kMaking, std::memory_order_release);
  worker_ = std::thread([this] { MakeZeroed(); });
}

void LiveZero::MakeZeroed() {
  std::string words;
  State state = State::kFailed;
  try {
    ZeroedFinger zeroed = ZeroGauges(finger(), discretization_, free_rows_,
                                     "Not zeroed", {friction_, false});
    made_ = make_(zeroed.finger);
    words = "Zeroed by " + std::to_string(zeroed.rows) + " rows; moved by";
    for (std::size_t j = 0; j < zeroed.change_V.size(); ++j) {
      words +=
          FormatText("%s %+.3g", j > 0 ? "," : "", 1e3 * zeroed.change_V[j]);
    }
    words += " mV.";
    state = State::kMade;
    const std::lock_guard<std::mutex> lock(mutex_);
    zeroed_ = std::move(zeroed.finger);
  } catch (const std::exception& error) {
    // The remedy behind the fault is for finray_zero: it speaks of flags.
    words = error.what();
    words = words.substr(0, words.find(';')) +
            ". Try again once the finger is free and at rest, and its gauges "
            "show it.";
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    words_ = words;
  }
  state_.store(state, std::memory_order_release);
}

std::unique_ptr<LiveEstimator> LiveZero::Take() {
  const State state = state_.load(std::memory_order_acquire);
  if (state != State::kMade && state != State::kFailed) return nullptr;
  free_rows_.clear();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    message_ = words_;
    if (state == State::kMade) finger_ = zeroed_;
  }
  std::unique_ptr<LiveEstimator> made = std::move(made_);
  state_.store(State::kIdle, std::memory_order_release);
  return made;
}

}  // namespace finray
