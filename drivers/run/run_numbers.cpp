#include "drivers/run/run_numbers.hpp"

#include <algorithm>

#include "backends/zlib/checksum.hpp"

namespace traceraft::run {

RunMoment moment_of(const RunSetup& run, const observables::Observables& observables, double t) {
  return {run.units,
          observables,
          t,
          run.integrator->step(),
          run.integrator->statistics(),
          run.integrator->linear_statistics(),
          run.space->totals.nodes};
}

RunGround ground_of(const RunSetup& run) {
  return {run.space->totals,
          run.space->area,
          run.space->h(),
          run.ranks->size(),
          run.team->size(),
          run.adaptation ? run.adaptation->statistics() : simulation::RemeshStatistics{}};
}

namespace {

double number(std::int64_t count) {
  return static_cast<double>(count);
}

}  // namespace

const std::vector<ReportedNumber<RunMoment>>& run_columns() {
  using M = const RunMoment&;
  using U = text::Unit;
  static const std::vector<ReportedNumber<RunMoment>> columns = {
      {"steps", U::count, "accepted steps so far", [](M m) { return number(m.steps.steps); }},
      {"t", U::time, "time", [](M m) { return m.t; }},
      {"dt", U::time, "the step that ends at t, or that t lies in",
       [](M m) { return m.step * m.units.time(); }},
      {"mass", U::area, "∫ c over the surface",
       [](M m) { return m.observables.mass * m.units.area(); }},
      {"energy", U::area, "∫ f0(c) + ½ ε² |∇c|², in units of the energy density times area",
       [](M m) { return m.observables.energy * m.units.area(); }},
      {"perimeter", U::length,
       "the diffuse perimeter ∫ ε |∇c|² over the same integral per length of a straight "
       "boundary at rest on a mesh of this h/ε",
       [](M m) { return m.observables.perimeter * m.units.length(); }},
      {"perimeter_level", U::length, "length of the curve c = (a + b)/2",
       [](M m) { return m.observables.perimeter_level * m.units.length(); }},
      {"rafts", U::count, "connected components of c > (a + b)/2",
       [](M m) { return number(m.observables.rafts); }},
      {"domains", U::count,
       "connected components of the phase that covers less: rafts, or, where raft_fraction is "
       "above one half, those of c < (a + b)/2",
       [](M m) { return number(m.observables.domains); }},
      {"raft_fraction", U::ratio, "area of all rafts over that of the surface",
       [](M m) { return m.observables.raft_fraction; }},
      {"largest_raft", U::area, "area of the largest raft",
       [](M m) { return m.observables.largest_raft * m.units.area(); }},
      {"c_min", U::ratio, "smallest c on the surface", [](M m) { return m.observables.c_min; }},
      {"c_max", U::ratio, "largest c on the surface", [](M m) { return m.observables.c_max; }},
      {"rejected", U::count, "attempts so far whose error was too large",
       [](M m) { return number(m.steps.rejected); }},
      {"failures", U::count, "attempts so far whose solve failed",
       [](M m) { return number(m.steps.failures); }},
      {"newton_iterations", U::count, "Newton corrections so far",
       [](M m) { return number(m.steps.newton_iterations); }},
      {"linear_iterations", U::count, "iterations of the linear solver so far",
       [](M m) { return number(m.linear.iterations); }},
      {"linear_setups", U::count, "preconditioners or factorisations so far",
       [](M m) { return number(m.linear.setups); }},
      {"order", U::count, "order of the last step", [](M m) { return number(m.steps.order); }},
      {"nodes", U::count, "nodes of the mesh whose basis functions touch the surface",
       [](M m) { return number(m.nodes); }},
  };
  return columns;
}

const std::vector<ReportedNumber<RunTotals>>& run_totals() {
  using T = const RunTotals&;
  using U = text::Unit;
  static const std::vector<ReportedNumber<RunTotals>> totals = {
      {"unknowns", U::count, "c and μ at the nodes",
       [](T r) { return 2 * number(r.ground.mesh.nodes); }},
      {"cut_tetrahedra", U::count, "tetrahedra that the surface cuts",
       [](T r) { return number(r.ground.mesh.elements); }},
      {"euler_characteristic", U::count, "of the surface: 2 for a sphere",
       [](T r) { return number(r.ground.mesh.euler_characteristic); }},
      {"area", U::area, "of the surface", [](T r) { return r.ground.area * r.at.units.area(); }},
      {"h", U::length, "edge of a cell of the mesh",
       [](T r) { return r.ground.h * r.at.units.length(); }},
      {"remeshes", U::count, "changes of a mesh that follows the boundaries",
       [](T r) { return number(r.ground.remeshing.remeshes); }},
      {"mean_nodes", U::count, "nodes of such a mesh, mean over the steps",
       [](T r) { return r.ground.remeshing.mean_nodes(); }},
      {"highest_energy_jump", U::ratio,
       "largest rise of the energy from one mesh to the next, relative to it",
       [](T r) { return r.ground.remeshing.highest_jump; }},
      {"lowest_energy_jump", U::ratio, "largest fall",
       [](T r) { return r.ground.remeshing.lowest_jump; }},
      {"remesh_s", U::seconds, "spent on new meshes, and on telling where they are needed",
       [](T r) { return r.ground.remeshing.seconds; }},
      {"mean_concentration", U::ratio, "mass over area",
       [](T r) { return r.at.observables.mass / r.ground.area; }},
      {"mass_drift", U::ratio, "largest change of the mass, relative to it",
       [](T r) { return r.monitor.mass_drift(); }},
      {"energy_rises", U::count, "steps in which the energy grew",
       [](T r) { return number(r.monitor.energy_rises()); }},
      {"largest_energy_rise", U::ratio, "the largest of these, over the initial energy",
       [](T r) { return r.monitor.largest_rise(); }},
      {"energy_rises_refused", U::count, "attempts that were cut because the energy grew",
       [](T r) { return number(r.at.steps.energy_rises); }},
      {"first_order_steps", U::count, "steps of euler with its first-order solution",
       [](T r) { return number(r.at.steps.first_order); }},
      {"residuals", U::count, "evaluations of F", [](T r) { return number(r.at.steps.residuals); }},
      {"jacobians", U::count, "assemblies of the Jacobian",
       [](T r) { return number(r.at.steps.jacobians); }},
      {"renewals", U::count, "solves that were repeated with new factors",
       [](T r) { return number(r.at.steps.renewals); }},
      {"fallbacks", U::count, "solves that the second solver had to do",
       [](T r) { return number(r.at.steps.fallbacks); }},
      {"linear_solves", U::count, "linear systems solved",
       [](T r) { return number(r.at.linear.solves); }},
      {"most_linear_iterations", U::count, "the most that one of them took",
       [](T r) { return number(r.at.linear.most_iterations); }},
      {"assembly_s", U::seconds, "spent on residuals and Jacobians, summed over threads",
       [](T r) { return r.at.steps.assembly_seconds; }},
      {"linear_setup_s", U::seconds, "spent on preconditioners or factorisations",
       [](T r) { return r.at.linear.setup_seconds; }},
      {"linear_solve_s", U::seconds, "spent on linear solves",
       [](T r) { return r.at.linear.solve_seconds; }},
      {"wall_s", U::seconds, "wall-clock time of all processes that worked on the run",
       [](T r) { return r.cost.wall_seconds; }},
      {"cpu_s", U::seconds, "their CPU time, user and system",
       [](T r) { return r.cost.cpu_seconds; }},
      {"peak_memory_mb", U::megabytes, "largest resident memory of the last process",
       [](T r) { return r.memory_mb; }},
      {"ranks", U::count, "MPI ranks", [](T r) { return number(r.ground.ranks); }},
      {"threads", U::count, "threads of a rank", [](T r) { return number(r.ground.threads); }},
  };
  return totals;
}

const std::vector<ReportedNumber<RaftMoment>>& raft_columns() {
  using R = const RaftMoment&;
  using U = text::Unit;
  static const std::vector<ReportedNumber<RaftMoment>> columns = {
      {"t", U::time, "output time", [](R r) { return r.t; }},
      {"raft", U::count, "1 is the largest; equally large ones follow each other as their nodes do",
       [](R r) { return number(r.number); }},
      {"area", U::area, "of the raft", [](R r) { return r.raft.area * r.units.area(); }},
      {"perimeter", U::length, "length of its level curves",
       [](R r) { return r.raft.perimeter * r.units.length(); }},
      {"x", U::length, "of its centre of area, which lies below the surface",
       [](R r) { return r.raft.centre[0] * r.units.length(); }},
      {"y", U::length, "", [](R r) { return r.raft.centre[1] * r.units.length(); }},
      {"z", U::length, "", [](R r) { return r.raft.centre[2] * r.units.length(); }},
      {"distance", U::length, "from the centre to the nearest point of the raft",
       [](R r) { return r.raft.distance * r.units.length(); }},
  };
  return columns;
}

namespace {

template <class Source>
const ReportedNumber<Source>* found(const std::vector<ReportedNumber<Source>>& list,
                                    const std::string& name) {
  for (const ReportedNumber<Source>& number : list)
    if (name == number.name) return &number;
  return nullptr;
}

}  // namespace

std::string unit_of_number(const std::string& name, bool scaled) {
  if (const auto* column = found(run_columns(), name)) return text::unit_name(column->unit, scaled);
  if (const auto* total = found(run_totals(), name)) return text::unit_name(total->unit, scaled);
  return "";
}

std::uint32_t report_layout() {
  std::string layout;
  for (const auto& column : raft_columns()) layout += std::string(column.name) + "\n";
  for (const auto& column : run_columns()) layout += std::string(column.name) + "\n";
  for (const std::size_t size :
       {sizeof(observables::Observables), sizeof(simulation::RunMonitor),
        sizeof(time::IntegratorStatistics), sizeof(linear::LinearStatistics),
        sizeof(simulation::RemeshStatistics)})
    layout += std::to_string(size) + "\n";
  return zlib::crc32_of(layout);
}

}  // namespace traceraft::run
