#include "verification/observations/stated_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "kernel/core/random.hpp"
#include "verification/observations/mean_of_logarithm.hpp"

namespace traceraft::observations {
namespace {

constexpr double kValues[] = {2, 5, 3, 8};

MeasuredVesicles data_with(Quantity quantity, double power) {
  MeasuredVesicles data;
  for (const double value : kValues) {
    Measurement m{"a", data.measurements.size() + 1.0, 5, {}, {}};
    m.values[index_of(quantity)] = value;
    m.sigma[index_of(quantity)] = 0.1 * std::pow(value, power);
    data.measurements.push_back(m);
  }
  return data;
}

double variance(const StatedErrors& errors, const Measurement& m, double expected) {
  return errors.of(m, Quantity::perimeter).of_logarithm(std::log(expected));
}

// Whatever noise has made of a value, its error is that of the value that is expected.
TEST(StatedErrors, AreThoseOfWhatIsExpected) {
  for (const double power : {0.0, 0.5, 1.0}) {
    const MeasuredVesicles data = data_with(Quantity::perimeter, power);
    const StatedErrors errors(data);
    EXPECT_NEAR(errors.power(Quantity::perimeter), power, 1e-12);
    for (const Measurement& m : data.measurements)
      EXPECT_NEAR(variance(errors, m, 4), std::pow(0.1 * std::pow(4, power) / 4, 2), 1e-12);
  }
}

TEST(StatedErrors, AreAbsoluteOrRelativeAtMost) {
  const auto power = [](const MeasuredVesicles& data) {
    return StatedErrors(data).power(Quantity::perimeter);
  };
  EXPECT_EQ(power(data_with(Quantity::perimeter, 2)), 1);
  EXPECT_EQ(power(data_with(Quantity::perimeter, -1)), 0);
  EXPECT_EQ(power({}), 0);
  MeasuredVesicles alike = data_with(Quantity::perimeter, 1);
  for (Measurement& m : alike.measurements) m.values[0] = 3;
  EXPECT_EQ(power(alike), 0);
}

// By the truth, of which noise in a value knows nothing: such differences are left alone.
TEST(StatedErrors, DoNotFollowTheNoiseOfValues) {
  MeasuredVesicles data = data_with(Quantity::perimeter, 0);
  for (Measurement& m : data.measurements) {
    m.sigma[0] = 0.2 * *m.values[0];
    m.values[0] = *m.values[0] * (m.time == 2 ? 1.2 : 0.9);
  }
  const StatedErrors errors(data);
  const double usual = variance(errors, data.measurements[0], 4);
  for (const Measurement& m : data.measurements) EXPECT_NEAR(variance(errors, m, 4), usual, 1e-12);
  // One that is ten times as large is no noise.
  Measurement other = data.measurements[0];
  *other.sigma[0] *= 10;
  EXPECT_NEAR(variance(errors, other, 4), 100 * usual, 60 * usual);
}

// A measurement from before anything could happen says nothing of the others.
TEST(StatedErrors, LeaveLooksOfTimeZeroOut) {
  MeasuredVesicles data = data_with(Quantity::perimeter, 0);
  Measurement first = data.measurements[0];
  first.time = 0;
  first.values[0] = 60;
  first.sigma[0] = 10;
  data.measurements.insert(data.measurements.begin(), first);
  EXPECT_EQ(StatedErrors(data).power(Quantity::perimeter), 0);
}

// Half of the looks state 10 %, the others 40 %: noise is not the reason.
TEST(StatedErrors, DifferAsTheyAreStated) {
  MeasuredVesicles data;
  for (int k = 0; k < 8; ++k) {
    Measurement m{"a", k + 1.0, 5, {}, {}};
    m.values[0] = 2 + k / 2;
    m.sigma[0] = (k % 2 ? 0.4 : 0.1) * *m.values[0];
    data.measurements.push_back(m);
  }
  const StatedErrors errors(data);
  for (int k = 0; k < 8; ++k)
    EXPECT_NEAR(std::sqrt(variance(errors, data.measurements[static_cast<std::size_t>(k)], 3)),
                k % 2 ? 0.4 : 0.1, 1e-9);
}

// Half of the looks are by an instrument twice as bad, absolutely: noise in their values is none of
// the reasons.
TEST(StatedErrors, OfTwoInstrumentsDifferAsTheyAreStated) {
  MeasuredVesicles data;
  for (int k = 0; k < 8; ++k) {
    Measurement m{"a", k + 1.0, 5, {}, {}};
    m.values[0] = 2 + k / 2;
    m.sigma[0] = k % 2 ? 1.0 : 0.5;
    data.measurements.push_back(m);
  }
  const StatedErrors errors(data);
  for (const Measurement& m : data.measurements)
    EXPECT_NEAR(std::sqrt(variance(errors, m, 4)), *m.sigma[0] / 4, 1e-9);
}

// By a trapezoidal rule in ln x, elsewhere.
TEST(StatedErrors, KnowTheMeanOfTheLogarithm) {
  const std::pair<double, double> known[] = {{0, 0},
                                             {0.1, -0.00507764},
                                             {0.3, -0.05331620},
                                             {0.5, -0.12557756},
                                             {0.7, -0.12394375},
                                             {1, -0.03521329},
                                             {2, 0.34807784},
                                             {4, 0.89293144},
                                             {30, 2.78451603}};
  for (const auto& [s, mean] : known) EXPECT_NEAR(mean_of_logarithm(s, 0), mean, 2e-5) << s;
}

struct Errors {
  double mean, of_mean;
};

// The mean of ln of a value with an error, less ln of the value.
Errors drawn_mean(const StatedError& error, double value, const std::function<double(double)>& f) {
  constexpr int kDrawn = 40000;
  double mean = 0, squares = 0;
  for (std::uint64_t i = 0; i < kDrawn; ++i) {
    const double drawn =
        error.drawn(std::log(value), [i](std::uint64_t k) { return normal_random(1, k, i); });
    const double away = f(drawn) - std::log(value);
    mean += away / kDrawn;
    squares += away * away / kDrawn;
  }
  return {mean, std::sqrt(squares / kDrawn)};
}

// Relative errors are normal in the logarithm, absolute ones in the value: as they are drawn.
TEST(StatedErrors, AreDrawnAsTheMeanOfTheLogarithmSays) {
  for (const double size : {0.3, 2.0, 4.0, 16.0})
    for (const double power : {0.0, 0.5, 1.0}) {
      const StatedError error{std::log(size) - power * std::log(4), power, false};
      const Errors drawn = drawn_mean(error, 4, [](double ln_value) { return ln_value; });
      EXPECT_NEAR(drawn.mean, error.bias(std::log(4)), 4 * drawn.of_mean) << size << " " << power;
    }
}

// A count is a whole number, and 1 at least.
TEST(StatedErrors, OfCountsAreDrawnAsTheMeanOfTheLogarithmSays) {
  const auto counted = [](double ln_value) {
    return std::log(std::max(1.0, std::round(std::exp(ln_value))));
  };
  for (const double power : {0.0, 0.25, 0.5, 0.87, 1.0})
    for (const double count : {1, 2, 5, 10, 31, 40})
      for (const double relative : {0.1, 0.3, 0.5, 1.5, 6.0}) {
        if (count > 32 && relative > 1.5) continue;  // not known
        const StatedError error{std::log(relative) + (1 - power) * std::log(count), power, true};
        const Errors drawn = drawn_mean(error, count, counted);
        EXPECT_NEAR(drawn.mean, error.bias(std::log(count)), 4 * drawn.of_mean + 1e-3)
            << count << " " << relative << " " << power;
      }
}

// By the midpoint rule in z.
double integrated_count_mean(int n, double s, double power) {
  constexpr int kPoints = 100000;
  constexpr double kTail = 8;
  const double a = 1 - power, from = std::max(-kTail, -1 / (a * s));
  double mean = 0, weights = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double z = from + (kTail - from) * (i + 0.5) / kPoints, weight = std::exp(-0.5 * z * z);
    const double v = n * std::pow(1 + a * s * z, 1 / a);
    mean += weight * std::log(std::max(1.0, std::round(v)));
    weights += weight;
  }
  return mean / weights - std::log(n);
}

TEST(StatedErrors, OfCountsKnowTheirMeanBetweenPowersAndNumbers) {
  for (const double power : {0.04, 0.3, 0.75, 0.87, 0.95, 0.995})
    for (const int n : {1, 2, 3, 7, 20, 32})
      for (const double s : {0.02, 0.2, 0.7, 1.5})
        EXPECT_NEAR(mean_of_count_logarithm(n, s, power), integrated_count_mean(n, s, power), 0.01)
            << n << " " << s << " " << power;
}

TEST(StatedErrors, ThatAreNearlyRelativeAreNearlyNormal) {
  for (const double power : {0.99, 0.9999})
    for (const double s : {0.1, 0.3, 1.0})
      EXPECT_NEAR(mean_of_logarithm(s, power) / (-0.5 * (1 - power) * s * s), 1, 0.02)
          << s << " " << power;
}

TEST(StatedErrors, OfCountsAreThoseOfRoundingAtLeast) {
  for (const Quantity quantity : {Quantity::rafts, Quantity::perimeter}) {
    MeasuredVesicles data = data_with(quantity, 0);
    for (Measurement& m : data.measurements) m.sigma = {};
    const StatedError error = StatedErrors(data).of(data.measurements[0], quantity);
    EXPECT_EQ(error.stated(std::log(4)), 0);
    EXPECT_NEAR(error.of_logarithm(std::log(4)), quantity == Quantity::rafts ? 1 / 12.0 / 16 : 0,
                1e-15);
  }
}

}  // namespace
}  // namespace traceraft::observations
