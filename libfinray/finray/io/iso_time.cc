#include "finray/io/iso_time.h"

#include <charconv>
#include <string>

#include "finray/io/number_text.h"

namespace finray {
namespace {

bool TakeOne(std::string_view of, std::string_view* text) {
  if (text->empty() || of.find(text->front()) == of.npos) return false;
  text->remove_prefix(1);
  return true;
}

// Takes a number of exactly `digits` digits within bounds.
bool TakeNumber(std::size_t digits, int least, int most, std::string_view* text,
                int* number) {
  if (text->size() < digits) return false;
  const char* end = text->data() + digits;
  // from_chars would take a minus sign.
  if (text->front() < '0' || text->front() > '9') return false;
  const auto result = std::from_chars(text->data(), end, *number);
  text->remove_prefix(digits);
  return result.ptr == end && *number >= least && *number <= most;
}

bool IsLeapYear(int year) {
  return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
}

int DaysOfMonth(int year, int month) {
  constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month == 2 && IsLeapYear(year) ? 29 : kDays[month - 1];
}

// Days from 1970-01-01 of the proleptic Gregorian calendar.
long DaysFromEpoch(int year, int month, int day) {
  const long before = year - 1;
  long days = 365 * (year - 1970L) + before / 4 - before / 100 + before / 400 -
              (1969 / 4 - 1969 / 100 + 1969 / 400);
  for (int m = 1; m < month; ++m) days += DaysOfMonth(year, m);
  return days + day - 1;
}

// Takes a zone, or nothing. Returns false if what is there is no zone.
bool TakeZone(std::string_view* text, int* ahead_s) {
  *ahead_s = 0;
  if (text->empty() || TakeOne("Zz", text)) return true;
  const bool west = text->front() == '-';
  int hours = 0, minutes = 0;
  if (!TakeOne("+-", text) || !TakeNumber(2, 0, 23, text, &hours)) return false;
  if (!text->empty()) {
    TakeOne(":", text);
    if (!TakeNumber(2, 0, 59, text, &minutes)) return false;
  }
  *ahead_s = (west ? -60 : 60) * (60 * hours + minutes);
  return true;
}

// Takes ":30.25". A fraction is empty or "0.25".
bool TakeSeconds(std::string_view* text, int* seconds, std::string* fraction) {
  // 60 is a leap second.
  if (!TakeNumber(2, 0, 60, text, seconds)) return false;
  if (!TakeOne(".,", text)) return true;
  const auto end = text->find_first_not_of("0123456789");
  *fraction = "0." + std::string(text->substr(0, end));
  text->remove_prefix(end == text->npos ? text->size() : end);
  return fraction->size() > 2;
}

}  // namespace

std::optional<double> IsoTime(std::string_view text) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  int ahead_s = 0;
  std::string fraction;
  if (!TakeNumber(4, 1, 9999, &text, &year) || !TakeOne("-", &text) ||
      !TakeNumber(2, 1, 12, &text, &month) || !TakeOne("-", &text) ||
      !TakeNumber(2, 1, DaysOfMonth(year, month), &text, &day) ||
      !TakeOne("Tt ", &text) || !TakeNumber(2, 0, 23, &text, &hour) ||
      !TakeOne(":", &text) || !TakeNumber(2, 0, 59, &text, &minute) ||
      (TakeOne(":", &text) && !TakeSeconds(&text, &second, &fraction)) ||
      !TakeZone(&text, &ahead_s) || !text.empty()) {
    return std::nullopt;
  }
  const long whole = 86400 * DaysFromEpoch(year, month, day) + 3600 * hour +
                     60 * minute + second - ahead_s;
  return static_cast<double>(whole) +
         (fraction.empty() ? 0 : ParseNumber(fraction).value_or(0));
}

}  // namespace finray
