// Seals: what was written down before can be shown not to have been changed after.
#pragma once

#include <cstdint>
#include <string>

namespace traceraft::sodium {

// SHA-256 of some bytes, as 64 hexadecimal digits.
std::string sha256(const std::string& bytes);

// 32 hexadecimal digits that nobody can guess: without them short secrets could be found by trying.
std::string random_salt();
// A seed that nobody can guess, below 2⁵³.
std::uint64_t random_seed();

}  // namespace traceraft::sodium
