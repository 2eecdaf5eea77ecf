// From a consistent state to the end of a run: steps, results at requested times, listeners.
#pragma once

#include <functional>
#include <vector>

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/simulation/discretisation.hpp"
#include "kernel/simulation/mesh_adaptation.hpp"
#include "kernel/simulation/run_monitor.hpp"

namespace traceraft::simulation {

// Everything that changes during a run; what a checkpoint holds.
struct RunState {
  Discretisation& on;
  MeshAdaptation* adaptation = nullptr;  // of a mesh that follows the boundaries
  RunMonitor monitor{};
  std::size_t next_output = 0;             // first requested time not yet delivered
  observables::Observables observables{};  // at the last accepted step

  const time::Integrator& integrator() const { return *on.integrator; }
  void save(CheckpointOut out) const;
  void load(CheckpointIn in);  // throws IoError
};

// Listeners see the run and do not change it. They may throw (a full disk): the run ends there.
// Ranks may have different ones, as long as the collective ones are everywhere.
class RunListener {
 public:
  virtual ~RunListener() = default;
  // After every accepted step, and once before the first one.
  virtual void on_step(const RunState&) {}
  // At a requested time, interpolated within the last step: results never bend the steps.
  virtual void on_output(const observables::Observables&, const observables::RaftReport&,
                         VecView /*y*/) {}
};

enum class RunEnd { finished, stopped, failed };

struct RunResult {
  RunEnd end;
  std::string why;  // of a failure
};

// Measures the initial state and tells the listeners, unless the state was loaded.
void begin_run(RunState& state, const std::vector<double>& output_times,
               const std::vector<RunListener*>& listeners);

// Advances to t_end, on meshes that follow where the state asks for it. `stop` is asked after every
// step and says the same on all ranks. `output_times` ascend.
RunResult continue_run(RunState& state, double t_end, const std::vector<double>& output_times,
                       const std::vector<RunListener*>& listeners,
                       const std::function<bool()>& stop);

}  // namespace traceraft::simulation
