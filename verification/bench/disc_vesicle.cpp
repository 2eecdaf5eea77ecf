#include "verification/bench/disc_vesicle.hpp"

#include "kernel/discs/disc_system.hpp"
#include "kernel/observables/disc_observables.hpp"

namespace traceraft::bench {

std::vector<observables::Observables> follow_discs(const Bench& bench,
                                                   const discs::DiscModel& model,
                                                   const discs::RandomDiscs& start,
                                                   double tolerance,
                                                   const std::vector<double>& times) {
  const discs::DiscModel own = bench.disc_model(model);
  discs::DiscSystem system(own, tolerance, discs::start_state(own, discs::random_discs(start)));
  std::vector<observables::Observables> history;
  while (history.size() < times.size()) {
    if (system.state().t < times[history.size()]) require(system.advance(times[history.size()]));
    for (; history.size() < times.size() && times[history.size()] <= system.state().t;)
      history.push_back(observables::observe(system, system.state()));
  }
  return history;
}

}  // namespace traceraft::bench
