#ifndef FINRAY_BENCHMARK_JSON_WRITER_H_
#define FINRAY_BENCHMARK_JSON_WRITER_H_

#include <string>
#include <vector>

namespace finray {

/// Writes JSON, keys in the order given. What is not finite is left out, as
/// JSON has no number for it.
class JsonWriter {
 public:
  JsonWriter& Open(char bracket);  ///< '{' or '[', in a list
  JsonWriter& Open(const char* key, char bracket);
  JsonWriter& Close();
  JsonWriter& Number(const char* key, double value);
  JsonWriter& Boolean(const char* key, bool value);
  JsonWriter& Text(const char* key, const std::string& value);
  JsonWriter& Texts(const char* key, const std::vector<std::string>& values);
  JsonWriter& Numbers(const char* key, const std::vector<double>& values);

  const std::string& text() const { return text_; }

 private:
  void Key(const char* key);
  void Next();

  std::string text_;
  std::string closing_;  // brackets yet to be written, the next one last
  bool first_ = true;
};

}  // namespace finray

#endif  // FINRAY_BENCHMARK_JSON_WRITER_H_
