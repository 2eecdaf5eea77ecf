#include "drivers/output/page.hpp"

#include "drivers/text/encoders.hpp"

namespace traceraft::output {

std::string page_body(const std::string& html) {
  const std::string after = "</h1>\n";
  const std::size_t title = html.find(after), end = html.rfind("</body>");
  if (title == std::string::npos || end == std::string::npos) return "";
  const std::size_t begin = title + after.size();
  return html.substr(begin, end - begin);
}

void Page::heading(const std::string& text) {
  body_ += "<h2>" + text::in_html(text) + "</h2>\n";
}

void Page::paragraph(const std::string& text) {
  body_ += "<p>" + text::in_html(text) + "</p>\n";
}

void Page::code(const std::string& text) {
  body_ += "<pre>" + text::in_html(text) + "</pre>\n";
}

void Page::figure(const std::string& svg, const std::string& caption) {
  body_ += "<figure>" + svg + "<figcaption>" + text::in_html(caption) + "</figcaption></figure>\n";
}

void Page::table(const std::vector<std::vector<std::string>>& rows) {
  body_ += "<div class=\"wide\"><table>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::string tag = r == 0 ? "th" : "td";
    body_ += "<tr>";
    for (const std::string& cell : rows[r]) {
      const bool number =
          !cell.empty() && std::string("0123456789+-.").find(cell[0]) != std::string::npos;
      body_ +=
          "<" + tag + (number ? " class=\"n\">" : ">") + text::in_html(cell) + "</" + tag + ">";
    }
    body_ += "</tr>\n";
  }
  body_ += "</table></div>\n";
}

void Page::raw(const std::string& html) {
  body_ += html + "\n";
}

std::string Page::html() const {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
         text::in_html(title_) +
         "</title>\n<style>\n"
         "body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}\n"
         "table{border-collapse:collapse;font-size:14px}\n"
         "th,td{padding:.25em .7em;border-bottom:1px solid #ddd;text-align:left}\n"
         "td.n{text-align:right;font-variant-numeric:tabular-nums}\n"
         ".wide,pre{overflow-x:auto}\nfigure{margin:1em "
         "0}\nsvg{max-width:100%;height:auto}\nfigcaption{color:#555;font-size:14px}\n"
         "</style></head><body>\n<h1>" +
         text::in_html(title_) + "</h1>\n" + body_ + "</body></html>\n";
}

}  // namespace traceraft::output
