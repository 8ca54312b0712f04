#include "checksum.hpp"

#include <new>

#include <openssl/evp.h>

namespace generator {

sha256_sum::sha256_sum()
    : context_(EVP_MD_CTX_new(), [](void* context) { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(context)); }) {
    if (!context_ || EVP_DigestInit_ex(static_cast<EVP_MD_CTX*>(context_.get()), EVP_sha256(), nullptr) != 1)
        throw std::bad_alloc();
}

void sha256_sum::add(std::string_view bytes) {
    EVP_DigestUpdate(static_cast<EVP_MD_CTX*>(context_.get()), bytes.data(), bytes.size());
}

std::string sha256_sum::digits() {
    unsigned char sum[EVP_MAX_MD_SIZE];
    unsigned size = 0;
    EVP_DigestFinal_ex(static_cast<EVP_MD_CTX*>(context_.get()), sum, &size);
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
        text += "0123456789abcdef"[sum[i] >> 4];
        text += "0123456789abcdef"[sum[i] & 15];
    }
    return text;
}

std::string sha256(std::string_view bytes) {
    sha256_sum sum;
    sum.add(bytes);
    return sum.digits();
}

}  // namespace generator
