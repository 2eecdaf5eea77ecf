// Output for people. All text on stdout and stderr goes through here, encoded for a terminal. An
// error of the output is remembered.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

#include "drivers/text/encoders.hpp"

namespace traceraft::text {

inline constexpr std::size_t kLongestMessage = 300;  // characters

// Writes to stdout. `text` is encoded already.
void say_encoded(const std::string& text);
void flush_output();
// Why something said could not be written, "" if all could: "No space left on device".
std::string output_error();

// On stderr, in one line of at most kLongestMessage characters: "traceraft: message".
void say_error(const std::string& message);

namespace say_detail {

template <class Value>
Value encoded(const Value& value) {
  return value;
}
inline std::string encoded(const std::string& text) {
  return in_terminal(text);
}
inline std::string encoded(const char* text) {
  return in_terminal(text);
}
inline std::string encoded(const std::filesystem::path& path) {
  return in_terminal(path.string());
}

template <class Value>
Value argument(const Value& value) {
  return value;
}
inline const char* argument(const std::string& text) {
  return text.c_str();
}

template <class... Values>
std::string printed(const char* format, const Values&... values) {
  const int size = std::snprintf(nullptr, 0, format, values...);
  std::string text(static_cast<std::size_t>(size) + 1, '\0');
  std::snprintf(text.data(), text.size(), format, values...);
  text.pop_back();
  return text;
}

template <class... Values>
std::string with_arguments(const char* format, const Values&... values) {
  return printed(format, argument(values)...);
}

}  // namespace say_detail

// On stdout, as printf; %s takes std::string and paths, too. Texts among the values are encoded,
// the format is written as it is.
template <class... Values>
void say(const char* format, const Values&... values) {
  say_encoded(say_detail::with_arguments(format, say_detail::encoded(values)...));
}

}  // namespace traceraft::text
