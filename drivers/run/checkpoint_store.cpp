#include "drivers/run/checkpoint_store.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "backends/posix/durable_file.hpp"
#include "backends/zlib/checksum.hpp"
#include "drivers/run/run_numbers.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/binary.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::run {
namespace {

constexpr char kMagic[] = "traceraft checkpoint 6\n";  // the number is the version of the format
constexpr std::size_t kMagicSize = sizeof kMagic - 1;
constexpr std::uint64_t kLargestCheckpoint = std::uint64_t{1} << 36;
constexpr std::size_t kKept = 2;

void write_text(std::ostream& out, const std::string& text) {
  write_binary(out, static_cast<std::uint64_t>(text.size()));
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
}

// Sizes are compared with what is left, so that damaged data cannot ask for memory.
class Reader {
 public:
  explicit Reader(std::string_view data) : left_(data) {}

  template <class T>
  T number() {
    T value;
    take(1, &value);
    return value;
  }
  std::string text() {
    std::string result(count(1), '\0');
    take(result.size(), result.data());
    return result;
  }
  std::vector<double> numbers() {
    std::vector<double> result(count(sizeof(double)));
    take(result.size(), result.data());
    return result;
  }

 private:
  template <class T>
  void take(std::size_t items, T* to) {
    const std::size_t bytes = items * sizeof(T);
    if (bytes > left_.size()) throw IoError("it ends too early");
    std::copy_n(left_.data(), bytes, reinterpret_cast<char*>(to));
    left_.remove_prefix(bytes);
  }
  std::size_t count(std::size_t size) {
    const auto items = number<std::uint64_t>();
    if (items > left_.size() / size) throw IoError("it ends too early");
    return static_cast<std::size_t>(items);
  }

  std::string_view left_;
};

// Eight bits to a character; the first one says how many of the last are none.
std::string text_of_bits(const std::vector<bool>& bits) {
  if (bits.empty()) return "";
  std::string text(1 + (bits.size() + 7) / 8, '\0');
  text[0] = static_cast<char>(8 * (text.size() - 1) - bits.size());
  for (std::size_t k = 0; k < bits.size(); ++k)
    if (bits[k]) text[1 + k / 8] = static_cast<char>(text[1 + k / 8] | 1 << k % 8);
  return text;
}

std::vector<bool> bits_of_text(const std::string& text) {
  if (text.empty()) return {};
  const auto unused = static_cast<unsigned char>(text[0]);
  if (text.size() < 2 || unused > 7) throw IoError("its mesh is damaged");
  std::vector<bool> bits(8 * (text.size() - 1) - unused);
  for (std::size_t k = 0; k < bits.size(); ++k) bits[k] = (text[1 + k / 8] >> k % 8 & 1) != 0;
  return bits;
}

// The size and the checksum of what follows them.
std::string prefix(std::string_view body) {
  std::string result(kMagic);
  StringAppender out(result);
  write_binary(out, static_cast<std::uint64_t>(body.size()));
  write_binary(out, zlib::crc32_of(body));
  return result;
}
constexpr std::size_t kPrefixSize = kMagicSize + sizeof(std::uint64_t) + sizeof(std::uint32_t);

}  // namespace

std::string encode(const Checkpoint& checkpoint) {
  const std::size_t field = sizeof(double) * checkpoint.concentration.size();
  std::string result(kPrefixSize, '\0');
  result.reserve(checkpoint.configuration.size() + checkpoint.state.size() + field + 4096);
  StringAppender out(result);
  write_binary(out, report_layout());
  write_text(out, checkpoint.configuration);
  write_binary(out, static_cast<std::uint64_t>(checkpoint.tables.size()));
  for (const auto& [name, extent] : checkpoint.tables) {
    write_text(out, name);
    write_binary(out, extent.bytes);
    write_binary(out, extent.checksum);
  }
  write_text(out, checkpoint.state);
  write_binary(out, static_cast<std::uint64_t>(checkpoint.concentration.size()));
  out.write(reinterpret_cast<const char*>(checkpoint.concentration.data()),
            static_cast<std::streamsize>(field));
  write_text(out, text_of_bits(checkpoint.forest));
  write_binary(out, static_cast<std::int64_t>(checkpoint.step));
  write_binary(out, checkpoint.cost.wall_seconds);
  write_binary(out, checkpoint.cost.cpu_seconds);
  result.replace(0, kPrefixSize, prefix(std::string_view(result).substr(kPrefixSize)));
  return result;
}

Checkpoint decode(const std::string& data) {
  if (data.compare(0, kMagicSize, kMagic) != 0)
    throw IoError("it is not a checkpoint of this version");
  Reader head(std::string_view(data).substr(kMagicSize));
  const auto size = head.number<std::uint64_t>();
  const auto checksum = head.number<std::uint32_t>();
  const std::string_view body = std::string_view(data).substr(kPrefixSize);
  if (body.size() != size) throw IoError("its end is missing");
  if (zlib::crc32_of(body) != checksum) throw IoError("it is damaged");
  Reader in(body);
  if (in.number<std::uint32_t>() != report_layout())
    throw IoError("it is from a version that reports other numbers");
  Checkpoint checkpoint;
  checkpoint.configuration = in.text();
  for (auto tables = in.number<std::uint64_t>(); tables > 0; --tables) {
    const std::string name = in.text();
    TableExtent& extent = checkpoint.tables[name];
    extent.bytes = in.number<std::uint64_t>();
    extent.checksum = in.number<std::uint32_t>();
  }
  checkpoint.state = in.text();
  checkpoint.concentration = in.numbers();
  checkpoint.forest = bits_of_text(in.text());
  checkpoint.step = static_cast<long>(in.number<std::int64_t>());
  checkpoint.cost.wall_seconds = in.number<double>();
  checkpoint.cost.cpu_seconds = in.number<double>();
  return checkpoint;
}

void CheckpointStore::write(const Checkpoint& checkpoint) {
  char name[40];
  std::snprintf(name, sizeof name, "step-%010ld.ckpt", checkpoint.step);
  posix::write_durably(folder_ / name, encode(checkpoint));
  std::vector<std::filesystem::path> all = files();
  for (; all.size() > kKept; all.erase(all.begin())) std::filesystem::remove(all.front());
}

std::vector<std::filesystem::path> CheckpointStore::files() const {
  std::vector<std::filesystem::path> result;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const std::string name = entry.path().filename();
    const bool ours = name.size() == 20 && name.compare(0, 5, "step-") == 0 &&
                      entry.path().extension() == ".ckpt" &&
                      std::all_of(name.begin() + 5, name.begin() + 15,
                                  [](char ch) { return ch >= '0' && ch <= '9'; });
    if (ours) result.push_back(entry.path());
  }
  std::sort(result.begin(), result.end());
  return result;
}

Checkpoint CheckpointStore::newest(std::vector<std::string>& refused) const {
  std::vector<std::filesystem::path> all = files();
  for (; !all.empty(); all.pop_back()) {
    try {
      return decode(posix::read_file(all.back(), kLargestCheckpoint));
    } catch (const IoError& error) {
      refused.push_back(all.back().string() + ": " + error.what());
    }
  }
  std::string message = "no usable checkpoint in " + folder_.string();
  for (const std::string& why : refused) message += "; " + why;
  throw IoError(message);
}

Checkpoint CheckpointStore::newest() const {
  std::vector<std::string> refused;
  Checkpoint checkpoint = newest(refused);
  for (const std::string& why : refused)
    text::say_error("unusable checkpoint: " + why + "; the one before it is used");
  return checkpoint;
}

Vec concentration_of(const Checkpoint& checkpoint, const std::filesystem::path& run_folder,
                     int nodes) {
  if (checkpoint.concentration.size() != static_cast<std::size_t>(nodes))
    throw IoError(run_folder.string() + " has " + std::to_string(checkpoint.concentration.size()) +
                  " nodes, but this run has " + std::to_string(nodes));
  return Eigen::Map<const Vec>(checkpoint.concentration.data(), nodes);
}

std::optional<Checkpoint> last_checkpoint(const std::filesystem::path& run_folder,
                                          const std::string& identity) {
  const CheckpointStore store(run_folder / "checkpoints");
  if (store.empty()) return std::nullopt;
  Checkpoint checkpoint = store.newest();
  if (checkpoint.configuration != identity)
    throw InputError((run_folder / "config.toml").string() +
                     " has changed since the checkpoint was written; restore it, or start a new "
                     "run with --initial restart:" +
                     run_folder.string());
  return checkpoint;
}

}  // namespace traceraft::run
