// A table of what measured fields hold.
#pragma once

#include "drivers/input/field_dataset.hpp"

namespace traceraft::data {

// `folder`: that they were read from.
void print_fields(const std::filesystem::path& folder, const input::FieldDataset& data);

}  // namespace traceraft::data
