// Text that becomes part of another language. There is one encoder per language, and no other way
// to write text into it (tests/architecture/encoder_rule_test.cpp).
#pragma once

#include <cstddef>
#include <string>

namespace traceraft::text {

// A string literal of gnuplot, with its single quotes, within which nothing else is special. Single
// quotes become U+2019: two of them mean one, but not where a literal begins (gnuplot 5.4). Control
// characters become blanks, since a line break ends a command within quotes, too.
std::string in_gnuplot(const std::string& text);

// A word of a command of sh, bash or zsh, quoted where a shell would make something else of it.
// Line breaks stay what they are within quotes.
std::string in_shell(const std::string& text);
// A word of a command of fish, which reads backslashes within quotes, too. Always quoted.
std::string in_fish(const std::string& text);
// The rest of a line that begins with #, in a script of sh, in TOML and in CSV.
std::string in_comment(const std::string& text);

// Text or the value of an attribute. Control characters but tab and line break become U+FFFD.
std::string in_html(const std::string& text);

// A piece of a line of a manual page, wherever it stands in that line. Nothing in it is a request
// or an escape of roff. Line breaks and other control characters become blanks; what is no UTF-8,
// or hides or reorders other text, becomes U+FFFD.
std::string in_roff(const std::string& text);

// JSON in a script of a page: no end tag and no comment can stand in it.
std::string in_html_script(const std::string& json);

// A piece of a paragraph or of a table cell. Line breaks become blanks.
std::string in_markdown(const std::string& text);
// The target of a link, as a URL: bytes that are not plain as %xx.
std::string in_markdown_link(const std::string& path);
// A line of an indented block of code.
std::string in_markdown_code(const std::string& text);

// Text that a terminal shows as it is. Escapes such as \x1b stand for control characters, for bytes
// that are no UTF-8 and for code points that hide or reorder others.
std::string in_terminal(const std::string& text);
// The same of a message in one line: at most `most` characters, the middle of a longer one left
// out.
std::string in_one_line(const std::string& text, std::size_t most);

}  // namespace traceraft::text
