// Writes finished images in the background while their thread draws the next ones.
#pragma once

#include <future>
#include <system_error>

#include "staging.hpp"

namespace generator {

/// Collects images and writes them in batches: syncing many files at once is faster than one by one.
class writer {
  public:
    explicit writer(staging& into) : into_(into) {}

    /// @param files  files of an image; the record is the last one
    /// @throws io_error if an earlier image could not be written
    void add(std::vector<file> files) {
        for (const file& f : files) bytes_ += f.bytes.size();
        records_.push_back(std::move(files.back()));
        files.pop_back();
        for (file& f : files) files_.push_back(std::move(f));
        if (records_.size() >= 16 || bytes_ >= 4 << 20) flush();
    }

    /// Waits for the batch in flight, then writes the rest.
    void finish() {
        flush();
        if (written_.valid()) written_.get();
    }

  private:
    void flush() {
        if (written_.valid()) written_.get();
        if (records_.empty()) return;
        auto write = [&into = into_, groups = std::vector{std::move(files_), std::move(records_)}] {
            into.put(groups);
        };
        files_.clear(), records_.clear(), bytes_ = 0;
        try {
            written_ = std::async(std::launch::async, write);
        } catch (const std::system_error&) {  // no thread available
            write();
        }
    }

    staging& into_;
    std::vector<file> files_, records_;
    std::size_t bytes_ = 0;
    std::future<void> written_;
};

}  // namespace generator
