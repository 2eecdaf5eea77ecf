#include "drivers/campaign/shared_noise.hpp"

#include <algorithm>

#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft::campaign {

const std::vector<std::string>& shared_noise_shapes() {
  static const std::vector<std::string> shapes{"gaussian", "exponential"};
  return shapes;
}

void check_shared_noise(const SharedNoise& noise) {
  if (noise.share > 0 && noise.length == 0)
    throw InputError("--noise-share: it needs --noise-correlation");
  if (noise.length > 0 && noise.share == 0)
    throw InputError("--noise-correlation: it needs --noise-share");
  const std::vector<std::string>& shapes = shared_noise_shapes();
  if (std::find(shapes.begin(), shapes.end(), noise.shape) == shapes.end())
    throw InputError("--noise-shape: " + unknown_name_message("shape", noise.shape, shapes));
}

void set_shared_noise(const SharedNoise& noise, selection::BlindRequest& request) {
  check_shared_noise(noise);
  request.noise_share = noise.share;
  request.noise_correlation = noise.length;
  request.noise_shape = noise.shape == shared_noise_shapes()[0]
                            ? selection::NoiseShape::gaussian
                            : selection::NoiseShape::exponential;
}

}  // namespace traceraft::campaign
