#include "tar_writer.hpp"

#include <exception>

#include <archive.h>
#include <archive_entry.h>

namespace generator {

struct tar_writer::state {
    std::function<void(std::string_view)> write;
    std::exception_ptr failed;  ///< thrown by `write`, carried past libarchive's C code
    archive* tar = archive_write_new();
    archive_entry* entry = archive_entry_new();

    ~state() {
        archive_entry_free(entry);
        archive_write_free(tar);
    }
    void check(bool done) {
        if (failed) std::rethrow_exception(failed);
        if (!done) throw insonify::io_error(std::string("can't write a tar: ") + archive_error_string(tar));
    }
};

tar_writer::tar_writer(std::function<void(std::string_view)> write) : state_(std::make_shared<state>()) {
    state& s = *state_;
    s.write = std::move(write);
    if (s.tar == nullptr || s.entry == nullptr) throw std::bad_alloc();
    const auto pass = [](archive*, void* to, const void* bytes, std::size_t size) -> la_ssize_t {
        auto& self = *static_cast<state*>(to);
        try {
            self.write({static_cast<const char*>(bytes), size});
        } catch (...) {
            self.failed = std::current_exception();
            return ARCHIVE_FATAL;
        }
        return static_cast<la_ssize_t>(size);
    };
    s.check(archive_write_set_format_ustar(s.tar) == ARCHIVE_OK && archive_write_set_bytes_per_block(s.tar, 0) == 0 &&
            archive_write_open(s.tar, &s, nullptr, pass, nullptr) == ARCHIVE_OK);
}

void tar_writer::add(const std::string& name, std::string_view bytes) {
    state& s = *state_;
    archive_entry_clear(s.entry);
    archive_entry_set_pathname(s.entry, name.c_str());
    archive_entry_set_size(s.entry, static_cast<la_int64_t>(bytes.size()));
    archive_entry_set_filetype(s.entry, AE_IFREG);
    archive_entry_set_perm(s.entry, 0644);
    archive_entry_set_mtime(s.entry, 0, 0);
    s.check(archive_write_header(s.tar, s.entry) == ARCHIVE_OK);
    s.check(archive_write_data(s.tar, bytes.data(), bytes.size()) == static_cast<la_ssize_t>(bytes.size()));
    s.check(archive_write_finish_entry(s.tar) == ARCHIVE_OK);
}

void tar_writer::close() {
    state_->check(archive_write_close(state_->tar) == ARCHIVE_OK);
}

}  // namespace generator
