#include "finray/view/page_text.h"

#include <stdexcept>

#include "finray/io/message_text.h"

namespace finray {

// Defined in the source that embed_pages.cmake writes.
extern const std::string_view kPageFiles[][2];
extern const int kPageFileCount;

namespace {

std::string HtmlText(std::string_view text) {
  std::string html;
  for (const char c : OneLine(text)) {
    if (c == '<') {
      html += "&lt;";
    } else if (c == '&') {
      html += "&amp;";
    } else {
      html += c;
    }
  }
  return html;
}

// Replaces "{{name}}", which stands once in the text.
void Fill(std::string_view name, std::string_view value, std::string* text) {
  const std::string mark = "{{" + std::string(name) + "}}";
  text->replace(text->find(mark), mark.size(), value);
}

// Returns a file of page/.
std::string_view PageFile(std::string_view name) {
  for (int i = 0; i < kPageFileCount; ++i) {
    if (kPageFiles[i][0] == name) return kPageFiles[i][1];
  }
  throw std::logic_error("no page file " + std::string(name));
}

std::string PageText(std::string_view title, std::string_view html,
                     const std::string& scripts, std::string_view data_json) {
  // From the end to the front, as what is filled in may hold marks.
  std::string text(PageFile("page.html"));
  Fill("scripts", scripts, &text);
  Fill("data", data_json, &text);
  Fill("body", html, &text);
  Fill("style", PageFile("page.css"), &text);
  Fill("title", HtmlText(title), &text);
  return text;
}

}  // namespace

std::string LogPageText(std::string_view title, std::string_view data_json) {
  std::string scripts;
  for (const char* name : {"channels.js", "finger.js", "plots.js",
                           "gestures.js", "live.js", "log.js"}) {
    scripts += PageFile(name);
  }
  return PageText(title, PageFile("log.html"), scripts, data_json);
}

std::string BatchPageText(std::string_view title, std::string_view data_json) {
  return PageText(title, PageFile("batch.html"),
                  std::string(PageFile("batch.js")), data_json);
}

}  // namespace finray
