// The report of a verification: text for the terminal, CSV, JSON, a page, and a document.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/verify/verify_result.hpp"

namespace traceraft::verify {

// claim · measured · expected · tolerance · verdict, for people. The first row is the heading.
std::vector<std::vector<std::string>> claim_rows(const std::vector<studies::Claim>& claims);

void print_result(const StudyResult& result);

// The conditions that the numbers were measured in.
struct VerificationContext {
  std::string command;     // that repeats it
  std::string conditions;  // threads, integrator, solver, version
  std::string measured_with;
};

// Everything that is written into the folder, as own_files.hpp names it.
std::vector<std::string> files_of_a_verification();

// NAME-TABLE.csv and last NAME.json of one study, as soon as it is done. Throws IoError.
void write_study(const std::filesystem::path& folder, const StudyResult& result,
                 const std::string& measured_with);
// verify.json, verify.html and the charts of all. "" or why charts are missing.
std::string write_verification(const std::filesystem::path& folder,
                               const VerificationContext& context,
                               const std::vector<StudyResult>& results);
// A Markdown document. The charts that write_verification left in `folder` are copied into a folder
// of the document's name beside it.
void write_document(const std::filesystem::path& path, const std::filesystem::path& folder,
                    const VerificationContext& context, const std::vector<StudyResult>& results);

}  // namespace traceraft::verify
