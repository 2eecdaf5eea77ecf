// The effect of errors on logarithms, in which only relative ones are normal.
#pragma once

namespace traceraft::observations {

// Whether errors that go with this power of the value are normal in its logarithm.
bool is_relative(double power);

// Mean of ln v minus ln n, for a positive value v = n (1 + a s z)^(1/a) with a normal z and
// a = 1 − power: n + n s z where the error is absolute (power 0), n exp(s z) where it is relative
// (1). s >= 0, 0 <= power <= 1. Only z with a positive 1 + a s z count. The mean is
// −(1 − power) s²/2 to second order.
double mean_of_logarithm(double s, double power);

// The same of a count, which is a whole number and 1 at least: of ln max(1, round(v)). Between
// whole numbers n >= 1: between theirs. Where s <= 1.5 within 0.01, of more than 32 within 0.03.
double mean_of_count_logarithm(double n, double s, double power);

}  // namespace traceraft::observations
