#include "finray/io/sha256.h"

#include <openssl/evp.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>

#include "finray/io/error.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

std::string Sha256Of(std::istream* stream,
                     const std::function<bool()>& stop = {}) {
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(
      EVP_MD_CTX_new(), EVP_MD_CTX_free);
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  char buffer[1 << 16];
  while (stream->read(buffer, sizeof buffer), stream->gcount() > 0) {
    if (stop && stop()) return "";
    EVP_DigestUpdate(context.get(), buffer,
                     static_cast<std::size_t>(stream->gcount()));
  }
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned size = 0;
  EVP_DigestFinal_ex(context.get(), digest, &size);
  std::string hex;
  for (unsigned i = 0; i < size; ++i) hex += FormatText("%02x", digest[i]);
  return hex;
}

}  // namespace

std::string Sha256OfFile(const std::string& path,
                         const std::function<bool()>& stop) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(path + ": cannot be read: " + std::strerror(errno));
  }
  return Sha256Of(&file, stop);
}

std::string Sha256OfText(const std::string& text) {
  std::istringstream stream(text);
  return Sha256Of(&stream);
}

}  // namespace finray
