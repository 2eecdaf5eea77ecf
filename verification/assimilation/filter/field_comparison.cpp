#include "verification/assimilation/filter/field_comparison.hpp"

#include <cmath>

#include "backends/openblas/dense_algebra.hpp"
#include "kernel/core/random.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::assimilation {
namespace {

// −(ω × x)·∇_Γ c for turns about the three axes.
Columns turns(const problem::CahnHilliard& problem, const Vec& c) {
  const effects::EffectEntry& rotation = effects::effects().find("rotation");
  const fem::SurfaceSpace& space = problem.space();
  Columns result(c.size(), 3);
  for (int axis = 0; axis < 3; ++axis) {
    problem::CahnHilliardModel model = problem.model();
    std::vector<double> values{1, 0, 0, 0};
    values[1 + axis] = 1;
    model.effects.clear();
    rotation.add(Parameters(rotation.parameters, values), model);
    Vec first = Vec::Zero(c.size()), second = Vec::Zero(c.size()), rate(c.size());
    model.effects.front()->add_residual(space, 0, c, Vec::Zero(c.size()), first, second);
    bench::require(space.solve_mass(-first, rate));
    result.col(axis) = rate;
  }
  return result;
}

// The variance of noise is known to a relative standard error; each column has one of its own, the
// same in all snapshots.
void add_noise(std::size_t vesicle, std::size_t snapshot, double error, Columns& values) {
  const std::uint64_t stream = 10000 * (1000 * vesicle + snapshot);
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const auto column = static_cast<std::uint64_t>(j);
    const double size = std::exp(
        0.5 * error * normal_random(statistics::fixed_seed::replicate_noise_size, column, 0));
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      values(i, j) += size * normal_random(statistics::fixed_seed::replicate_values,
                                           stream + column, static_cast<std::uint64_t>(i));
  }
}

}  // namespace

FieldComparison compare_field(const FilterProblem& data, const problem::CahnHilliard& problem,
                              const FilterSettings& settings, const Belief& forecast,
                              std::size_t snapshot, const ResolvedForecast::End& mesh) {
  const NoisyValues& measured = data.snapshots[snapshot];
  const Vec noise = data.noise[snapshot] * measured.deviation, scale = noise.cwiseInverse();
  const WhiteningPtr& whitening = data.whitening[snapshot];
  const auto weighted = [&](const Columns& X) {
    const Columns scaled = scale.asDiagonal() * X;
    return whitening ? whitening->whitened(scaled) : scaled;
  };
  const auto seen = [&](const Columns& X) { return weighted(measured.trace * X); };
  const physics::DoubleWell& well = problem.model().well;
  const double distance = well.b - well.a;
  const Columns patterns = distance * data.patterns->at(well, forecast.c);
  const Columns turned = settings.turn * turns(problem, forecast.c);

  FieldComparison comparison;
  Innovation& in = comparison.in;
  in.vesicle = data.vesicle;
  in.snapshot = snapshot;
  in.held_out = snapshot >= data.train;
  // Traces of the forecast on this mesh lack more than its nodes do: `mesh.values` replaces the
  // trace of `mesh.field`.
  in.forecast = measured.trace * (forecast.c - mesh.field) + mesh.values;
  in.whitening = whitening;
  in.values = weighted(measured.values - in.forecast);
  Columns frame(scale.size(), 2);
  frame << settings.gain * seen(forecast.c),
      settings.offset * distance * weighted(Vec::Ones(scale.size()));
  // The model's boundaries are as wide as ever: it is the images that are blurred, each of them.
  if (data.blur) frame = side_by_side(frame, seen(data.blur->blurred(forecast.c) - forecast.c));
  const Columns errors = side_by_side(forecast.errors, turned), error_values = seen(errors);
  const Columns state = side_by_side(error_values, frame);
  in.directions = side_by_side(state, seen(patterns));
  in.state_directions = state.cols();
  in.gram = openblas::gram(in.directions);
  in.parameters = seen(forecast.parameters);
  in.parameters.col(kMeshError) += weighted(mesh.values_doubt - measured.trace * mesh.doubt).col(0);
  in.replicates = seen(forecast.replicates);
  add_noise(data.vesicle, snapshot, data.correlation.error, in.replicates);
  in.model_error = most_probable_error(in);
  in.noise = noise;
  // The first snapshot's scale and zero change the forecast. Their effect is taken out as that of
  // the others' is.
  in.first_frame = snapshot == 1 ? kFirstFrame : 0;
  comparison.known = forecast.errors.cols();
  comparison.frames = turned.cols() + frame.cols();
  const Columns unknown =
      at_points(in, error_values.middleCols(in.first_frame, comparison.known - in.first_frame));
  for (const RandomFields& part : forecast.random) {
    in.random.push_back({part.parameter, part.variance, seen(part.fields)});
    in.random_squares +=
        part.variance * (noise.asDiagonal() * at_points(in, in.random.back().values)).squaredNorm();
  }
  in.expected_squares = noise.squaredNorm() + (noise.asDiagonal() * unknown).squaredNorm();
  const Columns no_share = Columns::Zero(forecast.c.size(), frame.cols());
  comparison.fields = side_by_side(side_by_side(errors, no_share), patterns);
  return comparison;
}

}  // namespace traceraft::assimilation
