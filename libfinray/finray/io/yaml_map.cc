#include "finray/io/yaml_map.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "finray/io/error.h"
#include "finray/io/nearest_name.h"

namespace finray {
namespace {

std::string Place(const std::string& path, const YAML::Mark& mark) {
  if (mark.is_null()) return path + ": ";
  return path + ":" + std::to_string(mark.line + 1) + ":" +
         std::to_string(mark.column + 1) + ": ";
}

// A value as it goes into a message: one short line.
std::string Shown(const YAML::Node& node) {
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a sequence";
  if (node.IsNull()) return "nothing";
  std::string text = node.Scalar();
  if (text.size() > 40) text = text.substr(0, 40) + "...";
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return "'" + text + "'";
}

std::string ReadText(const std::string& path) {
  if (std::filesystem::is_directory(path)) {
    throw InputError(path + ": is a folder, expected a YAML file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(path + ": cannot be read: " + std::strerror(errno));
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::optional<double> ParseNumber(const std::string& text) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  double value;
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

}  // namespace

YamlMap::YamlMap(YAML::Node node, std::string path, std::string name)
    : node_(node), path_(std::move(path)), name_(std::move(name)) {
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) {
      throw InputError(Place(path_, entry.first.Mark()) +
                       "expected a name in " + name_ + ", found " +
                       Shown(entry.first));
    }
    if (!seen.insert(entry.first.Scalar()).second) {
      throw InputError(Place(path_, entry.first.Mark()) + "key " +
                       Shown(entry.first) + " appears twice in " + name_);
    }
  }
}

YamlMap YamlMap::FromFile(const std::string& path) {
  const std::string text = ReadText(path);
  YAML::Node node;
  try {
    node = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(Place(path, error.mark) + "not valid YAML: " + error.msg);
  }
  if (!node.IsMap()) {
    throw InputError(path + ": expected a YAML mapping, found " + Shown(node));
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
    throw InputError(Place(path_, entry.first.Mark()) + "unknown key " +
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
  const YAML::Node value = node_[key];
  throw InputError(Place(path_, value ? value.Mark() : node_.Mark()) + message);
}

double YamlMap::Number(const std::string& key) const {
  if (!Has(key)) Fail(key, "'" + key + "' is missing in " + name_);
  const YAML::Node value = node_[key];
  const auto number =
      value.IsScalar() ? ParseNumber(value.Scalar()) : std::optional<double>();
  if (!number) Fail(key, key + ": expected a number, found " + Shown(value));
  return *number;
}

double YamlMap::Number(const std::string& key, double fallback) const {
  return Has(key) ? Number(key) : fallback;
}

double YamlMap::PositiveNumber(const std::string& key) const {
  const double number = Number(key);
  if (!(number > 0)) {
    Fail(key, key + ": expected a number above 0, found " + Shown(node_[key]));
  }
  return number;
}

double YamlMap::PositiveNumber(const std::string& key, double fallback) const {
  return Has(key) ? PositiveNumber(key) : fallback;
}

double YamlMap::NonNegativeNumber(const std::string& key,
                                  double fallback) const {
  const double number = Number(key, fallback);
  if (!(number >= 0)) {
    Fail(key,
         key + ": expected a number of at least 0, found " + Shown(node_[key]));
  }
  return number;
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
  return node_[key].Scalar();
}

std::string YamlMap::Text(const std::string& key,
                          const std::string& fallback) const {
  return Has(key) ? Text(key) : fallback;
}

std::string YamlMap::Choice(const std::string& key,
                            const std::vector<std::string>& words) const {
  const std::string text = Text(key);
  if (std::find(words.begin(), words.end(), text) != words.end()) return text;
  std::string known;
  for (const std::string& word : words) {
    known += (known.empty() ? "" : ", ") + word;
  }
  Fail(key, key + ": expected one of " + known + ", found " +
                Shown(node_[key]) + DidYouMean(text, words));
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
  if (!value.IsSequence()) {
    Fail(key, key + ": expected a list, found " + Shown(value));
  }
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string name = key + "[" + std::to_string(i + 1) + "]";
    if (!value[i].IsMap()) {
      throw InputError(Place(path_, value[i].Mark()) + name +
                       ": expected a mapping, found " + Shown(value[i]));
    }
    maps.push_back(YamlMap(value[i], path_, name));
  }
  return maps;
}

}  // namespace finray
