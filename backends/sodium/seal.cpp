#include "backends/sodium/seal.hpp"

#include <sodium.h>

#include <array>
#include <stdexcept>

namespace traceraft::sodium {
namespace {

template <std::size_t Bytes>
std::string hexadecimal(const std::array<unsigned char, Bytes>& bytes) {
  std::string text(2 * Bytes + 1, '\0');
  sodium_bin2hex(text.data(), text.size(), bytes.data(), bytes.size());
  text.pop_back();
  return text;
}

void initialise() {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot be initialised");
}

}  // namespace

std::string sha256(const std::string& bytes) {
  initialise();
  std::array<unsigned char, crypto_hash_sha256_BYTES> hash;
  crypto_hash_sha256(hash.data(), reinterpret_cast<const unsigned char*>(bytes.data()),
                     bytes.size());
  return hexadecimal(hash);
}

std::string random_salt() {
  initialise();
  std::array<unsigned char, 16> salt;
  randombytes_buf(salt.data(), salt.size());
  return hexadecimal(salt);
}

std::uint64_t random_seed() {
  initialise();
  std::uint64_t seed = 0;
  randombytes_buf(&seed, sizeof seed);
  return seed >> 11;
}

}  // namespace traceraft::sodium
