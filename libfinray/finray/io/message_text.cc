#include "finray/io/message_text.h"

#include <algorithm>
#include <cctype>
#include <numeric>

#include "finray/io/utf8.h"

namespace finray {
namespace {

std::string Lower(std::string text) {
  for (char& c : text) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return text;
}

// Returns the letters and digits of a name. By these gauge4_V means gauge_4_V
// rather than gauge_1_V, which is equally near.
std::string Bare(const std::string& text) {
  std::string bare;
  for (const char c : Lower(text)) {
    if (std::isalnum(static_cast<unsigned char>(c))) bare += c;
  }
  return bare;
}

// Returns the Levenshtein distance.
std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row.back();
}

std::string NearestName(const std::string& name,
                        const std::vector<std::string>& candidates) {
  // A hostile file may hold names of megabytes.
  constexpr std::size_t kLongestName = 80;
  if (name.size() > kLongestName) return "";
  const std::string bare = Bare(name);
  for (const std::string& candidate : candidates) {
    if (!bare.empty() && Bare(candidate) == bare) return candidate;
  }
  std::string nearest;
  std::size_t best = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = EditDistance(Lower(name), Lower(candidate));
    // A typing slip keeps some of the name.
    const std::size_t shorter = std::min(name.size(), candidate.size());
    if (distance < best && distance < shorter) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace

std::string OneLine(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const std::size_t bytes = Utf8Bytes(text);
    const auto first = static_cast<unsigned char>(text[0]);
    if (bytes == 0) {
      line += '?';
    } else if (first < ' ' || first == 0x7f) {
      line += ' ';
    } else {
      line += text.substr(0, bytes);
    }
    text.remove_prefix(bytes == 0 ? 1 : bytes);
  }
  return line;
}

std::string ShownLine(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  std::string shown = OneLine(text.substr(0, kLongest));
  if (text.size() > kLongest) shown += "...";
  return shown;
}

std::string ShownText(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  const bool cut = text.size() > kLongest;
  return "'" + ShownLine(text.substr(0, kLongest)) + (cut ? "..." : "") + "'";
}

std::string Joined(const std::vector<std::string>& words,
                   const char* separator) {
  std::string row;
  for (const std::string& word : words) {
    row += (&word == &words.front() ? "" : separator) + word;
  }
  return row;
}

std::string DidYouMean(const std::string& name,
                       const std::vector<std::string>& candidates) {
  const std::string nearest = NearestName(name, candidates);
  return nearest.empty() ? "" : " (did you mean " + ShownText(nearest) + "?)";
}

}  // namespace finray
