#include "finray/io/yaml_limits.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include "finray/io/error.h"
#include "finray/io/message_text.h"

namespace finray {
namespace {

class Counter : public YAML::EventHandler {
 public:
  explicit Counter(const std::string& path) : path_(path) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    // At a lone ',' ']' or '}' the parser starts documents for ever.
    if (documents_++ > 0 && mark.pos == document_.pos) {
      Fail(mark, "not valid YAML: a value was expected here");
    }
    document_ = mark;
    sizes_.clear();
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Add(mark, anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string&,
                YAML::anchor_t anchor, const std::string&) override {
    Add(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto size = sizes_.find(anchor);
    if (size == sizes_.end())
      Fail(mark, "an alias refers to a value that contains it");
    Count(mark, size->second);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&,
                       YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Open(mark, anchor);
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&,
                  YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    Open(mark, anchor);
  }
  void OnMapEnd() override { Close(); }

 private:
  struct Collection {
    YAML::anchor_t anchor;
    std::size_t before;  // the number of nodes before it
  };

  [[noreturn]] void Fail(const YAML::Mark& mark, const std::string& what) {
    throw InputError(YamlPlace(path_, mark) + what);
  }
  void Count(const YAML::Mark& mark, std::size_t nodes) {
    nodes_ += nodes;
    if (nodes_ > kMostYamlNodes) {
      Fail(mark, "expected at most " + std::to_string(kMostYamlNodes) +
                     " values in a file, those behind aliases counted each "
                     "time");
    }
  }
  void Add(const YAML::Mark& mark, YAML::anchor_t anchor) {
    Count(mark, 1);
    if (anchor != 0) sizes_[anchor] = 1;
  }
  void Open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.push_back({anchor, nodes_});
    if (open_.size() > kMostYamlDepth) {
      Fail(mark, "expected lists and mappings at most " +
                     std::to_string(kMostYamlDepth) + " deep");
    }
    Count(mark, 1);
  }
  void Close() {
    const Collection& closed = open_.back();
    if (closed.anchor != 0) sizes_[closed.anchor] = nodes_ - closed.before;
    open_.pop_back();
  }

  const std::string& path_;
  std::size_t documents_ = 0, nodes_ = 0;
  YAML::Mark document_;
  std::vector<Collection> open_;
  std::map<YAML::anchor_t, std::size_t> sizes_;  // of values with an anchor
};

// Returns the column of a tab in the indentation of a line, or nothing. Both
// count from 0.
std::optional<int> TabInIndentation(const std::string& text, int line) {
  std::istringstream lines(text);
  std::string found;
  for (int i = 0; i <= line; ++i) std::getline(lines, found);
  const std::size_t tab = found.find('\t');
  if (tab >= found.find_first_not_of(" \t")) return std::nullopt;
  return static_cast<int>(tab);
}

}  // namespace

void CheckYamlLimits(const std::string& path, const std::string& text) {
  Counter counter(path);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(counter)) {
    }
  } catch (const YAML::Exception& error) {
    const int line = error.mark.line;
    // The parser complains of what it finds behind the tab.
    if (const auto tab = TabInIndentation(text, line)) {
      throw InputError(YamlPlace(path, line, *tab) +
                       "not valid YAML: tab in the indentation, YAML wants "
                       "spaces (" +
                       ShownLine(error.msg) + ")");
    }
    throw InputError(YamlPlace(path, error.mark) +
                     "not valid YAML: " + ShownLine(error.msg));
  }
}

std::string YamlPlace(const std::string& path, int line, int column) {
  return path + ":" + std::to_string(line + 1) + ":" +
         std::to_string(column + 1) + ": ";
}

std::string YamlPlace(const std::string& path, const YAML::Mark& mark) {
  return mark.is_null() ? path + ": " : YamlPlace(path, mark.line, mark.column);
}

}  // namespace finray
