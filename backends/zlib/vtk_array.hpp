// Arrays in VTK's XML files: blocks compressed by zlib, in base64.
#pragma once

#include <cstddef>
#include <string>

namespace traceraft::zlib {

std::string base64(const std::string& data);

// `bytes` bytes from `data` on: a header with block counts and sizes, then the blocks.
std::string encoded_array(const void* data, std::size_t bytes);
// The bytes that were encoded. Throws IoError if the text is damaged.
std::string decoded_array(const std::string& text);

// One zlib stream, as browsers decompress it.
std::string deflated(const std::string& data);

}  // namespace traceraft::zlib
