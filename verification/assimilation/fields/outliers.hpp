// Values that belong to no field: bright specks, dead pixels, slips of a segmentation.
#pragma once

#include "verification/assimilation/fields/field_series.hpp"

namespace traceraft::assimilation {

// Removes the places whose value is further from `field` (its values there) than the noise of the
// others explains and than `least`. One pass: neighbours of an outlier, which has pulled the field
// away from them, are left for the next, with another field. Returns how many.
std::size_t drop_outliers(const Vec& field, double least, FieldSnapshot& snapshot);

}  // namespace traceraft::assimilation
