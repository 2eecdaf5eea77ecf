// Flat tables from TOML files (by toml++), with the places of their keys for complaints.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace traceraft::config {

using TomlValue =
    std::variant<std::string, bool, std::int64_t, double, std::vector<double>, std::monostate>;

class TomlTable {
 public:
  // Throws InputError naming file and line for what is no TOML and for keys that are not among the
  // known ones; a file that cannot be read is bad input, too, and `context` says whose.
  static TomlTable read(const std::filesystem::path& path, const std::vector<std::string>& known,
                        const std::string& context = "");

  std::vector<std::string> keys() const;
  bool has(const std::string& key) const { return entries_.count(key) != 0; }
  // "data.toml:3: key", or "data.toml: key" if it is not there.
  std::string where(const std::string& key) const;
  // std::monostate for what is none of the others: dates, tables, mixed lists.
  const TomlValue& value(const std::string& key) const { return entries_.at(key).value; }

  // Throw InputError if the key is not there or of another kind.
  std::string text(const std::string& key) const;
  double number(const std::string& key) const;
  std::string text_or(const std::string& key, const std::string& otherwise) const;
  double number_or(const std::string& key, double otherwise) const;

 private:
  struct Entry {
    TomlValue value;
    long line;
  };
  const TomlValue& needed(const std::string& key) const;

  std::filesystem::path path_;
  std::map<std::string, Entry> entries_;
};

}  // namespace traceraft::config
