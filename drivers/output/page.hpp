// Self-contained pages: one HTML file that needs nothing else.
#pragma once

#include <string>
#include <vector>

namespace traceraft::output {

// The page that html() below has made, without its head and title.
std::string page_body(const std::string& html);

class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}
  void heading(const std::string& text);
  void paragraph(const std::string& text);
  void code(const std::string& text);
  void figure(const std::string& svg, const std::string& caption);
  // The first row is the heading. Cells that start with a digit or a sign are set as numbers.
  void table(const std::vector<std::vector<std::string>>& rows);
  void raw(const std::string& html);  // as it is
  std::string html() const;

 private:
  std::string title_, body_;
};

}  // namespace traceraft::output
