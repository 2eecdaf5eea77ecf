#include "verification/studies/coarsening_laws.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/stopwatch.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::studies {

statistics::Window window_where(const std::vector<double>& times,
                                const std::function<bool(std::size_t)>& holds) {
  std::size_t end = times.size();
  while (end > 0 && !holds(end - 1)) --end;
  if (end == 0) return {times.back(), times.back()};
  std::size_t begin = end - 1;
  while (begin > 0 && holds(begin - 1)) --begin;
  return {times[begin], times[end - 1]};
}

Ensemble::Ensemble(const bench::Bench& bench, bench::EnsembleRequest request_)
    : request(std::move(request_)), members(bench::run_ensemble(bench, request)) {}

Ensemble::Ensemble(bench::EnsembleRequest request_, std::vector<bench::Member> members_)
    : request(std::move(request_)), members(std::move(members_)) {}

std::vector<double> Ensemble::mean(std::vector<double> bench::Member::*values) const {
  return bench::geometric_mean(members, values, statistics::each_once(members.size()));
}

bench::Table exponents_table() {
  return {"exponents",
          {"ensemble", "quantity", "law of", "from", "to", "exponent", "low", "high", "theory"},
          {}};
}

bench::Exponent measure_law(const Ensemble& ensemble, const Law& law,
                            const statistics::Window& window, bench::Origin origin,
                            bench::Table& exponents) {
  if (!(window.end >= 3 * window.begin))
    throw std::runtime_error(formatted("the window of the %s, t = %.3g to %.3g, is too short",
                                       law.quantity.c_str(), window.begin, window.end));
  const bench::Exponent found = bench::fit_exponent(
      ensemble.members, law.values, ensemble.request.times, window.begin, window.end, origin);
  exponents.rows.push_back(
      {law.ensemble, law.quantity,
       origin == bench::Origin::zero ? "t" : formatted("t + %.3g", found.offset), window.begin,
       window.end, found.b, found.interval.low, found.interval.high, law.theory});
  return found;
}

Claim exponent_claim(const Law& law, const std::string& of, const bench::Exponent& found,
                     double margin) {
  return claim_near(law.ensemble + ": exponent of the " + law.quantity + " in " + of, found.b,
                    law.theory, margin, 0.5 * (found.interval.high - found.interval.low));
}

Claim interval_claim(const Law& law, const std::string& of, const bench::Exponent& found) {
  return claim_between(formatted("%.3g", law.theory) + " lies in the 95 % interval of the " +
                           law.quantity + " in " + of + " (1: yes)",
                       found.interval.contains(law.theory), 1, 1);
}

statistics::Points as_points(const std::vector<double>& times, const std::vector<double>& values) {
  statistics::Points points;
  for (std::size_t i = 0; i < times.size(); ++i) points.emplace_back(times[i], values[i]);
  return points;
}

bench::ChartSeries law_line(const std::string& name, const statistics::Points& points,
                            const statistics::Window& window, double b) {
  const double middle = std::sqrt(window.begin * window.end);
  const auto near =
      std::min_element(points.begin(), points.end(), [&](const auto& p, const auto& q) {
        return std::fabs(std::log(p.first / middle)) < std::fabs(std::log(q.first / middle));
      });
  const auto at = [&](double t) { return near->second * std::pow(t / near->first, b); };
  return {
      name, {{window.begin, at(window.begin)}, {window.end, at(window.end)}}, bench::Mark::line};
}

bench::Chart coarsening_chart(const std::string& title, const std::string& y_label,
                              std::vector<bench::ChartSeries> series) {
  return {title, "t (R^2/D)", y_label, true, true, std::move(series)};
}

std::vector<double> times_between(double begin, double end) {
  constexpr int kPerDecade = 24;
  std::vector<double> times;
  for (double t = begin; t <= end; t *= std::pow(10.0, 1.0 / kPerDecade)) times.push_back(t);
  return times;
}

bench::EnsembleRequest ensemble_request(const std::string& mobility, double fraction,
                                        const Sizes& sizes, double t_end) {
  bench::EnsembleRequest request;
  request.mobility = mobility;
  request.raft_fraction = fraction;
  request.cells = sizes.cells;
  request.epsilon = sizes.epsilon;
  request.members = sizes.members;
  request.tolerance = 1e-2;  // 1e-3 gives nearly the same rafts (docs/decisions/0013)
  request.t_end = t_end;
  request.part = sizes.part;
  request.times = times_between(0.1, t_end);
  return request;
}

Ensemble measured_ensemble(const bench::Bench& bench, const std::string& name,
                           const bench::EnsembleRequest& request, Findings& findings) {
  const Stopwatch watch;
  Ensemble ensemble(bench, request);
  const double seconds = watch.seconds();
  double steps = 0;
  for (const bench::Member& member : ensemble.members)
    steps += member.steps / static_cast<double>(ensemble.members.size());
  findings.cost.rows.push_back({name, static_cast<double>(request.cells), request.epsilon,
                                10.0 / 3 / request.cells / request.epsilon,
                                static_cast<double>(request.members), request.t_end, steps,
                                seconds});
  return ensemble;
}

StudyReport finished_report(Findings findings, const std::string& windows) {
  findings.report.notes = {
      "The runs differ in their seed. Intervals come from a bootstrap over runs: they contain the "
      "scatter of the runs, but not corrections to the law. A length is the area divided by the "
      "perimeter. " +
      windows};
  findings.report.tables = {findings.exponents, findings.cost};
  return findings.report;
}

std::string at_time(double t) {
  return formatted("t = %.3g", t);
}

}  // namespace traceraft::studies
