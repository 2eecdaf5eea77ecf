// The result of one study of a verification, and how a file keeps it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drivers/input/json_file.hpp"
#include "verification/studies/study.hpp"

namespace traceraft::verify {

enum class StudyOutcome { holds, fails, not_measured };

const char* outcome_text(StudyOutcome outcome);

struct StudyResult {
  studies::StudyEntry study;
  studies::StudyReport report;
  std::string failure;  // why it could not be carried out; "" if it was
  double seconds = 0;

  StudyOutcome outcome() const;
};

// `measured_with`: whatever decides the numbers, in any words.
input::Json to_json(const StudyResult& result, const std::string& measured_with);

// The result that `folder` has of this study, if it was carried out there with the same. Throws
// IoError for a file that is damaged.
std::optional<StudyResult> measured_before(const std::filesystem::path& folder,
                                           const studies::StudyEntry& study,
                                           const std::string& measured_with);

}  // namespace traceraft::verify
