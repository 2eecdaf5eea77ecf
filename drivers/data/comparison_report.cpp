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

namespace traceraft {
namespace {

namespace fs = std::filesystem;

std::string about(const PublishedFacts& facts) {
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

void refuse_other_membrane(const MeasuredVesicles& data, const PublishedFacts& facts) {
  if (data.composition.empty() || same_membrane(data.composition, facts.composition)) return;
  throw InputError("--facts: their membrane is " + facts.composition +
                   ", but that of the measurements is " + data.composition);
}

class ComparisonReport {
 public:
  ComparisonReport(const MeasuredVesicles& data, const ComparisonRequest& request)
      : data_(data),
        request_(request),
        model_(model_of(request.ensemble)),
        ensemble_(runs_of(request.ensemble)),
        runs_(ensemble_.histories),
        agreements_(compare_with_runs(data, runs_)),
        notes_(notes()),
        summary_(summarise(runs_)),
        measured_(fit_measurements(data, request.window)),
        simulated_(fit_runs(runs_, summary_.times, request.window)) {}

  void write() {
    fs::create_directories(request_.out);
    write_durably(
        request_.out / "comparison.json",
        Json{{"runs", runs_.size()}, {"missing_runs", ensemble_.missing}, {"data", data_.name}}
                .dump(2, ' ', false, Json::error_handler_t::replace) +
            "\n");
    write_durably(request_.out / "comparison.csv", csv_text(agreement_table(agreements_)));
    write_durably(request_.out / "comparison.html", page().html());
  }

  void print() const {
    say("%s\n\n", about_data(data_));
    print_rows(agreement_rows(agreements_));
    say("%s\n\npower laws from %g to %g s\n", about_agreement(runs_.size()), request_.window.begin,
        request_.window.end);
    print_rows(laws());
    for (const std::string& remark : remarks()) say("%s\n", remark);
    for (const std::string& note : notes_) say("\n%s\n", note);
    say("\nopen next: %s\n", (request_.out / "comparison.html"));
    if (!missing_.text().empty()) say("missing from the page: %s\n", missing_.text());
  }

 private:
  Page page() {
    Page page("Measured and simulated vesicles");
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
    for (const Quantity quantity : kQuantities)
      add_chart(page, chart_of(quantity),
                request_.out / (std::string("comparison-") + name_of(quantity).id), missing_);
    add_settings(page, model_);
    add_provenance(page, request_.ensemble, request_.command);
    return page;
  }

  std::vector<Row> laws() const {
    std::vector<Row> rows = {law_heading(), law_row(origin_of(data_), measured_),
                             law_row("simulated", simulated_)};
    if (request_.facts) rows.push_back(law_row(*request_.facts));
    return rows;
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    if (!ensemble_.missing.empty()) notes.push_back(ensemble_.missing);
    if (const std::string other = other_membrane(data_.composition, model_); !other.empty())
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

  Chart chart_of(Quantity quantity) const {
    const Window& window = request_.window;
    Chart chart = comparison_chart(data_, summary_, quantity);
    if (quantity != Quantity::perimeter) return chart;
    if (measured_)
      chart.series.push_back(law_curve("law of the measurements", measured_->law, window));
    if (simulated_)
      chart.series.push_back(law_curve("law of the simulations", simulated_->law, window));
    if (request_.facts)
      chart.series.push_back(
          law_curve("published law", request_.facts->perimeter, request_.facts->window));
    return chart;
  }

  const MeasuredVesicles& data_;
  const ComparisonRequest& request_;
  Configuration model_;
  const EnsembleRuns ensemble_;
  const std::vector<History>& runs_;
  std::vector<Agreement> agreements_;
  const std::vector<std::string> notes_;
  EnsembleSummary summary_;
  std::optional<FittedLaw> measured_, simulated_;
  Missing missing_;  // of the charts
};

}  // namespace

int compare_with_ensemble(const MeasuredVesicles& data, const ComparisonRequest& request) {
  if (request.facts) refuse_other_membrane(data, *request.facts);
  ComparisonReport report(data, request);
  report.write();
  if (!request.quiet) report.print();
  return kSuccess;
}

}  // namespace traceraft
