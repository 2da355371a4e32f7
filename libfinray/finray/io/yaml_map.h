#ifndef FINRAY_IO_YAML_MAP_H_
#define FINRAY_IO_YAML_MAP_H_

#include <yaml-cpp/yaml.h>

#include <array>
#include <string>
#include <vector>

namespace finray {

/// The largest number. A number that must be above 0 must be at least 1 / this,
/// so that products and ratios of a few numbers neither overflow nor vanish.
constexpr double kLargestYamlNumber = 1e30;

/// A YAML mapping that is read strictly: every getter throws InputError with
/// "path:line:column: ..." if a value is missing or of the wrong kind. Numbers
/// must be finite and within kLargestYamlNumber. Duplicate keys are errors. A
/// getter with a fallback returns it if the key is missing, and its errors name
/// it as the default. Only finite numbers are named.
class YamlMap {
 public:
  /// Reads a file whose top level is a mapping.
  static YamlMap FromFile(const std::string& path);
  /// The same of a text; messages show `name` in place of a path.
  static YamlMap FromText(const std::string& text, const std::string& name);

  /// Throws for a key that is not listed, with the nearest one that is.
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
  int Integer(const std::string& key, int fallback) const;
  bool Boolean(const std::string& key) const;
  bool Boolean(const std::string& key, bool fallback) const;
  std::string Text(const std::string& key) const;
  std::string Text(const std::string& key, const std::string& fallback) const;
  /// Returns a text that may hold control characters.
  std::string RawText(const std::string& key) const;
  /// Returns one of the listed words. The error names all of them and the
  /// nearest.
  std::string Choice(const std::string& key,
                     const std::vector<std::string>& words) const;

  /// Says whether the value of `key` is a mapping.
  bool IsMap(const std::string& key) const;
  YamlMap Map(const std::string& key) const;
  /// Returns a sequence of mappings, which is empty if the key is missing or
  /// has no value.
  std::vector<YamlMap> Maps(const std::string& key) const;

  /// Returns a sequence of the listed words.
  std::vector<std::string> Choices(const std::string& key,
                                   const std::vector<std::string>& words) const;

  /// Returns a sequence of texts.
  std::vector<std::string> Texts(const std::string& key) const;

  /// Says whether the value of `key` is a sequence.
  bool IsSequence(const std::string& key) const;
  /// Return a sequence of numbers, and a sequence of such sequences.
  std::vector<double> Numbers(const std::string& key) const;
  std::vector<std::vector<double>> NumberRows(const std::string& key) const;

  /// Returns a sequence of pairs of numbers, [[x, y], ...].
  std::vector<std::array<double, 2>> Pairs(const std::string& key) const;

  /// Throws InputError at `key` if its value has more than `most` elements.
  void CheckCount(const std::string& key, std::size_t count,
                  std::size_t most) const;

  /// Throws InputError at the position of `key`, or of the mapping if the key
  /// is missing.
  [[noreturn]] void Fail(const std::string& key,
                         const std::string& message) const;
  /// Fails like Fail, at an element of the sequence at `key`. The element's
  /// name begins the message: "key[2][1]: " for {1, 0}.
  [[noreturn]] void FailIn(const std::string& key,
                           const std::vector<std::size_t>& element,
                           const std::string& message) const;
  /// Returns "path:line:column: " of a key's value, for errors that are found
  /// later.
  std::string PlaceOf(const std::string& key) const;
  const std::string& path() const { return path_; }

 private:
  YamlMap(YAML::Node node, std::string path, std::string name);

  // The value of a key, which must be there.
  YAML::Node Value(const std::string& key) const;
  // The value of a key, which must be there and be a sequence `of` something.
  YAML::Node Sequence(const std::string& key, const std::string& of) const;
  // Throws at the value of `key`, which is not `what`.
  [[noreturn]] void FailExpecting(const std::string& key,
                                  const std::string& what) const;

  YAML::Node node_;
  std::string path_;
  std::string name_;  // the mapping's name in messages, e.g. "ribs[2]"
};

}  // namespace finray

#endif  // FINRAY_IO_YAML_MAP_H_
