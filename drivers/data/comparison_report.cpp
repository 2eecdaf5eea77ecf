#include "drivers/data/comparison_report.hpp"

#include "backends/posix/durable_file.hpp"
#include "drivers/data/agreement_report.hpp"
#include "drivers/data/law_report.hpp"
#include "drivers/data/measured_report.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/input/json_file.hpp"
#include "drivers/input/model_of_data.hpp"
#include "drivers/output/provenance.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "verification/observations/raft_fraction.hpp"

namespace traceraft::data {
namespace {

namespace fs = std::filesystem;

std::string about(const observations::PublishedFacts& facts) {
  std::string text =
      "Published (" + facts.origin +
      formatted("): raft fraction %.3g +- %.2g, %d measurements of %d vesicles.", facts.fraction,
                facts.fraction_sd, facts.measurements, facts.vesicles);
  if (facts.outliers >= 0)
    text += formatted(
        " %d of their numbers of rafts lie outside the range of the published simulations.",
        facts.outliers);
  return text;
}

void refuse_other_membrane(const observations::MeasuredVesicles& data,
                           const observations::PublishedFacts& facts) {
  if (data.composition.empty() || observations::same_membrane(data.composition, facts.composition))
    return;
  throw InputError("--facts: their membrane is " + facts.composition +
                   ", but that of the measurements is " + data.composition);
}

class ComparisonReport {
 public:
  ComparisonReport(const observations::MeasuredVesicles& data, const ComparisonRequest& request)
      : data_(data),
        request_(request),
        model_(model_of(request.ensemble)),
        ensemble_(runs_of(request.ensemble)),
        runs_(ensemble_.histories),
        agreements_(observations::compare_with_runs(data, runs_)),
        notes_(notes()),
        summary_(ensemble::summarise(runs_)),
        measured_(observations::fit_measurements(data, request.window)),
        simulated_(observations::fit_runs(runs_, summary_.times, request.window)) {}

  void write() {
    fs::create_directories(request_.out);
    input::write_json(
        request_.out / "comparison.json",
        {{"runs", runs_.size()}, {"missing_runs", ensemble_.missing}, {"data", data_.name}});
    posix::write_durably(request_.out / "comparison.csv",
                         output::csv_text(agreement_table(agreements_)));
    posix::write_durably(request_.out / "comparison.html", page().html());
  }

  void print() const {
    text::say("%s\n\n", about_data(data_));
    output::print_rows(agreement_rows(agreements_));
    text::say("%s\n\npower laws from %g to %g s\n", about_agreement(runs_.size()),
              request_.window.begin, request_.window.end);
    output::print_rows(laws());
    for (const std::string& remark : remarks()) text::say("%s\n", remark);
    for (const std::string& note : notes_) text::say("\n%s\n", note);
    text::say("\nopen next: %s\n", (request_.out / "comparison.html"));
    if (!missing_.text().empty()) text::say("missing from the page: %s\n", missing_.text());
  }

 private:
  output::Page page() {
    output::Page page("Measured and simulated vesicles");
    page.paragraph(about_data(data_) + ".");
    if (request_.facts) page.paragraph(about(*request_.facts));
    page.paragraph(std::to_string(runs_.size()) + " runs in " + request_.ensemble.string() + ". " +
                   about_agreement(runs_.size()));
    page.table(agreement_rows(agreements_));
    for (const std::string& note : notes_) page.paragraph(note);
    page.paragraph(formatted("Power laws fitted from %g to %g s.", request_.window.begin,
                             request_.window.end));
    page.table(laws());
    for (const std::string& remark : remarks()) page.paragraph(remark);
    for (const observations::Quantity quantity : observations::kQuantities)
      output::add_chart(
          page, chart_of(quantity),
          request_.out / (std::string("comparison-") + observations::name_of(quantity).id),
          missing_);
    output::add_settings(page, model_);
    output::add_provenance(page, request_.ensemble, request_.command);
    return page;
  }

  std::vector<output::Row> laws() const {
    std::vector<output::Row> rows = {law_heading(), law_row(origin_of(data_), measured_),
                                     law_row("simulated", simulated_)};
    if (request_.facts) rows.push_back(law_row(*request_.facts));
    return rows;
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    if (!ensemble_.missing.empty()) notes.push_back(ensemble_.missing);
    if (const std::string other = input::other_membrane(data_.composition, model_); !other.empty())
      notes.push_back("ANOTHER MEMBRANE: the simulated membrane is " + other + ".");
    for (const std::string& note : cautions(data_, model_.units().length(), runs_, agreements_))
      notes.push_back(note);
    if (model_.options().surface != "sphere")
      notes.push_back("The simulated surface is not a sphere: " + model_.options().surface + ".");
    return notes;
  }

  std::vector<std::string> remarks() const {
    std::vector<std::string> remarks = remarks_on({measured_, simulated_});
    if (simulated_ && summary_.times.back() < 0.99 * request_.window.end)
      remarks.push_back(
          formatted("The runs end at %.4g s. Their law is fitted to the times before.",
                    summary_.times.back()));
    return remarks;
  }

  bench::Chart chart_of(observations::Quantity quantity) const {
    const statistics::Window& window = request_.window;
    bench::Chart chart = comparison_chart(data_, summary_, quantity);
    if (quantity != observations::Quantity::perimeter) return chart;
    if (measured_)
      chart.series.push_back(law_curve("law of the measurements", measured_->law, window));
    if (simulated_)
      chart.series.push_back(law_curve("law of the simulations", simulated_->law, window));
    if (request_.facts)
      chart.series.push_back(
          law_curve("published law", request_.facts->perimeter, request_.facts->window));
    return chart;
  }

  const observations::MeasuredVesicles& data_;
  const ComparisonRequest& request_;
  config::Configuration model_;
  const EnsembleRuns ensemble_;
  const std::vector<observations::History>& runs_;
  std::vector<observations::Agreement> agreements_;
  const std::vector<std::string> notes_;
  ensemble::EnsembleSummary summary_;
  std::optional<observations::FittedLaw> measured_, simulated_;
  output::Missing missing_;  // of the charts
};

}  // namespace

int compare_with_ensemble(const observations::MeasuredVesicles& data,
                          const ComparisonRequest& request) {
  if (request.facts) refuse_other_membrane(data, *request.facts);
  ComparisonReport report(data, request);
  report.write();
  if (!request.quiet) report.print();
  return drivers::kSuccess;
}

}  // namespace traceraft::data
