// A data set with something hidden in it, on disk.
#pragma once

#include <filesystem>

#include "drivers/config/configuration.hpp"
#include "verification/selection/blind/blind_case.hpp"

namespace traceraft::campaign {

// The hidden truth, in the units of the model's file and in those of the model.
struct HiddenTruth {
  std::vector<effects::EffectTerm> effects;  // in units of R and R²/(diffusion ratio D)
  double diffusion_ratio, noise;
};

// Completes a model that is not said to be another: a vesicle of 5 µm with wide phase boundaries,
// which explain takes a minute or two for. Values that are given stay. `source`: of the others.
void add_small_vesicle(config::GivenValues& model, const std::string& source);

// The cells of a truth for this model, unless others are asked for.
int truth_cells(const config::GivenValues& model);

// Throws InputError for a model that nothing can be hidden in, and for a truth that is no finer.
void refuse_hiding(const config::Configuration& model, const selection::BlindRequest& request);

// Draws a case and writes into the folder, in this order:
//   truth.json         what is hidden, with a random salt; nothing but the score opens it
//   data/seal.txt      the SHA-256 of truth.json
//   data/              the measurements, as `explain --data` takes them
//   model.toml         the model without what is hidden
// `request`: all but the base model and the raft fraction, which are those of `model`. Throws
// InputError as refuse_hiding does, std::runtime_error if a simulation fails, IoError.
void hide(const std::filesystem::path& folder, const config::GivenValues& model,
          selection::BlindRequest request);

// Throws IoError if the truth is not what was sealed.
HiddenTruth open_truth(const std::filesystem::path& folder);

}  // namespace traceraft::campaign
