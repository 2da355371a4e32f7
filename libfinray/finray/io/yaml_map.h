#ifndef FINRAY_IO_YAML_MAP_H_
#define FINRAY_IO_YAML_MAP_H_

#include <yaml-cpp/yaml.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace finray {

/// A YAML mapping read strictly: every getter throws InputError with
/// "path:line:column: ..." when a value is missing or not what it should be.
/// Numbers must be finite. Duplicate keys are refused.
class YamlMap {
 public:
  /// Reads a file whose top level is a mapping.
  static YamlMap FromFile(const std::string& path);

  /// Refuses keys not listed, suggesting the nearest one.
  void AllowOnly(const std::vector<std::string>& keys) const;

  bool Has(const std::string& key) const;
  std::vector<std::string> Keys() const;

  double Number(const std::string& key) const;
  double Number(const std::string& key, double fallback) const;
  double PositiveNumber(const std::string& key) const;
  double PositiveNumber(const std::string& key, double fallback) const;
  double NonNegativeNumber(const std::string& key) const;
  double NonNegativeNumber(const std::string& key, double fallback) const;
  int Integer(const std::string& key) const;
  bool Boolean(const std::string& key, bool fallback) const;
  std::string Text(const std::string& key) const;
  std::string Text(const std::string& key, const std::string& fallback) const;
  /// One of the listed words, else an error that names them and the nearest.
  std::string Choice(const std::string& key,
                     const std::vector<std::string>& words) const;
  std::string Choice(const std::string& key,
                     const std::vector<std::string>& words,
                     const std::string& fallback) const;

  /// Whether the value of `key` is a mapping (as against a scalar).
  bool IsMap(const std::string& key) const;
  YamlMap Map(const std::string& key) const;
  /// A sequence of mappings; empty when the key is absent or has no value.
  std::vector<YamlMap> Maps(const std::string& key) const;

  /// A sequence of the listed words; the key must be there.
  std::vector<std::string> Choices(const std::string& key,
                                   const std::vector<std::string>& words) const;

  /// A sequence of numbers, and one of such sequences; the key must be there.
  std::vector<double> Numbers(const std::string& key) const;
  std::vector<std::vector<double>> NumberRows(const std::string& key) const;

  /// A sequence of pairs of numbers, [[x, y], ...]; the key must be there.
  std::vector<std::array<double, 2>> Pairs(const std::string& key) const;

  /// Throws InputError at the position of `key` (of the mapping if absent).
  [[noreturn]] void Fail(const std::string& key,
                         const std::string& message) const;
  /// As Fail, at an element of the sequence at `key`, whose name goes before
  /// the message: {1, 0} is "key[2][1]: ".
  [[noreturn]] void FailIn(const std::string& key,
                           const std::vector<std::size_t>& element,
                           const std::string& message) const;
  /// "path:line:column: " of a key's value, for errors found later.
  std::string PlaceOf(const std::string& key) const;
  const std::string& path() const { return path_; }

 private:
  YamlMap(YAML::Node node, std::string path, std::string name);

  YAML::Node node_;
  std::string path_;
  std::string name_;  // what the mapping is called in messages, e.g. "ribs[2]"
};

}  // namespace finray

#endif  // FINRAY_IO_YAML_MAP_H_
