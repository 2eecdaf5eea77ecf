#include "verification/explain/field_filter.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "backends/list.hpp"
#include "kernel/core/random.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/measure/sparse_view.hpp"

namespace traceraft {
namespace {

// Polynomials in x, y, z restricted to Γ, orthogonal, with a mean square of 1.
Columns surface_polynomials(const SurfaceSpace& space, int degree) {
  std::vector<Vec> monomials;
  for (int total = 0; total <= degree; ++total)
    for (int i = 0; i <= total; ++i)
      for (int j = 0; i + j <= total; ++j) {
        Vec nodal(space.nodes());
        for (int k = 0; k < space.nodes(); ++k) {
          const Point x = space.mesh.position(k);
          nodal[k] = std::pow(x[0], i) * std::pow(x[1], j) * std::pow(x[2], total - i - j);
        }
        monomials.push_back(nodal);
      }
  Columns X(space.nodes(), static_cast<Eigen::Index>(monomials.size()));
  for (std::size_t k = 0; k < monomials.size(); ++k) X.col(k) = monomials[k].normalized();
  const EigenMatrix mass = as_eigen(space, space.mass);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(X.transpose() * (mass * X));
  // On a sphere the squares add up to 1, so polynomials repeat themselves.
  const double least = 1e-6 * gram.eigenvalues().maxCoeff();
  const Eigen::Index kept = (gram.eigenvalues().array() > least).count();
  return X * gram.eigenvectors().rightCols(kept) *
         (space.area * gram.eigenvalues().tail(kept).cwiseInverse()).cwiseSqrt().asDiagonal();
}

// Patterns of c that an error of the model may have: smooth ones, and smooth shifts of the phase
// boundaries. Their sum of squares has a mean of about 1.
Columns gap_patterns(const SurfaceSpace& space, const DoubleWell& well, const Columns& smooth,
                     const Vec& c) {
  const double half = 0.5 * (well.b - well.a);
  const Vec boundary =
      ((c.array() - well.a) * (well.b - c.array()) / (half * half)).cwiseMax(0).cwiseMin(1);
  const Eigen::Index few = std::min<Eigen::Index>(16, smooth.cols());
  Columns patterns(c.size(), smooth.cols() + few);
  patterns.leftCols(smooth.cols()) = boundary.asDiagonal() * smooth;
  patterns.rightCols(few) = 0.5 * smooth.leftCols(few);
  const EigenMatrix mass = as_eigen(space, space.mass);
  const double squares = patterns.cwiseProduct(mass * patterns).sum() / space.area;
  return patterns / std::sqrt(squares);
}

// −(ω × x)·∇_Γ c for turns about the three axes.
Columns turns(const CahnHilliard& problem, const Vec& c) {
  const EffectEntry& rotation = effects().find("rotation");
  const SurfaceSpace& space = problem.space();
  Columns result(c.size(), 3);
  for (int axis = 0; axis < 3; ++axis) {
    CahnHilliardModel model = problem.model();
    std::vector<double> values{1, 0, 0, 0};
    values[1 + axis] = 1;
    model.effects.clear();
    rotation.add(Parameters(rotation.parameters, values), model);
    Vec first = Vec::Zero(c.size()), second = Vec::Zero(c.size()), rate(c.size());
    model.effects.front()->add_residual(space, 0, c, Vec::Zero(c.size()), first, second);
    require(space.solve_mass(-first, rate));
    result.col(axis) = rate;
  }
  return result;
}

// S = 1 + G Gᵀ by Woodbury's formula.
class Weight {
 public:
  explicit Weight(Columns G) : G_(std::move(G)) {
    factors_.compute(Eigen::MatrixXd::Identity(G_.cols(), G_.cols()) + G_.transpose() * G_);
  }
  Columns solve(const Columns& X) const { return X - G_ * factors_.solve(G_.transpose() * X); }
  double log_determinant() const { return 2 * factors_.matrixLLT().diagonal().array().log().sum(); }
  // Rᵀ R = 1 + Gᵀ G.
  const Eigen::LLT<Eigen::MatrixXd>& factors() const { return factors_; }
  const Columns& columns() const { return G_; }

 private:
  Columns G_;
  Eigen::LLT<Eigen::MatrixXd> factors_;
};

Columns side_by_side(const Columns& a, const Columns& b) {
  Columns both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

// The size of the model's error that makes an innovation most probable.
double most_probable_error(const Innovation& innovation) {
  const Columns all = side_by_side(innovation.state, innovation.gaps);
  const Eigen::MatrixXd gram = all.transpose() * all;
  const Vec load = all.transpose() * innovation.values;
  const Eigen::Index state = innovation.state.cols();
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (const double size : {0.0, 0.0025, 0.005, 0.01, 0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.25}) {
    Vec scale = Vec::Ones(all.cols());
    scale.tail(all.cols() - state).setConstant(size);
    const Eigen::LLT<Eigen::MatrixXd> factors(Eigen::MatrixXd::Identity(all.cols(), all.cols()) +
                                              scale.asDiagonal() * gram * scale.asDiagonal());
    const Vec scaled = scale.cwiseProduct(load);
    const double deviance =
        2 * factors.matrixLLT().diagonal().array().log().sum() - scaled.dot(factors.solve(scaled));
    if (deviance < least) {
      least = deviance;
      best = size;
    }
  }
  return best;
}

// Of c, in forecasts that lack something: what a gap is looked for as.
constexpr double kUsualGap = 0.02;

// Standard deviation of the share of the mesh's error that extrapolation leaves.
constexpr double kMeshDoubt = 0.5;
// The share of it that forecasts are corrected by: what is on both sides of the rest is as likely.
constexpr double kExtrapolate = 0.5;

// Far below the noise of a measurement.
constexpr double kForecastTolerance = 3e-4;

// The state of the filter between two snapshots.
struct Belief {
  Vec c;
  Columns errors;      // L: covariance L Lᵀ
  Columns parameters;  // ∂c/∂θ
  Columns replicates;  // errors of the replicates
};

class Filter {
 public:
  Filter(const FilterProblem& data, const FilterModel& model, const FilterSettings& settings,
         ErrorMaps& maps, const std::vector<double>& model_errors)
      : data_(data),
        pace_(model.pace),
        settings_(settings),
        maps_(maps),
        model_errors_(model_errors),
        problem_(data.space, with_effects(model.base, model.hypothesis.terms())),
        fine_problem_(data.fine, problem_.model()),
        flow_(problem_, data.tangent_solver, data.team),
        forcing_(problem_, model.base, model.hypothesis, model.screened),
        mass_(as_eigen(*data.space, data.space->stabilised_mass)),
        smooth_(surface_polynomials(*data.space, settings.gap_degree)) {
    Eigen::Index parameters = kFirstParameter + model.hypothesis.coefficients();
    for (const Candidate& candidate : model.screened) parameters += candidate.directions;
    belief_.c = data.first.field;
    belief_.errors = data.first.errors;
    belief_.parameters = Columns::Zero(data.space->nodes(), parameters);
    belief_.replicates = data.first.draws.leftCols(settings.replicates);
    result_.information = Eigen::MatrixXd::Zero(parameters, parameters);
    result_.information(kMeshError, kMeshError) = 1 / (kMeshDoubt * kMeshDoubt);
    result_.score = Vec::Zero(parameters);
    result_.null_scores = Eigen::MatrixXd::Zero(parameters, settings.replicates);
    result_.null_gaps = Vec::Zero(settings.replicates);
    result_.states.push_back(belief_.c);
  }

  FilterResult run() {
    for (std::size_t k = 0; k + 1 < data_.times.size(); ++k) {
      advance(k);
      compare(k);
    }
    return std::move(result_);
  }

 private:
  void advance(std::size_t k) {
    const double begin = pace_ * data_.times[k], end = pace_ * data_.times[k + 1];
    const auto coarse = [&](const DaeProblem& p) { return data_.make_integrator(p, *data_.space); };
    const auto fine = [&](const DaeProblem& p) { return data_.make_integrator(p, *data_.fine); };
    const Forecast way = forecast(problem_, coarse, belief_.c, begin, end, settings_.tangent_steps);
    if (maps_.mesh_error.size() == k) {
      const Vec fine_start = project(*data_.fine, data_.to_fine * belief_.c);
      const Vec fine_end = forecast(fine_problem_, fine, fine_start, begin, end, 1).end;
      // Errors of order h², so the difference of two meshes tells that of the coarser one.
      const double ratio = data_.fine->h() / data_.space->h();
      const double all = 1 / (1 - ratio * ratio);
      maps_.mesh_error.push_back(
          {all * (project(*data_.space, data_.from_fine * fine_end) - way.end),
           all * (data_.fine_trace[k + 1] * fine_end - data_.snapshots[k + 1].trace * way.end)});
    }
    advance_errors(k, begin, end);
    flow_.advance(way, belief_.parameters, [this](double t, ConstVec y) { return forcing_(t, y); });
    belief_.parameters.col(kPace) += (end - begin) * way.end_rate;
    belief_.parameters.col(kMeshError) += maps_.mesh_error[k].field;
    belief_.c = way.end + kExtrapolate * maps_.mesh_error[k].field;
  }

  void advance_errors(std::size_t k, double begin, double end) {
    if (maps_.basis.size() == k) {
      Columns basis = belief_.errors;
      orthonormalise(basis);
      Columns moved = side_by_side(basis, belief_.replicates);
      const auto coarse = [&](const DaeProblem& p) {
        return data_.make_integrator(p, *data_.space);
      };
      flow_.advance(forecast(problem_, coarse, belief_.c, begin, end, settings_.error_steps),
                    moved);
      maps_.basis.push_back(basis);
      maps_.image.push_back(moved.leftCols(basis.cols()));
      maps_.replicates.push_back(moved.rightCols(settings_.replicates));
    }
    belief_.errors =
        (maps_.image[k] * (maps_.basis[k].transpose() * (mass_ * belief_.errors))).eval();
    belief_.replicates = maps_.replicates[k].leftCols(settings_.replicates);
  }

  void orthonormalise(Columns& X) const {
    compress(mass_, X, settings_.rank);
    const Vec size = (X.cwiseProduct(mass_ * X)).colwise().sum().cwiseSqrt().transpose();
    X = (X * size.cwiseInverse().asDiagonal()).eval();
  }

  void compare(std::size_t k) {
    const NoisyValues& measured = data_.snapshots[k + 1];
    const Vec scale = (data_.noise * measured.deviation).cwiseInverse();
    const auto seen = [&](const Columns& X) {
      return Columns(scale.asDiagonal() * (measured.trace * X));
    };
    const Columns patterns = gap_patterns(*data_.space, problem_.model().well, smooth_, belief_.c);
    const Columns turned = settings_.turn * turns(problem_, belief_.c);

    Innovation in;
    in.time = data_.times[k + 1];
    // What the traces of the forecast on this mesh lack, beyond what its nodes do.
    const Vec lacking =
        kExtrapolate * (maps_.mesh_error[k].values - measured.trace * maps_.mesh_error[k].field);
    in.forecast = measured.trace * belief_.c + lacking;
    in.values = scale.cwiseProduct(measured.values - in.forecast);
    Columns frame(scale.size(), 2);
    frame << settings_.gain * seen(belief_.c), settings_.offset * scale;
    in.state = side_by_side(side_by_side(seen(belief_.errors), seen(turned)), frame);
    in.gaps = seen(patterns);
    in.parameters = seen(belief_.parameters);
    in.parameters.col(kMeshError) += scale.cwiseProduct(lacking) / kExtrapolate;
    in.replicates = seen(belief_.replicates);
    add_noise(k, in.replicates);
    in.model_error = model_errors_.empty() ? most_probable_error(in) : model_errors_[k];

    const Weight weight(side_by_side(in.state, in.model_error * in.gaps));
    if (k + 1 < data_.train) account(in, weight);
    correct(in, weight,
            side_by_side(side_by_side(belief_.errors, turned), Columns::Zero(belief_.c.size(), 2)),
            in.model_error * patterns);
    result_.states.push_back(belief_.c);
    result_.innovations.push_back(std::move(in));
  }

  void add_noise(std::size_t k, Columns& values) const {
    for (Eigen::Index j = 0; j < values.cols(); ++j)
      for (Eigen::Index i = 0; i < values.rows(); ++i) {
        const auto u = [&](std::uint64_t which) {
          return uniform_random(7, 1000 * (k + 1) + static_cast<std::uint64_t>(j),
                                2 * static_cast<std::uint64_t>(i) + which);
        };
        values(i, j) += normal_pair(u(0), u(1))[0];
      }
  }

  // The gap by the chi-square of the patterns with amplitudes of kUsualGap, the model's error not
  // being allowed for.
  void account_gap(const Innovation& in) {
    const Weight without(in.state);
    const Columns P = kUsualGap * in.gaps;
    const Eigen::MatrixXd weighted = without.solve(P);
    const Eigen::LLT<Eigen::MatrixXd> factors(Eigen::MatrixXd::Identity(P.cols(), P.cols()) +
                                              P.transpose() * weighted);
    const auto size = [&](const Columns& values) {
      return Vec(factors.matrixL()
                     .solve(weighted.transpose() * values)
                     .colwise()
                     .squaredNorm()
                     .transpose());
    };
    result_.gap += size(in.values)[0];
    if (in.replicates.cols() > 0) result_.null_gaps += size(in.replicates);
  }

  void account(Innovation& in, const Weight& weight) {
    account_gap(in);
    const Columns weighted = weight.solve(in.parameters);
    result_.information += in.parameters.transpose() * weighted;
    result_.score += weighted.transpose() * in.values;
    result_.null_scores += weighted.transpose() * in.replicates;
    in.weighted_squares = in.values.dot(weight.solve(in.values).col(0));
    result_.deviance += in.weighted_squares + weight.log_determinant();
  }

  // K = L (1 + GᵀG)⁻¹ Gᵀ for all columns of L, those of the frame having no share in the state.
  void correct(const Innovation& in, const Weight& weight, const Columns& known,
               const Columns& unknown) {
    const Columns all = side_by_side(known, unknown);
    const Columns& G = weight.columns();
    const auto gain = [&](const Columns& values) {
      return Columns(all * weight.factors().solve(G.transpose() * values));
    };
    belief_.c += gain(in.values);
    belief_.parameters -= gain(in.parameters);
    belief_.replicates -= gain(in.replicates);
    belief_.errors = weight.factors().matrixU().solve<Eigen::OnTheRight>(all);
    compress(mass_, belief_.errors, settings_.rank);
  }

  const FilterProblem& data_;
  const double pace_;
  const FilterSettings& settings_;
  ErrorMaps& maps_;
  const std::vector<double>& model_errors_;
  CahnHilliard problem_, fine_problem_;
  TangentFlow flow_;
  CoefficientForcing forcing_;
  EigenMatrix mass_;
  Columns smooth_;
  Belief belief_;
  FilterResult result_;
};

}  // namespace

FilterProblem make_filter_problem(const FieldSeries& series, const LevelSet& surface,
                                  double epsilon, int cells, int fine_cells, int threads,
                                  std::size_t held_out, const FilterSettings& settings) {
  FilterProblem data;
  // On meshes of some thousand nodes threads are better used for different columns and models.
  data.team = std::make_shared<ThreadTeam>(threads);
  const auto make_space = [&](int n) {
    return std::make_shared<const SurfaceSpace>(surface, n, std::make_shared<ThreadTeam>(1),
                                                std::make_shared<SerialCommunicator>());
  };
  data.space = make_space(cells);
  data.fine = make_space(fine_cells);
  data.train = series.snapshots.size() - held_out;
  const double reach = data.space->h();
  for (const FieldSnapshot& snapshot : series.snapshots) {
    data.times.push_back(snapshot.time);
    data.snapshots.push_back(
        {point_trace(*data.space, snapshot.points, reach), snapshot.values, snapshot.deviation});
  }
  const auto nodes_of = [](const SurfaceSpace& space) {
    std::vector<Point> nodes;
    for (int k = 0; k < space.nodes(); ++k) nodes.push_back(space.mesh.position(k));
    return nodes;
  };
  // Nodes lie within a cell's diagonal of the surface.
  for (const FieldSnapshot& snapshot : series.snapshots)
    data.fine_trace.push_back(point_trace(*data.fine, snapshot.points, reach));
  data.to_fine = point_trace(*data.space, nodes_of(*data.fine), 3 * reach);
  data.from_fine = point_trace(*data.fine, nodes_of(*data.space), 3 * reach);
  data.first = estimate_field(*data.space, data.snapshots.front(),
                              {2 * epsilon, settings.rank, settings.replicates});
  double squares = 0;
  for (const NoisyValues& values : data.snapshots) {
    const double noise = estimate_field(*data.space, values, data.first.prior, {}).noise;
    squares += noise * noise / static_cast<double>(data.snapshots.size());
  }
  data.noise = std::sqrt(squares);
  data.tangent_solver = choose_linear_solver("direct", *data.space).primary;
  data.make_integrator = [](const DaeProblem& problem, const SurfaceSpace& space) {
    IntegratorSettings integrator;
    integrator.tolerance = kForecastTolerance;
    return integrators().find("ida").make(problem, choose_linear_solver("block", space), space.team,
                                          integrator);
  };
  return data;
}

FilterResult filter_fields(const FilterProblem& data, const FilterModel& model,
                           const FilterSettings& settings, ErrorMaps& maps,
                           const std::vector<double>& model_errors) {
  return Filter(data, model, settings, maps, model_errors).run();
}

}  // namespace traceraft
