// From the files of `explain` to the search, for its command and for campaigns.
#pragma once

#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "verification/selection/search/explanation.hpp"

namespace traceraft::explain {

inline constexpr int kFewestReplicates = 49, kMostReplicates = 9999, kMostNamedEffects = 5;

struct ExplainJob {
  std::string data, model;    // a folder and a file; no file: flags alone
  config::GivenValues flags;  // of the model, before what its file says
  int threads = 0;            // 0: one for each processor
  int effects = 3, replicates = 199;
  double diffusion_error = 0;  // relative standard error of the model's D; 0: it is not known
  std::vector<std::string> without;

  int processors() const;  // threads, with 0 resolved
};

struct ExplainSetup {
  std::string model_file;                          // of the user; empty: none
  config::GivenValues model;                       // with the radius of the vesicle
  config::Configuration configuration = {{}, {}};  // of the model
  std::vector<assimilation::FieldSeries> series;
  selection::ExplainRequest request;
  std::vector<std::string> notes = {};  // what is odd about data and model, and what was made of it
  std::string name = {};                // of the data
  bool synthetic = false;

  double last_s() const;  // the time of the last snapshot
};

// "my vesicle (SYNTHETIC): 1 vesicle, 8 snapshots, R = 5 um, blurred by 0.1 um"
std::string data_text(const ExplainSetup& setup);

// The values in the flags and the model's file; the flags count where both have one.
config::GivenValues model_said(const ExplainJob& job);

// Fields have a radius of their own. Throws InputError for data and models that cannot be used.
ExplainSetup read_explain_job(const ExplainJob& job);

}  // namespace traceraft::explain
