// Text that somebody might give to have it executed, hidden or misread.
#pragma once

#include <string>
#include <vector>

namespace traceraft::testing {

inline std::vector<std::string> hostile_texts() {
  using namespace std::string_literals;
  return {"x\nsystem 'touch hit'\n",
          "x\r!touch hit\n",
          "a'; system('touch hit'); '",
          "a\\",
          "`touch hit`",
          "$(touch hit)",
          "@macro",
          "|touch hit",
          "<touch hit",
          "';touch hit;'",
          "\"; touch hit; \"",
          "#\ntouch hit\n",
          "</title><script>alert(1)</script>",
          "\" onmouseover=\"alert(1)",
          "--><script>alert(1)</script><!--",
          "]]><x>",
          "[x](javascript:alert(1))",
          "![x](http://example.org/x.png)",
          "a | b |\n|---|---|\n# heading",
          "\x1b]0;title\x07\x1b[2J\x1b[31m",
          "\xC2\x9B"
          "31mred",
          "\xE2\x80\xAEtxt.exe",
          "\xEF\xBB\xBF",
          "\xFF\xFE",
          "nul\0byte"s,
          ".so /etc/passwd\n'sy touch hit\n.pi touch hit",
          "\\fI\\s+9\\n[.fam]\\*[x]\\c",
          "'\\''; touch hit; '",
          "=touch",
          "=HYPERLINK(\"http://example.org\")",
          "../../victim",
          "-rf",
          "%s%n%x",
          "{{7*7}}",
          std::string(5000, 'A'),
          std::string(3000, '\n')};
}

}  // namespace traceraft::testing
