// SPDX-License-Identifier: Apache-2.0
#include "common/keys/key_file.hpp"

#include <fmt/format.h>
#include <openssl/bio.h>
#include <stdexcept>

#include "common/file/permission.hpp"
#include "common/file/read_file.hpp"

namespace sidestep {

std::shared_ptr<bio_st> open_key_file(const std::string& path) {
  constexpr std::size_t kMaxBytes = 16'000'000;  // a list of some hundred thousand revoked keys
  require_read_permission(path);
  std::string content;
  try {
    content = read_file(path, kMaxBytes);
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(fmt::format("cannot read {}: {}", path, error.what()));
  }
  std::shared_ptr<BIO> result(BIO_new(BIO_s_mem()), BIO_free_all);
  if (!result || BIO_write(result.get(), content.data(), static_cast<int>(content.size())) !=
                     static_cast<int>(content.size()))
    throw std::invalid_argument("cannot read " + path + ": OpenSSL is out of memory");
  return result;
}

}  // namespace sidestep
