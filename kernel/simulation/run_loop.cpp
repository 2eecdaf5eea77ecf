#include "kernel/simulation/run_loop.hpp"

#include <stdexcept>

namespace traceraft::simulation {
namespace {

// For the monitor a jump of the energy between two meshes is no rise.
Status follow_boundaries(RunState& state) {
  if (!state.adaptation) return {};
  const long before = state.adaptation->statistics().remeshes;
  if (Status status = state.adaptation->before_step(state.on); !status.ok()) return status;
  if (state.adaptation->statistics().remeshes > before)
    state.monitor.go_on_from(state.on.problem->energy(state.integrator().state()));
  return {};
}

}  // namespace

void RunState::save(CheckpointOut out) const {
  write_binary(out, monitor);
  write_binary(out, static_cast<std::uint64_t>(next_output));
  write_binary(out, observables);
  if (adaptation) adaptation->save(out);
  on.integrator->save(out);
}

void RunState::load(CheckpointIn in) {
  std::uint64_t next = 0;
  read_binary(in, monitor);
  read_binary(in, next);
  read_binary(in, observables);
  next_output = static_cast<std::size_t>(next);
  if (adaptation) adaptation->load(in);
  on.integrator->load(in);
}

void begin_run(RunState& state, const std::vector<double>& output_times,
               const std::vector<RunListener*>& listeners) {
  const time::Integrator& integrator = *state.on.integrator;
  const observables::Observer& observer = *state.on.observer;
  const observables::RaftReport rafts = observer.rafts(integrator.state());
  state.observables = observer.measure(integrator.time(), integrator.state(), rafts);
  state.monitor.start(state.observables, observer.mass_scale(), observer.energy_scale());
  for (; state.next_output < output_times.size() &&
         output_times[state.next_output] <= integrator.time();
       ++state.next_output)
    for (RunListener* listener : listeners)
      listener->on_output(state.observables, rafts, integrator.state());
  for (RunListener* listener : listeners) listener->on_step(state);
}

RunResult continue_run(RunState& state, double t_end, const std::vector<double>& output_times,
                       const std::vector<RunListener*>& listeners,
                       const std::function<bool()>& stop) {
  while (state.on.integrator->time() < t_end) {
    if (stop()) return {RunEnd::stopped, ""};
    if (Status status = follow_boundaries(state); !status.ok()) return {RunEnd::failed, status.why};
    time::Integrator& integrator = *state.on.integrator;
    const observables::Observer& observer = *state.on.observer;
    if (Status status = integrator.advance(); !status.ok()) return {RunEnd::failed, status.why};
    state.observables = observer.measure(integrator.time(), integrator.state());
    state.monitor.accept(state.observables);
    for (; state.next_output < output_times.size() &&
           output_times[state.next_output] <= integrator.time();
         ++state.next_output) {
      Vec y(integrator.state().size());
      const double t = output_times[state.next_output];
      if (Status status = integrator.interpolate(t, y); !status.ok())
        throw std::logic_error(integrator.name() + ": " + status.why);
      const observables::RaftReport rafts = observer.rafts(y);
      const observables::Observables row = observer.measure(t, y, rafts);
      for (RunListener* listener : listeners) listener->on_output(row, rafts, y);
    }
    for (RunListener* listener : listeners) listener->on_step(state);
  }
  return {RunEnd::finished, ""};
}

}  // namespace traceraft::simulation
