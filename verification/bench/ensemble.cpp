#include "verification/bench/ensemble.hpp"

#include <cmath>

#include "kernel/observables/rafts.hpp"
#include "verification/bench/spherical_spectrum.hpp"
#include "verification/statistics/power_law.hpp"

namespace traceraft::bench {
namespace {

constexpr double kLevel = 0.5;

Member run_member(const Bench& bench, const EnsembleRequest& request, std::uint64_t seed) {
  const SpacePtr space = bench.space(geometry::make_surface("sphere"), request.cells, 1);
  problem::CahnHilliardModel model = bench_model(request.mobility, request.epsilon);
  model.effects = request.effects;
  const ProblemPtr problem = bench.problem(space, model);
  problem::InitialRequest initial;
  initial.raft_fraction = request.raft_fraction;
  initial.seed = seed;
  const time::IntegratorPtr integrator = bench.default_integrator(*problem, request.tolerance);
  const observables::RaftFinder finder(space);
  Member member;
  std::size_t next_snapshot = 0;
  Vec y(problem->size());
  const auto at = [&](double t) -> Vec {
    require(integrator->interpolate(t, y));
    return problem->c_of(y);
  };
  advance_to(*integrator, initial_state(*problem, "noise", initial), request.t_end, [&] {
    ++member.steps;
    while (member.perimeter.size() < request.times.size() &&
           request.times[member.perimeter.size()] <= integrator->time()) {
      const observables::RaftReport rafts =
          finder.find(at(request.times[member.perimeter.size()]), kLevel);
      const double count = static_cast<double>(rafts.rafts.size());
      member.perimeter.push_back(rafts.perimeter);
      member.rafts.push_back(count);
      member.raft_radius.push_back(std::sqrt(rafts.area / count / kPi));
    }
    for (; next_snapshot < request.snapshot_times.size() &&
           request.snapshot_times[next_snapshot] <= integrator->time();
         ++next_snapshot) {
      const Vec c = at(request.snapshot_times[next_snapshot]);
      if (request.highest_degree > 0)
        member.spectra.push_back(spherical_spectrum(*space, c, request.highest_degree));
      member.areas.emplace_back();
      for (const observables::Raft& raft : finder.find(c, kLevel).rafts)
        member.areas.back().push_back(raft.area);
    }
  });
  return member;
}

}  // namespace

std::vector<Member> run_ensemble(const Bench& bench, const EnsembleRequest& request) {
  std::vector<Member> members(static_cast<std::size_t>(request.members));
  bench.in_parallel(
      request.members,
      [&](int k) { members[k] = run_member(bench, request, static_cast<std::uint64_t>(k) + 1); },
      request.part);
  return members;
}

std::vector<double> geometric_mean(const std::vector<Member>& members,
                                   std::vector<double> Member::*quantity,
                                   const std::vector<int>& sample) {
  std::vector<double> mean((members.front().*quantity).size(), 0);
  for (std::size_t i = 0; i < mean.size(); ++i) {
    for (const int k : sample)
      mean[i] += std::log((members[k].*quantity)[i]) / static_cast<double>(sample.size());
    mean[i] = std::exp(mean[i]);
  }
  return mean;
}

Exponent fit_exponent(const std::vector<Member>& members, std::vector<double> Member::*quantity,
                      const std::vector<double>& times, double begin, double end, Origin origin) {
  struct Law {
    double b, offset;
  };
  const auto fit = [&](const std::vector<int>& sample) -> Law {
    const std::vector<double> mean = geometric_mean(members, quantity, sample);
    statistics::Points points;
    for (std::size_t i = 0; i < times.size(); ++i)
      if (times[i] >= begin && times[i] <= end) points.emplace_back(times[i], mean[i]);
    if (origin == Origin::zero) return {statistics::fit_power_law(points).slope, 0};
    const statistics::PowerLaw law = statistics::fit_power_law_from(points, 0);
    return {law.b, -law.t0};
  };
  const int count = static_cast<int>(members.size());
  const Law all = fit(statistics::each_once(members.size()));
  const statistics::Interval percentiles = statistics::bootstrap(
      count, 1000, 0.95, 1, [&](const std::vector<int>& sample) { return fit(sample).b; });
  return {all.b, all.offset, statistics::widened_for_few(percentiles, all.b, count)};
}

}  // namespace traceraft::bench
