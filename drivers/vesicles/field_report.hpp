// What measured fields hold, as a table.
#pragma once

#include "drivers/input/field_dataset.hpp"

namespace traceraft {

void print_fields(const FieldDataset& data);

}  // namespace traceraft
