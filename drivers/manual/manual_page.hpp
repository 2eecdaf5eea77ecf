// The manual page of the program, in roff's macros for manual pages (man(7)).
#pragma once

#include <string>

#include "drivers/manual/description.hpp"

namespace traceraft::manual {

// `date` is that of the version, "2026-11-29".
std::string manual_page(const DescribedProgram& program, const std::string& version,
                        const std::string& date);

}  // namespace traceraft::manual
