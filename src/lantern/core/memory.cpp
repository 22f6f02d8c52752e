// SPDX-License-Identifier: MIT
#include "lantern/core/memory.h"

#include "lantern/core/error.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sys/resource.h>
#include <unistd.h>

namespace lantern {
namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

/// The number at the start of a file; of "max" there is none.
std::uint64_t number_in(const char* path) {
  std::uint64_t value = 0;
  return std::ifstream(path) >> value ? value : kUnknown;
}

}  // namespace

std::uint64_t available_bytes() {
  std::uint64_t available = kUnknown;
  std::ifstream file("/proc/meminfo");
  for (std::string key; file >> key;) {
    std::uint64_t kibibytes = 0;
    if (key == "MemAvailable:" && file >> kibibytes) available = kibibytes * 1024;
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  // A container may allow less than the machine has.
  const std::uint64_t limit = number_in("/sys/fs/cgroup/memory.max");
  const std::uint64_t used = number_in("/sys/fs/cgroup/memory.current");
  if (limit != kUnknown && used != kUnknown) {
    available = std::min(available, limit - std::min(limit, used));
  }
  // So may whoever started the process.
  rlimit space{};
  if (::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) {
    const std::uint64_t pages = number_in("/proc/self/statm");
    const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    const std::uint64_t taken = pages == kUnknown ? 0 : pages * page;
    available =
        std::min<std::uint64_t>(available, space.rlim_cur - std::min(space.rlim_cur, taken));
  }
  return available;
}

void require_memory(std::uint64_t bytes, const std::string& what, const std::string& remedy) {
  const std::uint64_t available = available_bytes();
  if (bytes <= available) return;
  constexpr double kGigabyte = 1e9;
  throw Error(fmt::format("{} takes {:.2f} GB of memory and {:.2f} GB are free: {}", what,
                          static_cast<double>(bytes) / kGigabyte,
                          static_cast<double>(available) / kGigabyte, remedy));
}

}  // namespace lantern
