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

// use(content). Throws IoError if the file is not there or too large, DamagedFile if it is no JSON
// or lacks what is looked for.
template <class Use>
auto from_json(const std::filesystem::path& path, const Use& use,
               std::uint64_t max_bytes = 1 << 24) {
  try {
    return use(Json::parse(posix::read_file(path, max_bytes)));
  } catch (const nlohmann::json::parse_error& error) {
    throw DamagedFile(path.string() + " is damaged: it is no JSON from byte " +
                      std::to_string(error.byte) + " on");
  } catch (const nlohmann::json::exception&) {
    throw DamagedFile(path.string() +
                      " is damaged: something that it should hold is missing or of another kind");
  }
}

}  // namespace traceraft::input
