#include "drivers/run/run_outputs.hpp"

#include <algorithm>
#include <cstdio>

#include "backends/png/png_file.hpp"
#include "backends/posix/process.hpp"
#include "kernel/core/text.hpp"
#include "kernel/fem/trace.hpp"

namespace traceraft::run {
namespace {

TableExtent extent_of(const TableExtents& extents, const std::string& name) {
  const auto found = extents.find(name);
  return found == extents.end() ? TableExtent{} : found->second;
}

constexpr int kViewPixels = 480;
constexpr std::uint64_t kLargestPicture = 1 << 24;  // bytes

std::string numbered(const char* stem, std::size_t index, const char* extension) {
  char name[40];
  std::snprintf(name, sizeof name, "%s-%04zu.%s", stem, index, extension);
  return name;
}

// The file that ParaView opens at an output time.
std::string field_name(std::size_t index, const Communicator& ranks) {
  return numbered("field", index, ranks.size() == 1 ? "vtu" : "pvtu");
}
std::string piece_name(std::size_t index, int rank) {
  char name[40];
  std::snprintf(name, sizeof name, "field-%04zu-%04d.vtu", index, rank);
  return name;
}

// No triangle has corners in two rafts: two that are above the level belong to one.
std::vector<int> largest_at_corners(const mesh::CutSurface& surface,
                                    const std::vector<int>& of_point) {
  std::vector<int> largest;
  for (const auto& [a, b, c] : surface.triangles)
    largest.push_back(std::max({of_point[a], of_point[b], of_point[c]}));
  return largest;
}

}  // namespace

RunTables::RunTables(const RunFolder& folder, const RunSchedule& schedule,
                     const TableExtents& extents)
    : schedule_(schedule),
      series_(folder.table("series.csv"), extent_of(extents, "series.csv")),
      observables_(folder.table("observables.csv"), extent_of(extents, "observables.csv")),
      rafts_(folder.table("rafts.csv"), extent_of(extents, "rafts.csv")) {
  const bool scaled = schedule.units.scaled;
  const std::string heading = csv_heading(run_columns(), scaled);
  if (series_.extent().bytes == 0) series_.append(heading);
  if (observables_.extent().bytes == 0) observables_.append(heading);
  if (rafts_.extent().bytes == 0) rafts_.append(csv_heading(raft_columns(), scaled));
}

void RunTables::add_step(const RunMoment& moment) {
  series_.append(csv_row(run_columns(), moment));
}

void RunTables::add_output(const RunMoment& moment, const observables::RaftReport& rafts) {
  observables_.append(csv_row(run_columns(), moment));
  std::string text;
  int number = 0;
  for (const observables::Raft& raft : rafts.rafts)
    text += csv_row(raft_columns(), RaftMoment{raft, ++number, moment.t, schedule_.units});
  rafts_.append(text);
}

void RunTables::sync() {
  for (TableFile* table : {&series_, &observables_, &rafts_}) table->sync();
}

TableExtents RunTables::extents() const {
  return {{"series.csv", series_.extent()},
          {"observables.csv", observables_.extent()},
          {"rafts.csv", rafts_.extent()}};
}

TableExtents RunTables::extents_at_end(const RunFolder& folder) const {
  TableExtents all = extents();
  if (const std::filesystem::path list = folder.path / "fields.pvd"; std::filesystem::exists(list))
    all["fields.pvd"] = extent_of_file(list);
  return all;
}

void TableWriter::on_step(const simulation::RunState& state) {
  const observables::Observables& row = state.observables;
  tables_.add_step(moment_of(run_, row, row.t * run_.units.time()));
}

void TableWriter::on_output(const observables::Observables& row,
                            const observables::RaftReport& rafts, VecView) {
  tables_.add_output(moment_of(run_, row, run_.output_labels[run_.output_index(row.t)]), rafts);
}

void FieldWriter::on_output(const observables::Observables& row,
                            const observables::RaftReport& rafts, VecView y) {
  const fem::SurfaceSpace& space = *run_.space;
  const auto traced = [&](VecView nodal) {
    Vec buffer;
    return Vec(fem::trace(space, space.with_ghosts(nodal, buffer)));
  };
  files_.write(space,
               {row.t,
                {{"c", traced(run_.problem->c_of(y))}, {"mu", traced(run_.problem->mu_of(y))}},
                rafts.of_point});
}

void FieldFiles::write(const fem::SurfaceSpace& space, const SurfaceFields& fields) const {
  const Communicator& ranks = *space.communicator;
  const double length = schedule_.units.length();
  const std::size_t index = schedule_.output_index(fields.t);
  const bool alone = ranks.size() == 1;
  posix::write_durably(
      folder_.fields() / (alone ? field_name(index, ranks) : piece_name(index, ranks.rank())),
      zlib::vtu_text(space, length, fields.fields,
                     {{"raft", largest_at_corners(space.surface, fields.raft)}}));
  const observables::Image image = observables::draw_front_and_back(
      space, fields.fields.front().values, well_.a, well_.b, kViewPixels);
  const double half_width = observables::view_half_width(space) * length;
  // Nothing is named before all of it is there.
  if (!ranks.all(true) || !ranks.root()) return;
  if (!alone) {
    std::vector<std::string> pieces, names;
    for (int rank = 0; rank < ranks.size(); ++rank) pieces.push_back(piece_name(index, rank));
    for (const zlib::PointField& field : fields.fields) names.push_back(field.name);
    posix::write_durably(folder_.fields() / field_name(index, ranks),
                         zlib::pvtu_text(pieces, names, {"raft"}));
  }
  // Files are removed that this run wrote at that time before it went on with more or fewer ranks.
  std::filesystem::remove(folder_.fields() / numbered("field", index, alone ? "pvtu" : "vtu"));
  for (int rank = alone ? 0 : ranks.size();; ++rank)
    if (!std::filesystem::remove(folder_.fields() / piece_name(index, rank))) break;
  posix::write_durably(folder_.fields() / numbered("view", index, "png"), png::png_bytes(image));
  write_strip(index, {half_width, text::unit_name(text::Unit::length, schedule_.units.scaled),
                      well_.a, well_.b});
  collect(index);
}

// The strip shows pictures that are there, up to the newest: those of an earlier process may be
// gone.
void FieldFiles::write_strip(std::size_t newest, const StripLegend& legend) const {
  std::vector<std::size_t> there;
  for (std::size_t i = 0; i <= newest; ++i)
    if (std::filesystem::exists(folder_.fields() / numbered("view", i, "png"))) there.push_back(i);
  std::vector<StripView> views;
  const std::string unit = text::unit_name(text::Unit::time, schedule_.units.scaled);
  for (const std::size_t k : strip_choice(there.size())) {
    const std::filesystem::path file = folder_.fields() / numbered("view", there[k], "png");
    views.push_back({png::image_of_png(posix::read_file(file, kLargestPicture)),
                     "t = " + formatted("%.3g ", schedule_.output_labels[there[k]]) + unit});
  }
  posix::write_durably(folder_.path / "view.png", png::png_bytes(compose_strip(views, legend)));
}

// All output times up to the newest, on however many ranks they were written.
void FieldFiles::collect(std::size_t newest) const {
  std::vector<std::pair<double, std::string>> files;
  for (std::size_t i = 0; i <= newest; ++i)
    for (const char* extension : {"vtu", "pvtu"})
      if (const std::string name = numbered("field", i, extension);
          std::filesystem::exists(folder_.fields() / name))  // not if fields were off
        files.emplace_back(schedule_.output_labels[i], "fields/" + name);
  posix::write_durably(folder_.path / "fields.pvd", zlib::pvd_text(files));
}

CheckpointWriter::CheckpointWriter(const RunFolder& folder, const RunSetup& run, RunTables* tables,
                                   std::string configuration, double interval,
                                   const RunCost& before)
    : store_(folder.checkpoints()),
      run_(run),
      tables_(tables),
      configuration_(std::move(configuration)),
      interval_(interval),
      before_(before) {}

RunCost CheckpointWriter::cost() const {
  return {before_.wall_seconds + posix::wall_seconds(),
          before_.cpu_seconds + run_.ranks->sum(posix::cpu_seconds())};
}

void CheckpointWriter::on_step(const simulation::RunState& state) {
  // One clock decides for all.
  if (run_.ranks->any(run_.ranks->root() && (!written_ || since_last_.seconds() >= interval_)))
    write(state);
}

void CheckpointWriter::write(const simulation::RunState& state) {
  // The rows that the checkpoint counts on are on the disk before it is.
  if (tables_) tables_->sync();
  Checkpoint checkpoint;
  checkpoint.configuration = configuration_;
  StringAppender out(checkpoint.state);
  state.save(CheckpointOut(out, run_.space->order));
  const Vec c = run_.space->order.gathered(run_.problem->c_of(state.integrator().state()));
  checkpoint.concentration.assign(c.data(), c.data() + c.size());
  checkpoint.step = state.integrator().statistics().steps;
  if (run_.adaptation) checkpoint.forest = run_.adaptation->forest().bits();
  checkpoint.cost = cost();
  if (tables_) {
    checkpoint.tables = tables_->extents();
    store_.write(checkpoint);
  }
  since_last_ = Stopwatch();
  written_ = true;
}

}  // namespace traceraft::run
