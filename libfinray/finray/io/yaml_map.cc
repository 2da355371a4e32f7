#include "finray/io/yaml_map.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>

#include "finray/io/error.h"
#include "finray/io/input_file.h"
#include "finray/io/nearest_name.h"
#include "finray/io/parse_number.h"
#include "finray/io/shown_text.h"
#include "finray/io/yaml_limits.h"
#include "finray/io/yaml_place.h"

namespace finray {
namespace {

// A value as it goes into a message: one short line.
std::string Shown(const YAML::Node& node) {
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a sequence";
  if (node.IsNull()) return "nothing";
  return ShownText(node.Scalar());
}

std::string ReadText(const std::string& path) {
  RefuseFolderOrPipe(path, "a YAML file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  char buffer[1 << 14];
  while (file.read(buffer, sizeof buffer), file.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(file.gcount()));
    if (text.size() > kMostYamlBytes) {
      throw InputError(path +
                       ": is too long, expected a YAML file of at most " +
                       std::to_string(kMostYamlBytes >> 20) + " MiB");
    }
  }
  if (!file.is_open() || file.bad()) {
    throw InputError(path + ": cannot be read: " + std::strerror(errno));
  }
  return text;
}

// The parser reads NUL as the end or as an escape.
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

double NumberIn(const std::string& path, const YAML::Node& cell,
                const std::string& name) {
  const auto number =
      cell.IsScalar() ? ParseNumber(cell.Scalar()) : std::optional<double>();
  if (!number) {
    throw InputError(YamlPlace(path, cell.Mark()) + name +
                     ": expected a number, found " + Shown(cell));
  }
  if (std::abs(*number) > kLargestYamlNumber) {
    throw InputError(YamlPlace(path, cell.Mark()) + name +
                     ": expected a number of at most 1e30, found " +
                     Shown(cell));
  }
  return *number;
}

std::vector<double> NumbersIn(const std::string& path, const YAML::Node& value,
                              const std::string& name) {
  if (!value.IsSequence()) {
    throw InputError(YamlPlace(path, value.Mark()) + name +
                     ": expected a list of numbers, found " + Shown(value));
  }
  std::vector<double> numbers;
  for (std::size_t i = 0; i < value.size(); ++i) {
    numbers.push_back(NumberIn(path, value[i], ElementName(name, i)));
  }
  return numbers;
}

// What is wrong with a value that is none of `words`.
std::string NotOneOf(const std::string& name,
                     const std::vector<std::string>& words,
                     const YAML::Node& value) {
  std::string known;
  for (const std::string& word : words) {
    known += (known.empty() ? "" : ", ") + word;
  }
  return name + ": expected one of " + known + ", found " + Shown(value) +
         (value.IsScalar() ? DidYouMean(value.Scalar(), words) : "");
}

YAML::Node ParseOneDocument(const std::string& path, const std::string& text) {
  CheckYamlLimits(path, text);
  const std::vector<YAML::Node> documents = YAML::LoadAll(text);
  if (documents.empty() || documents[0].IsNull()) {
    throw InputError(path + ": is empty, expected a YAML mapping");
  }
  for (std::size_t i = 1; i < documents.size(); ++i) {
    if (documents[i].IsNull()) continue;  // behind a closing "---"
    throw InputError(YamlPlace(path, documents[i].Mark()) +
                     "found a second YAML document, expected one");
  }
  return documents[0];
}

}  // namespace

YamlMap::YamlMap(YAML::Node node, std::string path, std::string name)
    : node_(node), path_(std::move(path)), name_(std::move(name)) {
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) {
      throw InputError(YamlPlace(path_, entry.first.Mark()) +
                       "expected a name in " + name_ + ", found " +
                       Shown(entry.first));
    }
    if (!seen.insert(entry.first.Scalar()).second) {
      throw InputError(YamlPlace(path_, entry.first.Mark()) + "key " +
                       Shown(entry.first) + " appears twice in " + name_);
    }
  }
}

YamlMap YamlMap::FromFile(const std::string& path) {
  const std::string text = ReadText(path);
  RefuseNul(path, text);
  const YAML::Node node = ParseOneDocument(path, text);
  if (!node.IsMap()) {
    throw InputError(YamlPlace(path, node.Mark()) +
                     "expected a YAML mapping, found " + Shown(node));
  }
  return YamlMap(node, path, "the file");
}

void YamlMap::AllowOnly(const std::vector<std::string>& keys) const {
  for (const auto& entry : node_) {
    const std::string& key = entry.first.Scalar();
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string hint = DidYouMean(key, keys);
    if (hint.empty()) {
      hint = "; known are";
      for (const std::string& known : keys) hint += " " + known;
    }
    throw InputError(YamlPlace(path_, entry.first.Mark()) + "unknown key " +
                     Shown(entry.first) + " in " + name_ + hint);
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

void YamlMap::Fail(const std::string& key, const std::string& message) const {
  throw InputError(PlaceOf(key) + ShownLine(message));
}

void YamlMap::FailIn(const std::string& key,
                     const std::vector<std::size_t>& element,
                     const std::string& message) const {
  YAML::Node node = node_[key];
  std::string name = key;
  for (const std::size_t index : element) {
    // Assigning to a node would change the document.
    node.reset(static_cast<const YAML::Node>(node)[index]);
    name = ElementName(name, index);
  }
  throw InputError(YamlPlace(path_, node.Mark()) + name + ": " + message);
}

std::string YamlMap::PlaceOf(const std::string& key) const {
  const YAML::Node value = node_[key];
  return YamlPlace(path_, value ? value.Mark() : node_.Mark());
}

double YamlMap::Number(const std::string& key) const {
  if (!Has(key)) Fail(key, "'" + key + "' is missing in " + name_);
  return NumberIn(path_, node_[key], key);
}

double YamlMap::Number(const std::string& key, double fallback) const {
  return Has(key) ? Number(key) : fallback;
}

double YamlMap::PositiveNumber(const std::string& key) const {
  const double number = Number(key);
  if (!(number > 0)) {
    Fail(key, key + ": expected a number above 0, found " + Shown(node_[key]));
  }
  if (number < 1 / kLargestYamlNumber) {
    Fail(key, key + ": expected a number of at least 1e-30, found " +
                  Shown(node_[key]));
  }
  return number;
}

double YamlMap::PositiveNumber(const std::string& key, double fallback) const {
  return Has(key) ? PositiveNumber(key) : fallback;
}

double YamlMap::NonNegativeNumber(const std::string& key) const {
  const double number = Number(key);
  if (!(number >= 0)) {
    Fail(key,
         key + ": expected a number of at least 0, found " + Shown(node_[key]));
  }
  return number;
}

double YamlMap::NonNegativeNumber(const std::string& key,
                                  double fallback) const {
  return Has(key) ? NonNegativeNumber(key) : fallback;
}

int YamlMap::Integer(const std::string& key) const {
  const double number = Number(key);
  if (number != std::floor(number) || std::abs(number) > 1e9) {
    Fail(key, key + ": expected a whole number, found " + Shown(node_[key]));
  }
  return static_cast<int>(number);
}

bool YamlMap::Boolean(const std::string& key, bool fallback) const {
  if (!Has(key)) return fallback;
  const std::string text = Text(key);
  if (text != "true" && text != "false") {
    Fail(key, key + ": expected true or false, found " + Shown(node_[key]));
  }
  return text == "true";
}

std::string YamlMap::Text(const std::string& key) const {
  if (!Has(key)) Fail(key, "'" + key + "' is missing in " + name_);
  if (!node_[key].IsScalar()) {
    Fail(key, key + ": expected a word, found " + Shown(node_[key]));
  }
  // It may become part of a path or of a message.
  const YAML::Node value = node_[key];
  const std::string& text = value.Scalar();
  if (ShownLine(text) != text) {
    Fail(key,
         key + ": expected one short line of text, found " + Shown(node_[key]));
  }
  return text;
}

std::string YamlMap::Text(const std::string& key,
                          const std::string& fallback) const {
  return Has(key) ? Text(key) : fallback;
}

std::string YamlMap::Choice(const std::string& key,
                            const std::vector<std::string>& words) const {
  const std::string text = Text(key);
  if (std::find(words.begin(), words.end(), text) != words.end()) return text;
  Fail(key, NotOneOf(key, words, node_[key]));
}

std::string YamlMap::Choice(const std::string& key,
                            const std::vector<std::string>& words,
                            const std::string& fallback) const {
  return Has(key) ? Choice(key, words) : fallback;
}

bool YamlMap::IsMap(const std::string& key) const {
  return Has(key) && node_[key].IsMap();
}

YamlMap YamlMap::Map(const std::string& key) const {
  if (!Has(key)) Fail(key, "'" + key + "' is missing in " + name_);
  if (!node_[key].IsMap()) {
    Fail(key, key + ": expected a mapping, found " + Shown(node_[key]));
  }
  return YamlMap(node_[key], path_, key);
}

std::vector<YamlMap> YamlMap::Maps(const std::string& key) const {
  std::vector<YamlMap> maps;
  if (!Has(key)) return maps;
  const YAML::Node value = node_[key];
  if (value.IsNull()) return maps;
  if (!value.IsSequence()) {
    Fail(key, key + ": expected a list, found " + Shown(value));
  }
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string name = ElementName(key, i);
    if (!value[i].IsMap()) {
      throw InputError(YamlPlace(path_, value[i].Mark()) + name +
                       ": expected a mapping, found " + Shown(value[i]));
    }
    maps.push_back(YamlMap(value[i], path_, name));
  }
  return maps;
}

std::vector<std::string> YamlMap::Choices(
    const std::string& key, const std::vector<std::string>& words) const {
  if (!Has(key)) Fail(key, "'" + key + "' is missing in " + name_);
  const YAML::Node value = node_[key];
  if (!value.IsSequence()) {
    Fail(key, key + ": expected a list of words, found " + Shown(value));
  }
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const YAML::Node word = value[i];
    if (!word.IsScalar() ||
        std::find(words.begin(), words.end(), word.Scalar()) == words.end()) {
      const std::string name = ElementName(key, i);
      throw InputError(YamlPlace(path_, word.Mark()) +
                       NotOneOf(name, words, word));
    }
    chosen.push_back(word.Scalar());
  }
  return chosen;
}

std::vector<double> YamlMap::Numbers(const std::string& key) const {
  if (!Has(key)) Fail(key, "'" + key + "' is missing in " + name_);
  return NumbersIn(path_, node_[key], key);
}

std::vector<std::vector<double>> YamlMap::NumberRows(
    const std::string& key) const {
  if (!Has(key)) Fail(key, "'" + key + "' is missing in " + name_);
  const YAML::Node value = node_[key];
  if (!value.IsSequence()) {
    Fail(key, key + ": expected a list of rows, found " + Shown(value));
  }
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < value.size(); ++i) {
    rows.push_back(NumbersIn(path_, value[i], ElementName(key, i)));
  }
  return rows;
}

std::vector<std::array<double, 2>> YamlMap::Pairs(
    const std::string& key) const {
  if (!Has(key)) Fail(key, "'" + key + "' is missing in " + name_);
  const YAML::Node value = node_[key];
  if (!value.IsSequence()) {
    Fail(key, key + ": expected a list of pairs, found " + Shown(value));
  }
  std::vector<std::array<double, 2>> pairs;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string name = ElementName(key, i);
    if (!value[i].IsSequence() || value[i].size() != 2) {
      throw InputError(YamlPlace(path_, value[i].Mark()) + name +
                       ": expected two numbers, [x, y]");
    }
    std::array<double, 2>& pair = pairs.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) {
      pair[k] = NumberIn(path_, value[i][k], name);
    }
  }
  return pairs;
}

}  // namespace finray
