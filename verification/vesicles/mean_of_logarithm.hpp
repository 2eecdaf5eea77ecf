// What errors that are absolute do to logarithms, in which they are not normal.
#pragma once

namespace traceraft {

// Mean of ln(1 + s z) with a normal z, where 1 + s z is positive: −s²/2 to second order. s >= 0.
double mean_of_logarithm(double s);

// The same of a count, which is a whole number and 1 at least: mean of ln max(1, round(n + s n z))
// minus ln n, where n + s n z is positive. Between whole numbers n >= 1: between theirs.
double mean_of_count_logarithm(double n, double s);

}  // namespace traceraft
