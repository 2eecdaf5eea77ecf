#include "backends/gif/gif_writer.hpp"

#include <gif_lib.h>

#include <memory>
#include <stdexcept>

namespace traceraft::gif {
namespace {

constexpr int kColours = 256;

void check(int result) {
  if (result != GIF_OK) throw std::runtime_error("giflib could not write an animation");
}

int append(GifFileType* file, const GifByteType* data, int size) {
  static_cast<std::string*>(file->UserData)->append(reinterpret_cast<const char*>(data), size);
  return size;
}

// Forever: the extension that Netscape introduced.
void put_loop(GifFileType* file) {
  const unsigned char times[] = {1, 0, 0};
  check(EGifPutExtensionLeader(file, APPLICATION_EXT_FUNC_CODE));
  check(EGifPutExtensionBlock(file, 11, "NETSCAPE2.0"));
  check(EGifPutExtensionBlock(file, sizeof times, times));
  check(EGifPutExtensionTrailer(file));
}

// Writes an image with the 256 colours that suit it best.
void put_image(GifFileType* file, const observables::Image& image, int centiseconds) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  std::vector<GifByteType> red(pixels), green(pixels), blue(pixels), index(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    red[i] = image.rgb[3 * i];
    green[i] = image.rgb[3 * i + 1];
    blue[i] = image.rgb[3 * i + 2];
  }
  const std::unique_ptr<ColorMapObject, decltype(&GifFreeMapObject)> colours(
      GifMakeMapObject(kColours, nullptr), GifFreeMapObject);
  if (!colours) throw std::bad_alloc();
  int count = kColours;
  check(GifQuantizeBuffer(image.width, image.height, &count, red.data(), green.data(), blue.data(),
                          index.data(), colours->Colors));
  const GraphicsControlBlock control{DISPOSE_DO_NOT, false, centiseconds, NO_TRANSPARENT_COLOR};
  GifByteType extension[4];
  check(EGifGCBToExtension(&control, extension) == 4 ? GIF_OK : GIF_ERROR);
  check(EGifPutExtension(file, GRAPHICS_EXT_FUNC_CODE, 4, extension));
  check(EGifPutImageDesc(file, 0, 0, image.width, image.height, false, colours.get()));
  for (int row = 0; row < image.height; ++row)
    check(
        EGifPutLine(file, index.data() + static_cast<std::size_t>(row) * image.width, image.width));
}

}  // namespace

std::string gif_bytes(const std::vector<observables::Image>& images, int centiseconds) {
  std::string bytes;
  int error = 0;
  GifFileType* file = EGifOpen(&bytes, append, &error);
  if (!file) throw std::runtime_error("giflib could not begin an animation");
  try {
    EGifSetGifVersion(file, true);
    check(EGifPutScreenDesc(file, images.front().width, images.front().height, 8, 0, nullptr));
    put_loop(file);
    for (const observables::Image& image : images) put_image(file, image, centiseconds);
  } catch (...) {
    EGifCloseFile(file, &error);
    throw;
  }
  check(EGifCloseFile(file, &error));
  return bytes;
}

}  // namespace traceraft::gif
