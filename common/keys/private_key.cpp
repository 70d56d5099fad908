// SPDX-License-Identifier: Apache-2.0
#include "common/keys/private_key.hpp"

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <stdexcept>

#include "common/keys/key_file.hpp"

namespace sidestep {

PrivateKey load_private_key(const std::string& path) {
  const auto file = open_key_file(path);
  PrivateKey key(PEM_read_bio_PrivateKey(file.get(), nullptr, nullptr, nullptr), EVP_PKEY_free);
  if (!key) throw std::invalid_argument(path + ": expected a private key (PEM) without a passphrase");
  return key;
}

std::vector<std::uint8_t> sign(const PrivateKey& key, std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  std::vector<std::uint8_t> result(static_cast<std::size_t>(EVP_PKEY_get_size(key.get())));
  std::size_t size = result.size();
  if (!context || EVP_DigestSignInit(context.get(), nullptr, EVP_sha256(), nullptr, key.get()) != 1 ||
      EVP_DigestSign(context.get(), result.data(), &size, bytes.data(), bytes.size()) != 1)
    throw std::runtime_error("OpenSSL cannot sign with this private key");
  result.resize(size);
  return result;
}

}  // namespace sidestep
