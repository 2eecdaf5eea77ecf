#include "backends/png/png_file.hpp"

#include <png.h>

#include <stdexcept>

namespace traceraft::png {

std::string png_bytes(const observables::Image& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  header.flags = PNG_IMAGE_FLAG_FAST;  // half as large again, in a third of the time
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(header), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr))
    throw std::runtime_error(std::string("libpng: ") + header.message);
  bytes.resize(size);
  return bytes;
}

observables::Image image_of_png(const std::string& bytes) {
  constexpr png_uint_32 kLargest = 1 << 13;
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  const auto refuse = [&](const char* why) {
    const std::string text = std::string("libpng: ") + why;
    png_image_free(&header);
    throw std::runtime_error(text);
  };
  if (!png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()))
    refuse(header.message);
  if (header.width > kLargest || header.height > kLargest) refuse("the image is too large");
  header.format = PNG_FORMAT_RGB;
  observables::Image image{static_cast<int>(header.width), static_cast<int>(header.height),
                           std::vector<std::uint8_t>(PNG_IMAGE_SIZE(header))};
  if (!png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr))
    refuse(header.message);
  return image;
}

}  // namespace traceraft::png
