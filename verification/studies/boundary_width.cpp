// Boundaries that become narrower: does coarsening go with ε² D, as the sharp limit has it, and
// what does the lattice of the mesh do to boundaries whose driving force falls with ε?
#include <cmath>
#include <functional>

#include "verification/bench/two_rafts.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr double kFineMesh = 128 * 0.02;  // cells times ε: h/ε = 1.3
constexpr double kLimit = 5;              // ε² t is less when the smaller raft vanishes
const Point kAxis(3, 2, 10);              // boundaries stick most where they lie along the lattice

int cells_for(double epsilon, double coarser) {
  return static_cast<int>(std::lround(kFineMesh / epsilon / coarser));
}

struct Series {
  const char* name;
  double coarser;  // than h/ε = 1.3
  std::vector<double> widths;
};

// On the coarser mesh the narrowest boundaries rest for so long that nobody would wait for them.
std::vector<Series> series_of(bool quick) {
  std::vector<double> widths = {0.02, 0.01, 0.005};
  if (!quick) widths.push_back(0.0025);
  return {{"h/epsilon = 1.3", 1, widths},
          {"h/epsilon = 2.6", 2, {widths.begin(), widths.begin() + (quick ? 2 : 3)}}};
}

// (ε, ε² t of vanishing), and a row of the table for each. `advance` is called after each run.
statistics::Points scaled_times(const bench::Bench& bench, const Series& series,
                                bench::Table& table, const std::function<void()>& advance) {
  statistics::Points scaled;
  for (const double epsilon : series.widths) {
    const int cells = cells_for(epsilon, series.coarser);
    const bench::TwoRafts rafts = bench::follow_two_rafts(
        bench, {epsilon, cells, true, bench.request.threads, kLimit / (epsilon * epsilon), kAxis});
    scaled.emplace_back(epsilon, epsilon * epsilon * rafts.vanishes);
    table.rows.push_back({epsilon, mesh::CubeMesh{cells}.h() / epsilon, rafts.meshes.mean_nodes(),
                          rafts.meshes.steps, rafts.seconds, rafts.vanishes, scaled.back().second});
    advance();
  }
  return scaled;
}

StudyReport run(const bench::Bench& bench) {
  StudyReport report;
  report.tables = {{"two rafts",
                    {"epsilon", "h/epsilon", "nodes", "steps", "seconds", "smaller raft vanishes",
                     "epsilon^2 t"},
                    {}}};
  report.charts = {
      {"two rafts", "epsilon / R", "epsilon^2 t of vanishing, R^4/D", true, false, {}}};
  const std::vector<Series> all = series_of(bench.quick());
  const auto runs = static_cast<double>(all[0].widths.size() + all[1].widths.size());
  double done = 0;
  for (const Series& series : all)
    report.charts[0].series.push_back(
        {series.name,
         scaled_times(bench, series, report.tables[0], [&] { bench.progress(++done / runs); })});
  const statistics::Points& fine = report.charts[0].series[0].points;
  const auto change = [&](std::size_t k) { return fine[k].second - fine[k - 1].second; };
  const std::size_t last = fine.size() - 1;
  report.claims = {
      claim_at_most("change of epsilon^2 t by the last halving of epsilon / by the one before",
                    change(last) / change(last - 1), 0.75)};
  report.notes = {
      "Two rafts, caps of 26 and 20 degrees; tolerance 5e-4. Coarsening by line tension goes with "
      "epsilon^2 D where boundaries are narrow, so that epsilon^2 t tends to a constant.",
      "The force on a boundary falls with epsilon, what the lattice holds against it at a given "
      "h/epsilon does not: a mesh has to be the finer, in units of epsilon, the narrower "
      "boundaries are."};
  return report;
}

}  // namespace

StudyEntry boundary_width_study() {
  return {"boundary-width",
          "narrower boundaries: does coarsening go with epsilon^2 D, and does the mesh follow?",
          run, true};
}

}  // namespace traceraft::studies
