#include "verification/assimilation/filter/field_filter.hpp"

#include <cmath>
#include <future>
#include <optional>

#include "backends/openblas/dense_algebra.hpp"
#include "kernel/core/random.hpp"
#include "verification/assimilation/filter/random_motion.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::assimilation {
namespace {

// The size as which a gap is looked for in forecasts that lack something, in units of the distance
// of the phases.
constexpr double kUsualGap = 0.02;

class Filter {
 public:
  Filter(const FilterProblem& data, const FilterModel& model, const FilterSettings& settings,
         ErrorMaps& maps)
      : data_(data),
        diffusion_ratio_(model.diffusion_ratio),
        settings_(settings),
        maps_(maps),
        random_(random_parts(data, model.hypothesis, model.screened)),
        problem_(data.space, problem::without_noise(
                                 effects::with_effects(model.base, model.hypothesis.terms()))),
        flow_(problem_, data.tangent_solver,
              maps.intervals() == 0 ? std::make_shared<const ThreadTeam>(1) : data.team),
        forcing_(problem_, model.base, model.hypothesis, model.screened) {
    if (maps.intervals() == 0)
      resolved_.emplace(*data.finer, data.finer_traces, problem_.model(), data.first_resolved,
                        data.make_integrator);
    Eigen::Index parameters = kFirstParameter + model.hypothesis.coefficients();
    for (const Candidate& candidate : model.screened) parameters += candidate.directions;
    belief_.c = data.first.field;
    belief_.errors = data.first.errors;
    belief_.parameters = Columns::Zero(data.space->nodes(), parameters);
    belief_.replicates = data.first.draws.leftCols(settings.replicates);
    result_.information = Eigen::MatrixXd::Zero(parameters, parameters);
    result_.score = Vec::Zero(parameters);
    result_.variance_score = result_.variance_information = Vec::Zero(parameters);
    result_.null_scores = Eigen::MatrixXd::Zero(parameters, settings.replicates);
  }

  FilterResult run() {
    for (std::size_t k = 0; k + 1 < data_.snapshots.size(); ++k) {
      advance(k);
      compare(k);
    }
    return std::move(result_);
  }

 private:
  void advance(std::size_t k) {
    const double begin = diffusion_ratio_ * data_.time(k),
                 end = diffusion_ratio_ * data_.time(k + 1);
    const SnapshotTurn* turn = data_.turns[k + 1].get();
    // The finer meshes on one processor, everything else on the other.
    std::future<ResolvedForecast::End> resolved;
    if (resolved_)
      resolved = std::async(
          data_.team->size() > 1 ? std::launch::async : std::launch::deferred,
          [=] { return resolved_->advance(k + 1, begin, end, turn ? &turn->finest : nullptr); });
    const auto on_its_mesh = [this](const problem::DaeProblem& p) {
      return data_.make_integrator(p, *data_.space);
    };
    const Forecast way =
        forecast(problem_, on_its_mesh, belief_.c, begin, end,
                 {settings_.tangent_steps, settings_.error_steps, settings_.random_steps});
    if (resolved_) map_errors(way, turn);
    if (resolved_) map_random(way.paths[2], end - begin, turn);
    belief_.errors = openblas::product(
        maps_.image[k], openblas::transposed_product(maps_.basis[k], data_.mass * belief_.errors));
    belief_.replicates = maps_.replicates[k].leftCols(settings_.replicates);
    flow_.advance(way.paths[0], belief_.parameters,
                  [&](double t, VecView y) { return forcing(begin, end, t, y); });
    belief_.parameters.col(kDiffusionRatio) += (end - begin) * way.end_rate;
    if (turn) belief_.parameters = turn->own.columns(belief_.parameters);
    const Vec there = turn ? turn->own(way.end) : way.end;
    if (resolved_) map_mesh(k, resolved.get(), there);
    belief_.parameters.col(kMeshError) += maps_.mesh_error[k].doubt;
    belief_.c = there + maps_.mesh_error[k].field;
    add_random(k, end - begin);
  }

  void map_random(const TangentPath& way, double duration, const SnapshotTurn* turn) {
    maps_.random.emplace_back();
    maps_.duration.push_back(duration);
    for (const FilterProblem::Random& random : data_.random) {
      const Columns fields =
          noises_at_end(data_, *random.effect, way, settings_.random_rank, flow_);
      maps_.random.back().push_back(turn ? turn->own.columns(fields) : fields);
    }
  }

  // What random effects may have added since snapshot k.
  void add_random(std::size_t k, double duration) {
    belief_.random.clear();
    for (std::size_t p = 0; p < random_.size(); ++p) {
      belief_.random.push_back(
          {random_[p].parameter, random_[p].variance,
           std::sqrt(duration / maps_.duration[k]) * maps_.random[k][random_[p].effect]});
      if (random_[p].variance == 0) continue;
      const Columns errors = std::sqrt(random_[p].variance) * belief_.random[p].fields;
      belief_.errors = side_by_side(belief_.errors, errors);
      belief_.replicates += openblas::product(
          errors, normal_columns(statistics::fixed_seed::replicate_random_effects,
                                 stream_of(k + 1, p), errors.cols(), belief_.replicates.cols()));
    }
  }

  std::uint64_t stream_of(std::size_t snapshot, std::size_t part) const {
    return 10 * (1000 * data_.vesicle + snapshot) + part;
  }
  static Columns normal_columns(std::uint64_t seed, std::uint64_t stream, Eigen::Index rows,
                                Eigen::Index columns) {
    Columns normal(rows, columns);
    for (Eigen::Index i = 0; i < normal.size(); ++i)
      normal.data()[i] = normal_random(seed, stream, static_cast<std::uint64_t>(i));
    return normal;
  }

  // ∂F/∂θ of all parameters. With F = F(diffusion ratio t, …) the derivative S of c by ln diffusion
  // ratio has two parts: (t − begin) ċ, which is added at the end, and what an F that changes in
  // time does at another time of the vesicle, begin ∂F/∂t.
  Columns forcing(double begin, double end, double t, VecView y) const {
    const double step = 1e-4 * (end - begin);
    const Vec no_rate = Vec::Zero(problem_.size());
    Vec before(problem_.size()), after(problem_.size());
    bench::require(problem_.residual(t - step, y, no_rate, before));
    bench::require(problem_.residual(t + step, y, no_rate, after));
    Columns all = Columns::Zero(problem_.size(), belief_.parameters.cols());
    all.col(kDiffusionRatio) = begin / (2 * step) * (after - before);
    all.rightCols(all.cols() - kFirstParameter) = forcing_(t, y);
    return all;
  }

  void map_mesh(std::size_t k, ResolvedForecast::End&& resolved, VecView end) {
    resolved.field -= end;
    resolved.values -= data_.snapshots[k + 1].trace * end;
    maps_.mesh_error.push_back(std::move(resolved));
  }

  void map_errors(const Forecast& way, const SnapshotTurn* turn) {
    Columns basis = belief_.errors;
    orthonormalise(basis);
    Columns moved = side_by_side(basis, belief_.replicates);
    flow_.advance(way.paths[1], moved);
    if (turn) moved = turn->own.columns(moved);
    maps_.image.push_back(moved.leftCols(basis.cols()));
    maps_.replicates.push_back(moved.rightCols(settings_.replicates));
    maps_.basis.push_back(std::move(basis));
  }

  void orthonormalise(Columns& X) const {
    compress(data_.mass, X, settings_.rank);
    const Vec size = (X.cwiseProduct(data_.mass * X)).colwise().sum().cwiseSqrt().transpose();
    X = (X * size.cwiseInverse().asDiagonal()).eval();
  }

  void compare(std::size_t k) {
    FieldComparison comparison =
        compare_field(data_, problem_, settings_, belief_, k + 1, maps_.mesh_error[k]);
    Innovation& in = comparison.in;
    const InnovationCovariance weight(in, in.model_error);
    const Vec found = weight.amplitudes(in.values);
    in.frame = found.segment(comparison.known, comparison.frames);
    const Vec gap = in.values -
                    in.directions.middleCols(comparison.known, comparison.frames) * in.frame -
                    in.directions.leftCols(in.first_frame) * found.head(in.first_frame);
    in.gap = at_points(in, gap);
    in.weighted_squares = in.values.dot(weight.solve(in.values).col(0));
    if (!in.held_out) account(in, weight);
    if (in.replicates.cols() > 0)
      (in.held_out ? result_.heldout_gap_parts : result_.gap_parts)
          .push_back(explained_parts(
              in, kUsualGap, side_by_side(side_by_side(in.values, in.parameters), in.replicates)));
    correct(in, weight, found, comparison.fields);
    result_.innovations.push_back(std::move(in));
  }

  void account(const Innovation& in, const InnovationCovariance& weight) {
    const Columns weighted = weight.solve(in.parameters);
    result_.information += in.parameters.transpose() * weighted;
    result_.score += weighted.transpose() * in.values;
    result_.deviance += in.weighted_squares + weight.log_determinant();
    const Eigen::Index patterns = in.directions.cols() - in.state_directions;
    const Columns sizes = sizes_of_model_errors(in, patterns);
    if (in.replicates.cols() > 0)
      result_.null_scores +=
          weighted.transpose() * in.replicates +
          Columns(weighted.transpose() * in.directions.rightCols(patterns)) * sizes;
    if (in.random.empty()) return;
    const Columns values = side_by_side(
        in.values, in.replicates + openblas::product(in.directions.rightCols(patterns), sizes));
    for (const RandomValues& part : in.random) {
      account(variance_score(weight, part.values, values), part.parameter);
      if (part.variance > 0) continue;
      const VarianceScore alone =
          variance_score(InnovationCovariance(in, 0), part.values, in.values);
      result_.variance_score[part.parameter] += alone.scores[0];
      result_.variance_information[part.parameter] += alone.information;
    }
  }

  void account(const VarianceScore& variance, Eigen::Index parameter) {
    result_.information(parameter, parameter) += variance.information;
    result_.score[parameter] += variance.scores[0];
    result_.null_scores.row(parameter) += variance.scores.tail(variance.scores.size() - 1);
  }

  // Errors of the model in the replicates, as large as they seem to be: patterns × replicates.
  Columns sizes_of_model_errors(const Innovation& in, Eigen::Index patterns) const {
    return in.model_error * normal_columns(statistics::fixed_seed::replicate_model_errors,
                                           1000 * data_.vesicle + in.snapshot, patterns,
                                           in.replicates.cols());
  }

  // `found`: the innovation's amplitudes; `directions`: what those of the innovation are in the
  // state.
  void correct(const Innovation& in, const InnovationCovariance& weight, const Vec& found,
               const Columns& directions) {
    const Vec increment = directions * found;
    belief_.c += increment;
    if (resolved_) resolved_->correct(increment);
    belief_.parameters -= openblas::product(directions, weight.amplitudes(in.parameters));
    belief_.replicates -= openblas::product(directions, weight.amplitudes(in.replicates));
    belief_.errors = weight.posterior_root(directions);
    compress(data_.mass, belief_.errors, settings_.rank);
  }

  const FilterProblem& data_;
  const double diffusion_ratio_;
  const FilterSettings& settings_;
  ErrorMaps& maps_;
  const std::vector<RandomPart> random_;
  problem::CahnHilliard problem_;
  std::optional<ResolvedForecast> resolved_;  // where the maps are to be filled
  TangentFlow flow_;
  CoefficientForcing forcing_;
  Belief belief_;
  FilterResult result_;
};

void add(FilterResult& all, FilterResult&& one) {
  all.information += one.information;
  all.score += one.score;
  all.variance_score += one.variance_score;
  all.variance_information += one.variance_information;
  all.null_scores += one.null_scores;
  all.deviance += one.deviance;
  std::move(one.innovations.begin(), one.innovations.end(), std::back_inserter(all.innovations));
  std::move(one.gap_parts.begin(), one.gap_parts.end(), std::back_inserter(all.gap_parts));
  std::move(one.heldout_gap_parts.begin(), one.heldout_gap_parts.end(),
            std::back_inserter(all.heldout_gap_parts));
}

// Knowledge of D from elsewhere is one measurement more, and one of each replicate.
void add_known_diffusion_ratio(double ln_diffusion_ratio, double doubt, FilterResult& all) {
  all.information(kDiffusionRatio, kDiffusionRatio) += 1 / (doubt * doubt);
  all.score[kDiffusionRatio] -= ln_diffusion_ratio / (doubt * doubt);
  all.deviance += ln_diffusion_ratio * ln_diffusion_ratio / (doubt * doubt);
  for (Eigen::Index r = 0; r < all.null_scores.cols(); ++r)
    all.null_scores(kDiffusionRatio, r) +=
        normal_random(statistics::fixed_seed::replicate_diffusion, static_cast<std::uint64_t>(r),
                      0) /
        doubt;
}

}  // namespace

FilterResult filter_fields(const FilterProblems& data, const FilterModel& model,
                           const FilterSettings& settings, std::vector<ErrorMaps>& maps) {
  maps.resize(data.size());
  FilterResult all = Filter(data[0], model, settings, maps[0]).run();
  for (std::size_t v = 1; v < data.size(); ++v)
    add(all, Filter(data[v], model, settings, maps[v]).run());
  all.information(kMeshError, kMeshError) += 1 / (kMeshDoubt * kMeshDoubt);
  add_known_diffusion_ratio(std::log(model.diffusion_ratio), settings.diffusion_ratio_doubt, all);
  return all;
}

}  // namespace traceraft::assimilation
