// Files of JSON that this program has written.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "backends/posix/durable_file.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::input {

using Json = nlohmann::ordered_json;

// null where there is no number.
inline Json number_or_null(const std::optional<double>& number) {
  return number ? Json(*number) : Json();
}

// The text of a file, with a checksum of all members as the last one.
std::string checked_text(Json json, int indent = 2);
// A whole file of it, as posix::write_durably writes one. Throws IoError.
void write_json(const std::filesystem::path& path, Json json, int indent = 2);
// Its content without the checksum, which may be missing. Throws DamagedFile if it does not fit, or
// if a name stands there twice, and what the parser throws.
Json parse_checked(const std::string& text);

// use(content). Throws IoError if the file is not there or too large, DamagedFile if it is no JSON,
// does not fit its checksum or lacks what is looked for.
template <class Use>
auto from_json(const std::filesystem::path& path, const Use& use,
               std::uint64_t max_bytes = 1 << 24) {
  const std::string text = posix::read_file(path, max_bytes);
  const auto content = [&] {
    try {
      return parse_checked(text);
    } catch (const DamagedFile& error) {
      throw DamagedFile(path.string() + " is damaged: " + error.what());
    }
  };
  try {
    return use(content());
  } catch (const nlohmann::json::parse_error& error) {
    throw DamagedFile(path.string() + " is damaged: it is no JSON from byte " +
                      std::to_string(error.byte) + " on");
  } catch (const nlohmann::json::exception&) {
    throw DamagedFile(path.string() +
                      " is damaged: something that it should hold is missing or of another kind");
  }
}

}  // namespace traceraft::input
