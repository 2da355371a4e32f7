#include "finray/io/yaml_map.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "finray/io/atomic_file.h"
#include "finray/io/error.h"
#include "finray/io/message_text.h"
#include "finray/io/number_text.h"
#include "finray/io/yaml_limits.h"

namespace finray {
namespace {

// Returns a value for a message, in one short line.
std::string Shown(const YAML::Node& node) {
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a sequence";
  if (node.IsNull()) return "nothing";
  return ShownText(node.Scalar());
}

// The parser would take a NUL byte for the end of the text.
void RefuseNul(const std::string& path, const std::string& text) {
  const auto nul = text.find('\0');
  if (nul == std::string::npos) return;
  const auto at = text.begin() + static_cast<std::ptrdiff_t>(nul);
  const auto start =
      nul == 0 ? std::string::npos : text.find_last_of('\n', nul - 1);
  const std::size_t column = start == std::string::npos ? nul : nul - start - 1;
  throw InputError(
      YamlPlace(path, static_cast<int>(std::count(text.begin(), at, '\n')),
                static_cast<int>(column)) +
      "found a NUL byte, expected UTF-8 text");
}

std::string ElementName(const std::string& name, std::size_t index) {
  return name + "[" + std::to_string(index + 1) + "]";
}

[[noreturn]] void FailAt(const std::string& path, const YAML::Node& node,
                         const std::string& message) {
  throw InputError(YamlPlace(path, node.Mark()) + message);
}

double NumberIn(const std::string& path, const YAML::Node& cell,
                const std::string& name) {
  const auto number =
      cell.IsScalar() ? ParseNumber(cell.Scalar()) : std::optional<double>();
  if (!number) {
    FailAt(path, cell, name + ": expected a number, found " + Shown(cell));
  }
  if (std::abs(*number) > kLargestYamlNumber) {
    FailAt(path, cell,
           name + ": expected a number of at most 1e30, found " + Shown(cell));
  }
  return *number;
}

std::vector<double> NumbersIn(const std::string& path, const YAML::Node& value,
                              const std::string& name) {
  if (!value.IsSequence()) {
    FailAt(path, value,
           name + ": expected a list of numbers, found " + Shown(value));
  }
  std::vector<double> numbers;
  for (std::size_t i = 0; i < value.size(); ++i) {
    numbers.push_back(NumberIn(path, value[i], ElementName(name, i)));
  }
  return numbers;
}

// Returns the message for a value that is none of `words`.
std::string NotOneOf(const std::string& name,
                     const std::vector<std::string>& words,
                     const YAML::Node& value) {
  return name + ": expected one of " + Joined(words) + ", found " +
         Shown(value) +
         (value.IsScalar() ? DidYouMean(value.Scalar(), words) : "");
}

std::string ShownDefault(double value) {
  return std::isfinite(value) ? YamlNumber(value, 6) : "";
}
std::string ShownDefault(int value) { return std::to_string(value); }
std::string ShownDefault(bool value) { return value ? "true" : "false"; }
std::string ShownDefault(const std::string& value) { return value; }

// Returns what `read` returns, or `fallback` if the key is missing. An error of
// `read` says the fallback too.
template <class Value, class Read>
Value ReadOr(const YamlMap& map, const std::string& key, const Value& fallback,
             const Read& read) {
  if (!map.Has(key)) return fallback;
  try {
    return read();
  } catch (const InputError& error) {
    const std::string shown = ShownDefault(fallback);
    if (shown.empty()) throw;
    throw InputError(error.what() + ("; the default is " + shown));
  }
}

YAML::Node ParseOneDocument(const std::string& path, const std::string& text) {
  CheckYamlLimits(path, text);
  const std::vector<YAML::Node> documents = YAML::LoadAll(text);
  if (documents.empty() || documents[0].IsNull()) {
    throw InputError(path + ": is empty, expected a YAML mapping");
  }
  for (std::size_t i = 1; i < documents.size(); ++i) {
    if (documents[i].IsNull()) continue;  // behind a closing "---"
    FailAt(path, documents[i], "found a second YAML document, expected one");
  }
  return documents[0];
}

}  // namespace

YamlMap::YamlMap(YAML::Node node, std::string path, std::string name)
    : node_(node), path_(std::move(path)), name_(std::move(name)) {
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) {
      FailAt(path_, entry.first,
             "expected a name in " + name_ + ", found " + Shown(entry.first));
    }
    if (!seen.insert(entry.first.Scalar()).second) {
      FailAt(path_, entry.first,
             "key " + Shown(entry.first) + " appears twice in " + name_);
    }
  }
}

YamlMap YamlMap::FromFile(const std::string& path) {
  return FromText(ReadWholeFile(path, "a YAML file", kMostYaml_MiB), path);
}

YamlMap YamlMap::FromText(const std::string& text, const std::string& name) {
  RefuseNul(name, text);
  const YAML::Node node = ParseOneDocument(name, text);
  if (!node.IsMap()) {
    FailAt(name, node, "expected a YAML mapping, found " + Shown(node));
  }
  return YamlMap(node, name, "the file");
}

void YamlMap::AllowOnly(const std::vector<std::string>& keys) const {
  for (const auto& entry : node_) {
    const std::string& key = entry.first.Scalar();
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string hint = DidYouMean(key, keys);
    if (hint.empty()) hint = "; known are " + Joined(keys, " ");
    FailAt(path_, entry.first,
           "unknown key " + Shown(entry.first) + " in " + name_ + hint);
  }
}

bool YamlMap::Has(const std::string& key) const {
  return static_cast<bool>(node_[key]);
}

std::vector<std::string> YamlMap::Keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : node_) keys.push_back(entry.first.Scalar());
  return keys;
}

void YamlMap::CheckCount(const std::string& key, std::size_t count,
                         std::size_t most) const {
  if (count <= most) return;
  Fail(key, key + ": expected at most " + std::to_string(most) + ", found " +
                std::to_string(count));
}

void YamlMap::Fail(const std::string& key, const std::string& message) const {
  throw InputError(PlaceOf(key) + ShownLine(message));
}

void YamlMap::FailIn(const std::string& key,
                     const std::vector<std::size_t>& element,
                     const std::string& message) const {
  YAML::Node node = node_[key];
  std::string name = key;
  for (const std::size_t index : element) {
    // reset(), as an assignment to a node would change the document.
    node.reset(static_cast<const YAML::Node>(node)[index]);
    name = ElementName(name, index);
  }
  FailAt(path_, node, name + ": " + message);
}

std::string YamlMap::PlaceOf(const std::string& key) const {
  const YAML::Node value = node_[key];
  return YamlPlace(path_, value ? value.Mark() : node_.Mark());
}

YAML::Node YamlMap::Value(const std::string& key) const {
  if (!Has(key)) Fail(key, "'" + key + "' is missing in " + name_);
  return node_[key];
}

YAML::Node YamlMap::Sequence(const std::string& key,
                             const std::string& of) const {
  const YAML::Node value = Value(key);
  if (!value.IsSequence()) FailExpecting(key, "a list" + of);
  return value;
}

void YamlMap::FailExpecting(const std::string& key,
                            const std::string& what) const {
  Fail(key, key + ": expected " + what + ", found " + Shown(node_[key]));
}

double YamlMap::Number(const std::string& key) const {
  return NumberIn(path_, Value(key), key);
}

double YamlMap::Number(const std::string& key, double fallback) const {
  return ReadOr(*this, key, fallback, [&] { return Number(key); });
}

double YamlMap::PositiveNumber(const std::string& key) const {
  const double number = Number(key);
  if (!(number > 0)) FailExpecting(key, "a number above 0");
  if (number < 1 / kLargestYamlNumber) {
    FailExpecting(key, "a number of at least 1e-30");
  }
  return number;
}

double YamlMap::PositiveNumber(const std::string& key, double fallback) const {
  return ReadOr(*this, key, fallback, [&] { return PositiveNumber(key); });
}

double YamlMap::NonNegativeNumber(const std::string& key) const {
  const double number = Number(key);
  if (!(number >= 0)) FailExpecting(key, "a number of at least 0");
  return number;
}

double YamlMap::NonNegativeNumber(const std::string& key,
                                  double fallback) const {
  return ReadOr(*this, key, fallback, [&] { return NonNegativeNumber(key); });
}

int YamlMap::Integer(const std::string& key) const {
  const double number = Number(key);
  if (number != std::floor(number) || std::abs(number) > 1e9) {
    FailExpecting(key, "a whole number");
  }
  return static_cast<int>(number);
}

int YamlMap::Integer(const std::string& key, int fallback) const {
  return ReadOr(*this, key, fallback, [&] { return Integer(key); });
}

bool YamlMap::Boolean(const std::string& key) const {
  const std::string text = Text(key);
  if (text != "true" && text != "false") FailExpecting(key, "true or false");
  return text == "true";
}

bool YamlMap::Boolean(const std::string& key, bool fallback) const {
  return ReadOr(*this, key, fallback, [&] { return Boolean(key); });
}

std::string YamlMap::Text(const std::string& key) const {
  // The text may become part of a path or of a message.
  const std::string text = RawText(key);
  if (ShownLine(text) != text) FailExpecting(key, "one short line of text");
  return text;
}

std::string YamlMap::Text(const std::string& key,
                          const std::string& fallback) const {
  return ReadOr(*this, key, fallback, [&] { return Text(key); });
}

std::string YamlMap::RawText(const std::string& key) const {
  const YAML::Node value = Value(key);
  if (!value.IsScalar()) FailExpecting(key, "a word");
  return value.Scalar();
}

std::string YamlMap::Choice(const std::string& key,
                            const std::vector<std::string>& words) const {
  const std::string text = Text(key);
  if (std::find(words.begin(), words.end(), text) != words.end()) return text;
  Fail(key, NotOneOf(key, words, node_[key]));
}

bool YamlMap::IsMap(const std::string& key) const {
  return Has(key) && node_[key].IsMap();
}

bool YamlMap::IsSequence(const std::string& key) const {
  return Has(key) && node_[key].IsSequence();
}

YamlMap YamlMap::Map(const std::string& key) const {
  const YAML::Node value = Value(key);
  if (!value.IsMap()) FailExpecting(key, "a mapping");
  return YamlMap(value, path_, key);
}

std::vector<YamlMap> YamlMap::Maps(const std::string& key) const {
  std::vector<YamlMap> maps;
  if (!Has(key) || Value(key).IsNull()) return maps;
  const YAML::Node value = Sequence(key, "");
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string name = ElementName(key, i);
    if (!value[i].IsMap()) {
      FailAt(path_, value[i],
             name + ": expected a mapping, found " + Shown(value[i]));
    }
    maps.push_back(YamlMap(value[i], path_, name));
  }
  return maps;
}

std::vector<std::string> YamlMap::Choices(
    const std::string& key, const std::vector<std::string>& words) const {
  const YAML::Node value = Sequence(key, " of words");
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const YAML::Node word = value[i];
    if (!word.IsScalar() ||
        std::find(words.begin(), words.end(), word.Scalar()) == words.end()) {
      FailAt(path_, word, NotOneOf(ElementName(key, i), words, word));
    }
    chosen.push_back(word.Scalar());
  }
  return chosen;
}

std::vector<std::string> YamlMap::Texts(const std::string& key) const {
  const YAML::Node value = Sequence(key, " of texts");
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!value[i].IsScalar()) {
      FailAt(
          path_, value[i],
          ElementName(key, i) + ": expected a text, found " + Shown(value[i]));
    }
    texts.push_back(value[i].Scalar());
  }
  return texts;
}

std::vector<double> YamlMap::Numbers(const std::string& key) const {
  return NumbersIn(path_, Value(key), key);
}

std::vector<std::vector<double>> YamlMap::NumberRows(
    const std::string& key) const {
  const YAML::Node value = Sequence(key, " of rows");
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < value.size(); ++i) {
    rows.push_back(NumbersIn(path_, value[i], ElementName(key, i)));
  }
  return rows;
}

std::vector<std::array<double, 2>> YamlMap::Pairs(
    const std::string& key) const {
  const YAML::Node value = Sequence(key, " of pairs");
  std::vector<std::array<double, 2>> pairs;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string name = ElementName(key, i);
    if (!value[i].IsSequence() || value[i].size() != 2) {
      FailAt(path_, value[i], name + ": expected two numbers, [x, y]");
    }
    std::array<double, 2>& pair = pairs.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) {
      pair[k] = NumberIn(path_, value[i][k], name);
    }
  }
  return pairs;
}

}  // namespace finray
