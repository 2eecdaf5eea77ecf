// How deep the tables of a TOML text are nested, before it is parsed.
#pragma once

#include <string>

namespace traceraft::config {

// Parts of a key such as a.b.c; toml++ calls itself for each when it lets go of their tables, and
// has a limit of its own for nested brackets alone.
inline constexpr int kMostKeyParts = 32;

// The line of the first key with more parts; 0 if there is none. Texts and remarks do not count.
long line_of_deep_key(const std::string& text);

}  // namespace traceraft::config
