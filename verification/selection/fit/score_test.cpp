#include "verification/selection/fit/score_test.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/SpecialFunctions>

#include "verification/selection/fit/free_parameters.hpp"

namespace traceraft::selection {

double share_of_noise(const Vec& replicates, double value) {
  const auto beyond = (replicates.array() >= value).count();
  return static_cast<double>(beyond + 1) / static_cast<double>(replicates.size() + 1);
}

double gamma_tail(const Vec& replicates, double value) {
  const double mean = replicates.mean();
  const double variance =
      (replicates.array() - mean).square().sum() / static_cast<double>(replicates.size() - 1);
  if (!(variance > 0)) return value <= mean ? 1 : 0;
  const double shape = mean * mean / variance, scale = variance / mean;
  return Eigen::numext::igammac(shape, std::max(value, 0.0) / scale);
}

namespace {

using Indices = std::vector<Eigen::Index>;

// The quadratic form 2 sᵀa − aᵀ I a of some coefficients with all nuisances at their best.
struct Profile {
  Eigen::MatrixXd information;
  Eigen::MatrixXd projection;  // scores of the coefficients = s_J − projection s_N

  Profile(const Eigen::MatrixXd& F, const Indices& nuisances, const Indices& own) {
    const Eigen::MatrixXd NN = F(nuisances, nuisances), NJ = F(nuisances, own);
    const Eigen::MatrixXd solved = NN.ldlt().solve(NJ);
    information = F(own, own) - NJ.transpose() * solved;
    projection = solved.transpose();
  }
};

struct Gain {
  double score = 0;
  Vec coefficients;
};

// The maximum of 2 uᵀa − aᵀ I a; where signs are fixed, over a ≥ 0 (by trying all faces: there are
// two coefficients at most).
Gain most_gain(const Eigen::MatrixXd& information, const Vec& u, const Indices& seen,
               bool two_sided) {
  const auto d = static_cast<Eigen::Index>(seen.size());
  Gain best{0, Vec::Zero(u.size())};
  for (int face = 1; face < 1 << d; ++face) {
    if (two_sided && face != (1 << d) - 1) continue;
    Indices free;
    for (Eigen::Index k = 0; k < d; ++k)
      if (face >> k & 1) free.push_back(seen[k]);
    const Vec part = information(free, free).ldlt().solve(Vec(u(free)));
    const double score = part.dot(Vec(u(free)));
    if (!(score > best.score) || (!two_sided && part.minCoeff() < 0)) continue;
    best = {score, Vec::Zero(u.size())};
    for (std::size_t k = 0; k < free.size(); ++k) best.coefficients[free[k]] = part[k];
  }
  return best;
}

struct Own {
  Indices indices;
  Profile profile;
  Indices seen;  // of its coefficients: those that change what was measured in a way of their own
};

// Less than this share of a response is none: roundoff and the tolerance of the integrator.
constexpr double kInvisible = 1e-6;

// Coefficients whose responses are not those of the nuisances, nor of the coefficients before them.
Indices seen_ones(const Eigen::MatrixXd& F, const Indices& nuisances, const Indices& own) {
  Indices seen, known = nuisances;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const Profile alone(F, known, {own[k]});
    const double response = F(own[k], own[k]);
    if (!(alone.information(0, 0) > kInvisible * std::max(1.0, response))) continue;
    seen.push_back(static_cast<Eigen::Index>(k));
    known.push_back(own[k]);
  }
  return seen;
}

// 0 for coefficients that are not seen.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information, const Indices& seen) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(information.rows(), information.cols());
  const auto n = static_cast<Eigen::Index>(seen.size());
  const Eigen::MatrixXd own = information(seen, seen);
  const Eigen::MatrixXd inverse = own.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  if (n > 0) result(seen, seen) = inverse;
  return result;
}

// Σ over snapshots of the squares of what the nuisances leave of gaps: measured, and of noise
// alone.
struct GapSquares {
  double measured = 0;
  Vec null;
};

GapSquares gap_squares(const assimilation::FilterResult& result,
                       const std::vector<assimilation::Columns>& gap_parts,
                       const Indices& nuisances) {
  const auto factors = Eigen::MatrixXd(result.information(nuisances, nuisances)).ldlt();
  const Vec best = factors.solve(Vec(result.score(nuisances)));
  const assimilation::Columns null_best =
      factors.solve(assimilation::Columns(result.null_scores(nuisances, Eigen::all)));
  const Eigen::Index parameters = result.score.size(), replicates = null_best.cols();
  GapSquares squares{0, Vec::Zero(replicates)};
  for (const assimilation::Columns& parts : gap_parts) {
    const assimilation::Columns known = parts.middleCols(1, parameters)(Eigen::all, nuisances);
    squares.measured += (parts.col(0) - known * best).squaredNorm();
    squares.null +=
        (parts.rightCols(replicates) - known * null_best).colwise().squaredNorm().transpose();
  }
  return squares;
}

// p of a gap of any shape: in the snapshots that count, in those that are held out, and in both,
// whose logarithms add up (Fisher 1932). That the two are not quite independent, as they share the
// nuisances' estimates, is in the replicates.
void set_gap_p(const assimilation::FilterResult& result, const Indices& nuisances,
               Screening& screening) {
  const GapSquares train = gap_squares(result, result.gap_parts, nuisances);
  screening.gap_p = screening.train_gap_p = gamma_tail(train.null, train.measured);
  if (result.heldout_gap_parts.empty()) return;
  const GapSquares heldout = gap_squares(result, result.heldout_gap_parts, nuisances);
  screening.heldout_gap_p = gamma_tail(heldout.null, heldout.measured);
  const auto both = [](double p, double q) { return -std::log(p) - std::log(q); };
  Vec null(train.null.size());
  for (Eigen::Index r = 0; r < null.size(); ++r)
    null[r] =
        both(gamma_tail(train.null, train.null[r]), gamma_tail(heldout.null, heldout.null[r]));
  screening.gap_p = gamma_tail(null, both(screening.train_gap_p, screening.heldout_gap_p));
}

// The scores of all candidates, for what was measured and for noise.
class Scores {
 public:
  Scores(const assimilation::FilterResult& result,
         const std::vector<assimilation::Candidate>& screened,
         const assimilation::Hypothesis& known, const Indices& nuisances)
      : result_(result), screened_(screened), nuisances_(nuisances) {
    const Eigen::MatrixXd& F = result.information;
    Eigen::Index next = assimilation::kFirstParameter + known.coefficients();
    for (const assimilation::Candidate& candidate : screened) {
      Indices indices;
      for (int d = 0; d < candidate.directions; ++d) indices.push_back(next++);
      own_.push_back({indices, Profile(F, nuisances, indices), seen_ones(F, nuisances, indices)});
    }
    const Eigen::Index replicates = result.null_scores.cols();
    Eigen::MatrixXd null(replicates, static_cast<Eigen::Index>(screened.size()));
    for (Eigen::Index r = 0; r < replicates; ++r)
      for (std::size_t k = 0; k < screened.size(); ++k)
        null(r, static_cast<Eigen::Index>(k)) = gain(k, result.null_scores.col(r)).score;
    if (screened.empty()) return;
    // An effect that is seen no better than noise would be must not look certain.
    null_mean_ = null.colwise().mean().transpose().cwiseMax(0.5);
    highest_ = (null * null_mean_.cwiseInverse().asDiagonal()).rowwise().maxCoeff();
  }

  CandidateScore of(std::size_t k) const {
    Gain found = gain(k, result_.score);
    if (screened_[k].random) found.coefficients[0] = variance(own_[k].indices.front());
    const double mean = null_mean_[static_cast<Eigen::Index>(k)];
    const Eigen::MatrixXd covariance = covariance_of(own_[k].profile.information, own_[k].seen);
    double resolution = std::numeric_limits<double>::infinity();
    for (const Eigen::Index d : own_[k].seen)
      resolution = std::min(
          resolution, response(k, std::sqrt(covariance(d, d)) * Vec::Unit(covariance.rows(), d)));
    return {screened_[k].name,
            {found.coefficients.data(), found.coefficients.data() + found.coefficients.size()},
            found.score,
            mean,
            share_of_noise(highest_, found.score / mean),
            response(k, found.coefficients),
            covariance,
            resolution};
  }

 private:
  Gain gain(std::size_t k, const Vec& score) const {
    const Own& own = own_[k];
    const Vec u = score(own.indices) - own.profile.projection * score(nuisances_);
    return most_gain(own.profile.information, u, own.seen, screened_[k].two_sided);
  }
  double variance(Eigen::Index parameter) const {
    const double information = result_.variance_information[parameter];
    return information > 0 ? std::max(0.0, result_.variance_score[parameter] / information) : 0;
  }
  double response(std::size_t k, const Vec& coefficients) const {
    const Indices& indices = own_[k].indices;
    return assimilation::root_mean_square(
        result_.innovations, false, [&](const assimilation::Innovation& in) {
          for (const assimilation::RandomValues& part : in.random)
            if (part.parameter == indices.front())
              return coefficients[0] * part.values.squaredNorm();
          return (in.parameters(Eigen::all, indices) * coefficients).squaredNorm();
        });
  }

  const assimilation::FilterResult& result_;
  const std::vector<assimilation::Candidate>& screened_;
  const Indices& nuisances_;
  std::vector<Own> own_;
  Vec null_mean_;  // of each candidate
  Vec highest_;    // of each replicate: the largest score over its candidate's mean
};

// `first`: the place of the first screened candidate's first coefficient among the parameters.
std::vector<ConfoundedWithDiffusionRatio> confounded_with_diffusion_ratio(
    const Eigen::MatrixXd& information, const std::vector<assimilation::Candidate>& screened,
    Indices others, Eigen::Index first) {
  const Eigen::MatrixXd F = information.selfadjointView<Eigen::Lower>();
  others.erase(
      std::find(others.begin(), others.end(), Eigen::Index{assimilation::kDiffusionRatio}));
  std::vector<ConfoundedWithDiffusionRatio> result;
  for (const assimilation::Candidate& candidate : screened) {
    const Eigen::MatrixXd I =
        Profile(F, others, {assimilation::kDiffusionRatio, first}).information;
    const double correlation = I(0, 1) / std::sqrt(I(0, 0) * I(1, 1));
    if (candidate.like_diffusion_ratio && !candidate.two_sided && correlation > kConfounded)
      result.push_back({candidate.name, I(0, 1) / I(0, 0), correlation});
    first += candidate.directions;
  }
  return result;
}

}  // namespace

Screening screen(const assimilation::FilterResult& result,
                 const std::vector<assimilation::Candidate>& screened,
                 const assimilation::Hypothesis& known) {
  const Indices nuisances = free_parameters(result, known);
  const Scores scores(result, screened, known, nuisances);
  Screening screening;
  for (std::size_t k = 0; k < screened.size(); ++k) {
    screening.scores.push_back(scores.of(k));
    screening.p = std::min(screening.p, screening.scores.back().p);
  }
  std::sort(screening.scores.begin(), screening.scores.end(),
            [](const auto& a, const auto& b) { return a.score > b.score; });
  if (result.null_scores.cols() > 1) set_gap_p(result, nuisances, screening);
  screening.mesh_error = assimilation::root_mean_square(
      result.innovations, false, [](const assimilation::Innovation& in) {
        return in.parameters.col(assimilation::kMeshError).squaredNorm();
      });
  const Eigen::MatrixXd inverse = result.information(nuisances, nuisances).inverse();
  screening.confounded =
      confounded_with_diffusion_ratio(result.information, screened, nuisances,
                                      assimilation::kFirstParameter + known.coefficients());
  screening.diffusion_ratio_change =
      (inverse * result.score(nuisances))[assimilation::kDiffusionRatio];
  screening.diffusion_ratio_deviation =
      std::sqrt(inverse(assimilation::kDiffusionRatio, assimilation::kDiffusionRatio));
  return screening;
}

}  // namespace traceraft::selection
