// The checkpoints of a run folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <streambuf>
#include <string>
#include <vector>

#include "drivers/run/table_file.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::run {

// The cost of a run so far, in all processes that worked on it, set-up included.
struct RunCost {
  double wall_seconds = 0, cpu_seconds = 0;
};

// The content of one checkpoint file, besides magic, version and checksum.
struct Checkpoint {
  std::string configuration;          // resolved, to recognise a changed run
  TableExtents tables;                // when it was written
  std::string state;                  // RunState::save
  std::vector<double> concentration;  // c at the nodes, for --initial restart:DIR
  std::vector<bool> forest;           // of a mesh that follows the boundaries, as bits
  long step = 0;
  RunCost cost;
};

// Appends what is written to a string, such as a checkpoint's state. A std::ostringstream holds up
// to twice as much memory, and gives its text as a copy.
class StringAppender final : public std::ostream {
 public:
  // The string must outlive this object.
  explicit StringAppender(std::string& text) : std::ostream(nullptr), buffer_(text) {
    rdbuf(&buffer_);
  }

 private:
  class Buffer final : public std::streambuf {
   public:
    explicit Buffer(std::string& text) : text_(text) {}

   private:
    std::streamsize xsputn(const char* data, std::streamsize count) override {
      text_.append(data, static_cast<std::size_t>(count));
      return count;
    }
    int_type overflow(int_type character) override {
      if (!traits_type::eq_int_type(character, traits_type::eof()))
        text_.push_back(traits_type::to_char_type(character));
      return traits_type::not_eof(character);
    }

    std::string& text_;
  };

  Buffer buffer_;
};

class CheckpointStore {
 public:
  explicit CheckpointStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Durable before it returns; afterwards only the two newest are kept. Throws IoError.
  void write(const Checkpoint& checkpoint);

  // Has none been finished yet? Throws std::filesystem::filesystem_error if that cannot be told.
  bool empty() const { return files().empty(); }

  // The newest checkpoint that is whole. A torn or damaged one is passed over and named in
  // `refused`. Throws IoError if none is left.
  Checkpoint newest(std::vector<std::string>& refused) const;
  // The same; what was refused is said on stderr.
  Checkpoint newest() const;

 private:
  std::vector<std::filesystem::path> files() const;  // oldest first
  std::filesystem::path folder_;
};

// Encoding of a checkpoint file; decode throws IoError for anything but a whole, undamaged file of
// this version.
std::string encode(const Checkpoint& checkpoint);
Checkpoint decode(const std::string& data);

// c at the nodes. Throws IoError if the checkpoint, found in this run's folder, has another mesh.
Vec concentration_of(const Checkpoint& checkpoint, const std::filesystem::path& run_folder,
                     int nodes);

// The newest checkpoint of a run that goes on; none if there is none. Throws InputError if it is
// that of another run than this numerical identity says.
std::optional<Checkpoint> last_checkpoint(const std::filesystem::path& run_folder,
                                          const std::string& identity);

}  // namespace traceraft::run
