// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/mcap/mcap_format.hpp"

#include <zlib.h>

namespace sidestep {

void McapEncoder::texts(const McapTexts& texts) {
  std::uint32_t size = 0;
  for (const auto& [key, value] : texts) size += static_cast<std::uint32_t>(8 + key.size() + value.size());
  number(size);
  for (const auto& [key, value] : texts) {
    text(key);
    text(value);
  }
}

std::span<const std::uint8_t> McapDecoder::raw(std::uint64_t size) {
  is_ok_ = is_ok_ && size <= left_.size();
  if (!is_ok_) return {};
  const auto taken = left_.first(static_cast<std::size_t>(size));
  left_ = left_.subspan(static_cast<std::size_t>(size));
  return taken;
}

std::string McapDecoder::text() {
  const auto taken = raw(number<std::uint32_t>());
  return {taken.begin(), taken.end()};
}

McapTexts McapDecoder::texts() {
  McapDecoder inner(raw(number<std::uint32_t>()));
  McapTexts result;
  while (inner.is_ok() && !inner.left().empty()) {
    std::string key = inner.text();
    result[std::move(key)] = inner.text();
  }
  is_ok_ = is_ok_ && inner.is_ok();
  return is_ok_ ? result : McapTexts();
}

std::uint32_t mcap_checksum(std::span<const std::uint8_t> bytes, std::uint32_t sum) {
  if (bytes.empty()) return sum;  // with a null address, crc32_z() returns its initial value
  return static_cast<std::uint32_t>(crc32_z(sum, bytes.data(), bytes.size()));
}

}  // namespace sidestep
