#include "drivers/input/json_file.hpp"

#include <set>
#include <utility>
#include <vector>

#include "backends/zlib/checksum.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::input {
namespace {

constexpr char kChecksum[] = "checksum";

// Text that is not UTF-8 can stand in names of folders.
std::string text_of(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// The checksum of what a reader gets: the same file read and written again has the same.
std::string checksum_of(const Json& json) {
  return formatted("%08x", zlib::crc32_of(text_of(json)));
}

// The parser would take the last of two members with one name. It knows no depth, but what copies,
// writes and frees a value goes down into it by recursion.
Json parsed_strictly(const std::string& text) {
  constexpr int kDeepest = 64;
  std::vector<std::set<std::string>> names;  // of each object around the place
  std::string repeated;
  Json json = Json::parse(text, [&](int depth, Json::parse_event_t event, Json& value) {
    if (depth > kDeepest)
      throw DamagedFile("lists and objects stand more than " + std::to_string(kDeepest) +
                        " deep in each other");
    if (event == Json::parse_event_t::object_start) names.emplace_back();
    if (event == Json::parse_event_t::object_end) names.pop_back();
    if (event == Json::parse_event_t::key && !names.back().insert(value).second)
      repeated = value.get<std::string>();
    return true;
  });
  if (!repeated.empty()) throw DamagedFile("'" + repeated.substr(0, 40) + "' stands there twice");
  return json;
}

}  // namespace

std::string checked_text(Json json, int indent) {
  const std::string checksum = checksum_of(json);  // before the member is there
  json[kChecksum] = checksum;
  return text_of(json, indent) + "\n";
}

void write_json(const std::filesystem::path& path, Json json, int indent) {
  posix::write_durably(path, checked_text(std::move(json), indent));
}

Json parse_checked(const std::string& text) {
  Json json = parsed_strictly(text);
  if (!json.is_object() || !json.contains(kChecksum)) return json;
  const Json stated = json[kChecksum];
  json.erase(kChecksum);
  if (stated != checksum_of(json)) throw DamagedFile("its content does not fit its checksum");
  return json;
}

}  // namespace traceraft::input
