#include "finray/benchmark/json_writer.h"

#include <cmath>
#include <cstdio>

#include "finray/io/number_text.h"

namespace finray {
namespace {

std::string Quoted(const std::string& value) {
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char escaped[8];
      std::snprintf(escaped, sizeof(escaped), "\\u%04x", c);
      quoted += escaped;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

}  // namespace

void JsonWriter::Next() {
  if (!first_) text_ += ',';
  first_ = false;
  // Lists of numbers stay on a line; records are a line each.
  if (closing_.size() <= 2 && !text_.empty()) {
    text_ += '\n' + std::string(closing_.size(), ' ');
  } else if (!text_.empty() && text_.back() == ',') {
    text_ += ' ';
  }
}

void JsonWriter::Key(const char* key) {
  Next();
  text_ += Quoted(key) + ": ";
}

JsonWriter& JsonWriter::Open(char bracket) {
  Next();
  text_ += bracket;
  closing_ += bracket == '{' ? '}' : ']';
  first_ = true;
  return *this;
}

JsonWriter& JsonWriter::Open(const char* key, char bracket) {
  Key(key);
  text_ += bracket;
  closing_ += bracket == '{' ? '}' : ']';
  first_ = true;
  return *this;
}

JsonWriter& JsonWriter::Close() {
  text_ += closing_.back();
  closing_.pop_back();
  first_ = false;
  if (closing_.empty()) text_ += '\n';
  return *this;
}

JsonWriter& JsonWriter::Number(const char* key, double value) {
  if (!std::isfinite(value)) return *this;
  Key(key);
  text_ += NumberText(value);
  return *this;
}

JsonWriter& JsonWriter::Boolean(const char* key, bool value) {
  Key(key);
  text_ += value ? "true" : "false";
  return *this;
}

JsonWriter& JsonWriter::Text(const char* key, const std::string& value) {
  Key(key);
  text_ += Quoted(value);
  return *this;
}

JsonWriter& JsonWriter::Texts(const char* key,
                              const std::vector<std::string>& values) {
  Key(key);
  text_ += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    text_ += (i == 0 ? "" : ", ") + Quoted(values[i]);
  }
  text_ += ']';
  return *this;
}

JsonWriter& JsonWriter::Numbers(const char* key,
                                const std::vector<double>& values) {
  Key(key);
  text_ += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    text_ += (i == 0 ? "" : ", ") + NumberText(values[i]);
  }
  text_ += ']';
  return *this;
}

}  // namespace finray
