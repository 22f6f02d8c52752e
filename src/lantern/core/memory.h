// SPDX-License-Identifier: MIT
// How much memory there is, so that what is too large is refused before it is asked for.
#pragma once

#include <cstdint>
#include <string>

namespace lantern {

/// Bytes that the process could still take without pushing anything out of memory or passing its
/// own limit of address space; the largest number where the system does not say.
std::uint64_t available_bytes();

/// Throws Error with both numbers if `what` of so many bytes is more than is available; `remedy` is
/// how to need less.
void require_memory(std::uint64_t bytes, const std::string& what, const std::string& remedy);

}  // namespace lantern
