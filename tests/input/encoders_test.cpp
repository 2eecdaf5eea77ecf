// Hostile text in every language that the program writes.
#include "drivers/text/encoders.hpp"

#include <gtest/gtest.h>

#include "drivers/text/utf8.hpp"
#include "kernel/core/random.hpp"
#include "tests/support/hostile.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft::input {
namespace {

bool holds_control(const std::string& text) {
  for (const char ch : text)
    if (text::is_control(static_cast<unsigned char>(ch)) && static_cast<unsigned char>(ch) < 0x80)
      return true;
  return false;
}

TEST(Encoders, GnuplotGetsOneLiteral) {
  EXPECT_EQ(text::in_gnuplot("a 'b' c"),
            "'a \xE2\x80\x99"
            "b\xE2\x80\x99 c'");
  for (const std::string& text : testing::hostile_texts()) {
    const std::string literal = text::in_gnuplot(text);
    EXPECT_FALSE(holds_control(literal)) << literal;
    EXPECT_EQ(literal.find('\'', 1), literal.size() - 1) << literal;
  }
}

// A shell gives back what went in.
TEST(Encoders, AShellReadsTheSameWord) {
  const auto expect_same = [](const std::string& shell, const std::string& text,
                              std::string (*encoded)(const std::string&)) {
    const testing::TemporaryFolder folder;
    posix::write_durably(folder.path / "script", "cd " + encoded(folder.path.string()) +
                                                     "\nprintf %s " + encoded(text) + "\n");
    const testing::ProgramEnd end = testing::shell(shell + " " + (folder.path / "script").string());
    EXPECT_EQ(end.output, text) << shell;
    EXPECT_EQ(folder.entries(), 1u) << shell << " executed a command: " << text;
  };
  for (const std::string& text : testing::hostile_texts()) {
    if (text.find('\0') != std::string::npos) continue;  // no word of a command can hold it
    for (const char* shell : {"sh", "bash", "zsh -f"}) expect_same(shell, text, text::in_shell);
    if (text::is_utf8(text)) expect_same("fish --no-config", text, text::in_fish);
  }
}

// The typesetter of manual pages shows what went in, also at the beginning of a line.
TEST(Encoders, RoffShowsTheSameText) {
  const auto shown = [](const std::string& text) {
    const testing::TemporaryFolder folder;
    posix::write_durably(folder.path / "page", ".TH page 1\n.nf\n" + text::in_roff(text) + "\n");
    const testing::ProgramEnd end =
        testing::shell("cd " + folder.path.string() + " && groff -man -Tutf8 -P-cbou page");
    EXPECT_EQ(end.code, 0) << "is groff installed? " << text;
    EXPECT_EQ(folder.entries(), 1u) << "a command was executed: " << text;
    return end.output;
  };
  for (const char* text :
       {".so x", "'sy x", "a\\fBb\\e", "--flag 'a' \"b\" `c` ^d ~e\\", "\xC3\xA9 \xCE\xB5"})
    EXPECT_NE(shown(text).find(text), std::string::npos) << text << "\n" << shown(text);
  EXPECT_EQ(text::in_roff("a\n.so x\tb"), "a .so x b");
  EXPECT_EQ(text::in_roff("\xFF\xE2\x80\xAE"), "\\[uFFFD]\\[uFFFD]");
  for (const std::string& text : testing::hostile_texts()) {
    EXPECT_FALSE(holds_control(text::in_roff(text))) << text;
    EXPECT_EQ(shown(text.substr(0, 500)).find("root:"), std::string::npos) << text;
  }
}

TEST(Encoders, AShellExecutesNothingInAComment) {
  for (const std::string& text : testing::hostile_texts()) {
    const testing::TemporaryFolder folder;
    posix::write_durably(folder.path / "script", "cd " + text::in_shell(folder.path.string()) +
                                                     "\n# " + text::in_comment(text) + "\n");
    EXPECT_EQ(testing::shell("sh " + (folder.path / "script").string()).output, "") << text;
    EXPECT_EQ(folder.entries(), 1u) << "a command was executed: " << text;
  }
}

TEST(Encoders, HtmlGetsTextAndValuesOfAttributes) {
  EXPECT_EQ(text::in_html("<a href=\"x\">'&"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;");
  EXPECT_EQ(text::in_html("a\x1b[2J\nb"), "a\xEF\xBF\xBD[2J\nb");
  for (const std::string& text : testing::hostile_texts()) {
    EXPECT_EQ(text::in_html(text).find_first_of("<>\"'"), std::string::npos) << text;
    EXPECT_TRUE(text::is_utf8(text::in_html(text))) << text;
  }
}

TEST(Encoders, ScriptsOfPagesGetJsonThatCannotEndThem) {
  EXPECT_EQ(text::in_html_script("[\"</script><!--\"]"), "[\"\\u003c/script\\u003e\\u003c!--\"]");
}

TEST(Encoders, MarkdownGetsOneLineWithoutTagsLinksAndCode) {
  EXPECT_EQ(text::in_markdown("a_b < c|d [x](y) `z` *w*"),
            "a_b &lt; c\\|d \\[x\\](y) \\`z\\` \\*w\\*");
  EXPECT_EQ(text::in_markdown_link("a b/(c).svg"), "a%20b/%28c%29.svg");
  for (const std::string& text : testing::hostile_texts()) {
    EXPECT_FALSE(holds_control(text::in_markdown(text))) << text;
    EXPECT_EQ(text::in_markdown(text).find('<'), std::string::npos) << text;
    EXPECT_FALSE(holds_control(text::in_markdown_code(text))) << text;
  }
}

TEST(Encoders, ATerminalGetsNothingThatMovesOrHides) {
  EXPECT_EQ(text::in_terminal("a\x1b[31m\n"), "a\\x1b[31m\\x0a");
  EXPECT_EQ(text::in_terminal("\xC2\x9B"
                              "31m"),
            "\\x9b31m");                                                   // CSI as one code point
  EXPECT_EQ(text::in_terminal("x\xE2\x80\xAEy"), "x\\u202ey");             // right to left
  EXPECT_EQ(text::in_terminal("\xFF"), "\\xff");                           // no UTF-8
  EXPECT_EQ(text::in_terminal("\xC3\xA9 \xCE\xB5"), "\xC3\xA9 \xCE\xB5");  // é ε
  for (const std::string& text : testing::hostile_texts()) {
    EXPECT_FALSE(holds_control(text::in_terminal(text)));
    EXPECT_TRUE(text::is_utf8(text::in_terminal(text)));
    EXPECT_EQ(text::in_terminal(text::in_terminal(text)), text::in_terminal(text));
  }
}

TEST(Encoders, MessagesAreOneLineOfAFewWords) {
  EXPECT_EQ(text::in_one_line("short", 300), "short");
  const std::string line = text::in_one_line("begin " + std::string(100000, 'x') + "\n end", 300);
  EXPECT_LE(line.size(), 300u);
  EXPECT_EQ(line.compare(0, 6, "begin "), 0) << line;
  EXPECT_EQ(line.substr(line.size() - 8), "\\x0a end") << line;
  for (const std::string& text : testing::hostile_texts()) {
    EXPECT_LE(text::in_one_line(text, 40).size(), 40u);
    EXPECT_TRUE(text::is_utf8(text::in_one_line(text, 40)));
  }
}

// All of a random string is looked at, in pieces that are never empty.
TEST(Utf8, AgreesWithItself) {
  for (std::uint64_t k = 0; k < 2000; ++k) {
    std::string text;
    for (std::uint64_t i = 0; i < 12; ++i)
      text += static_cast<char>(static_cast<int>(256 * uniform_random(k, 1, i)));
    EXPECT_TRUE(text::is_utf8(text::in_terminal(text)));
    if (text::is_utf8(text)) {
      EXPECT_EQ(text::first_code_point(text).valid, true);
    }
  }
  EXPECT_FALSE(text::is_utf8("\xC0\x80")) << "a longer form than needed";
  EXPECT_FALSE(text::is_utf8("\xED\xA0\x80")) << "half of a surrogate pair";
  EXPECT_FALSE(text::is_utf8("\xF4\x90\x80\x80")) << "beyond U+10FFFF";
  EXPECT_FALSE(text::is_utf8("\xE2\x82")) << "cut off";
  EXPECT_TRUE(text::is_utf8("\xF0\x9F\xA7\xAB"));
}

}  // namespace
}  // namespace traceraft::input
