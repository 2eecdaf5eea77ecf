#include "drivers/exit_codes.hpp"

#include <filesystem>
#include <new>

#include "backends/posix/folder_lock.hpp"
#include "drivers/numerical_failure.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::drivers {

Failure failure_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    return {kBadInput, error.what()};
  } catch (const IoError& error) {
    return {kInputOutput, error.what()};
  } catch (const std::filesystem::filesystem_error& error) {
    const bool too_long = error.code() == std::errc::filename_too_long;
    return {too_long ? kBadInput : kInputOutput,
            error.path1().string() + ": " + error.code().message()};
  } catch (const NumericalFailure& error) {
    return {kNumericalFailure, error.what()};
  } catch (const posix::LockedError& error) {
    return {kLocked, error.what()};
  } catch (const std::bad_alloc&) {
    return {kInternalError, "out of memory; use fewer --cells"};
  } catch (const std::exception& error) {
    return {kInternalError, std::string("internal error: ") + error.what()};
  }
}

}  // namespace traceraft::drivers
