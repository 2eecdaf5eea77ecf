// The outputs of a run: tables, fields and checkpoints, each a listener of the run loop.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "backends/zlib/vtu_writer.hpp"
#include "drivers/run/checkpoint_store.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/run/run_numbers.hpp"
#include "drivers/run/run_setup.hpp"
#include "drivers/run/view_strip.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/simulation/run_loop.hpp"

namespace traceraft::run {

// The tables. series.csv: a row per accepted step. observables.csv: the same columns at the output
// times. rafts.csv: every raft at the output times.
class RunTables {
 public:
  // `extents`: as a checkpoint recorded them; empty for a new run. Throws IoError.
  RunTables(const RunFolder& folder, const RunSchedule& schedule, const TableExtents& extents);
  void add_step(const RunMoment& moment);
  void add_output(const RunMoment& moment, const observables::RaftReport& rafts);
  void sync();
  TableExtents extents() const;
  // And of the list of fields, if there is one.
  TableExtents extents_at_end(const RunFolder& folder) const;

 private:
  const RunSchedule& schedule_;
  TableFile series_, observables_, rafts_;
};

// Fills them on the first rank.
class TableWriter final : public simulation::RunListener {
 public:
  TableWriter(RunTables& tables, const RunSetup& run) : tables_(tables), run_(run) {}
  void on_step(const simulation::RunState& state) override;
  void on_output(const observables::Observables& row, const observables::RaftReport& rafts,
                 VecView y) override;

 private:
  RunTables& tables_;
  const RunSetup& run_;
};

// The fields at an output time on the points of Γ_h, and the raft at each (0: none).
struct SurfaceFields {
  double t;                              // R²/D
  std::vector<zlib::PointField> fields;  // c first
  std::vector<int> raft;
};

// fields/field-NNNN.vtu with fields on Γ_h, collected in fields.pvd, and a picture of front and
// back as fields/view-NNNN.png; view.png shows up to six of them. Several ranks write a piece each,
// field-NNNN-RRRR.vtu, joined by field-NNNN.pvtu.
class FieldFiles {
 public:
  FieldFiles(const RunFolder& folder, const RunSchedule& schedule, const physics::DoubleWell& well)
      : folder_(folder), schedule_(schedule), well_(well) {}
  void write(const fem::SurfaceSpace& space, const SurfaceFields& fields) const;  // collective

 private:
  void collect(std::size_t newest) const;
  void write_strip(std::size_t newest, const StripLegend& legend) const;

  const RunFolder& folder_;
  const RunSchedule& schedule_;
  physics::DoubleWell well_;
};

// c and mu of a run, at the output times.
class FieldWriter final : public simulation::RunListener {
 public:
  FieldWriter(const RunFolder& folder, const RunSetup& run)
      : files_(folder, run, run.problem->model().well), run_(run) {}
  void on_output(const observables::Observables& row, const observables::RaftReport& rafts,
                 VecView y) override;

 private:
  FieldFiles files_;
  const RunSetup& run_;
};

// Writes a checkpoint every `interval` seconds; writing does not change the run. On every rank; the
// first one, which has the tables, writes.
class CheckpointWriter final : public simulation::RunListener {
 public:
  CheckpointWriter(const RunFolder& folder, const RunSetup& run, RunTables* tables,
                   std::string configuration, double interval, const RunCost& before);
  void on_step(const simulation::RunState& state) override;
  void write(const simulation::RunState& state);
  RunCost cost() const;  // of the whole run: earlier processes and these

 private:
  CheckpointStore store_;
  const RunSetup& run_;
  RunTables* tables_;
  std::string configuration_;
  double interval_;
  RunCost before_;
  Stopwatch since_last_;
  bool written_ = false;
};

}  // namespace traceraft::run
