#include "drivers/text/encoders.hpp"

#include <cstring>
#include <map>
#include <string_view>
#include <utility>

#include "drivers/text/utf8.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::text {
namespace {

// `replace` gets the code point and the bytes it stands as.
template <class Replace>
std::string each_code_point(std::string_view text, const Replace& replace) {
  std::string result;
  while (!text.empty()) {
    const CodePoint point = first_code_point(text);
    result += replace(point, text.substr(0, point.size));
    text.remove_prefix(point.size);
  }
  return result;
}

std::string without_controls(const std::string& text) {
  return each_code_point(text, [](const CodePoint& point, std::string_view bytes) {
    return is_control(point.value) && (point.valid || bytes[0] < 0x20) ? std::string(" ")
                                                                       : std::string(bytes);
  });
}

// Zero width, bidirectional controls, separators of lines and paragraphs, the byte order mark.
bool hides_or_reorders(char32_t point) {
  const std::pair<char32_t, char32_t> ranges[] = {
      {0x200B, 0x200F}, {0x2028, 0x202E}, {0x2060, 0x206F}, {0xFEFF, 0xFEFF}};
  for (const auto& [first, last] : ranges)
    if (point >= first && point <= last) return true;
  return false;
}

}  // namespace

std::string in_gnuplot(const std::string& text) {
  std::string result = "'";
  for (const char ch : without_controls(text))
    result += ch == '\'' ? "\xE2\x80\x99" : std::string(1, ch);
  return result + "'";
}

std::string in_shell(const std::string& text) {
  const char* plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_=.,:/+";
  const bool is_plain = text.find_first_not_of(plain) == std::string::npos;
  // zsh puts the path of a program for "=program".
  if (!text.empty() && is_plain && text[0] != '=') return text;
  std::string quoted = "'";
  for (const char ch : text) quoted += ch == '\'' ? std::string("'\\''") : std::string(1, ch);
  return quoted + "'";
}

std::string in_fish(const std::string& text) {
  std::string quoted = "'";
  for (const char ch : text) quoted += (ch == '\'' || ch == '\\' ? "\\" : "") + std::string(1, ch);
  return quoted + "'";
}

std::string in_comment(const std::string& text) {
  return without_controls(text);
}

std::string in_html(const std::string& text) {
  const std::string allowed = "\n\t";
  return each_code_point(text, [&](const CodePoint& point, std::string_view bytes) -> std::string {
    switch (point.value) {
      case '&':
        return "&amp;";
      case '<':
        return "&lt;";
      case '>':
        return "&gt;";
      case '"':
        return "&quot;";
      case '\'':
        return "&#39;";
      default:
        break;
    }
    const bool shown = point.valid && (!is_control(point.value) ||
                                       (bytes.size() == 1 && allowed.find(bytes) != allowed.npos));
    return shown ? std::string(bytes) : "\xEF\xBF\xBD";
  });
}

std::string in_roff(const std::string& text) {
  // Plain ASCII characters that roff, or a typesetter of it, makes other characters of.
  static const std::map<char32_t, std::string> named = {
      {'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"}, {'`', "\\(ga"},
      {'^', "\\(ha"}, {'~', "\\(ti"}, {'"', "\\(dq"}};
  const std::string encoded =
      each_code_point(text, [&](const CodePoint& point, std::string_view bytes) -> std::string {
        if (const auto name = named.find(point.value); name != named.end()) return name->second;
        if (is_control(point.value) && (point.valid || bytes[0] < 0x20)) return " ";
        if (!point.valid || hides_or_reorders(point.value)) return "\\[uFFFD]";
        return point.value < 0x80 ? std::string(bytes)
                                  : formatted("\\[u%04X]", static_cast<unsigned>(point.value));
      });
  // A line that begins with a point is a request. Nothing is shown for \&.
  return encoded.compare(0, 1, ".") == 0 ? "\\&" + encoded : encoded;
}

std::string in_html_script(const std::string& json) {
  std::string result;
  for (const char ch : json)
    result += ch == '<' || ch == '>' || ch == '&' ? formatted("\\u%04x", static_cast<unsigned>(ch))
                                                  : std::string(1, ch);
  return result;
}

std::string in_markdown(const std::string& text) {
  std::string result;
  for (const char ch : without_controls(text)) {
    if (ch == '<' || ch == '>' || ch == '&')
      result += in_html(std::string(1, ch));
    else
      result += (std::strchr("\\`*[]|~", ch) ? "\\" : "") + std::string(1, ch);
  }
  return result;
}

std::string in_markdown_link(const std::string& path) {
  const std::string plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.~/";
  std::string result;
  for (const char ch : path)
    result += plain.find(ch) != std::string::npos
                  ? std::string(1, ch)
                  : formatted("%%%02X", static_cast<unsigned>(static_cast<unsigned char>(ch)));
  return result;
}

std::string in_markdown_code(const std::string& text) {
  return without_controls(text);
}

std::string in_terminal(const std::string& text) {
  return each_code_point(text, [](const CodePoint& point, std::string_view bytes) {
    const auto value = static_cast<unsigned>(point.value);
    if (!point.valid || is_control(point.value))
      return formatted(value < 0x100 ? "\\x%02x" : "\\u%04x", value);
    return hides_or_reorders(point.value) ? formatted("\\u%04x", value) : std::string(bytes);
  });
}

std::string in_one_line(const std::string& text, std::size_t most) {
  const std::string gap = " ... ";
  // Each byte is a character at least, so that no more than these are looked at.
  const auto encoded = [](std::string_view part) { return in_terminal(std::string(part)); };
  const std::string_view all = text;
  if (all.size() <= most)
    if (const std::string line = encoded(all); line.size() <= most) return line;
  std::string head, tail;
  const std::size_t half = (most - gap.size()) / 2;
  for (std::string_view rest = all; !rest.empty();) {
    const CodePoint point = first_code_point(rest);
    const std::string next = encoded(rest.substr(0, point.size));
    if (head.size() + next.size() > half) break;
    head += next;
    rest.remove_prefix(point.size);
  }
  for (std::size_t end = all.size(); end > 0;) {
    std::size_t begin = end - 1;  // of the code point that ends there
    while (begin > 0 && end - begin < 4 && (static_cast<unsigned char>(all[begin]) & 0xC0) == 0x80)
      --begin;
    if (!is_utf8(all.substr(begin, end - begin))) begin = end - 1;
    const std::string next = encoded(all.substr(begin, end - begin));
    if (tail.size() + next.size() > half) break;
    tail = next + tail;
    end = begin;
  }
  // Between words, unless one is long.
  constexpr std::size_t kLongWord = 40;
  if (const std::size_t cut = head.rfind(' '); cut != head.npos && head.size() - cut < kLongWord)
    head.resize(cut);
  if (const std::size_t cut = tail.find(' '); cut < kLongWord) tail.erase(0, cut + 1);
  return head + gap + tail;
}

}  // namespace traceraft::text
