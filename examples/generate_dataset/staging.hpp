// Atomic writes into the folder of a data set: readers see a whole file or none.
//
// A file is written to .partial/<unit>/ under a name unique to the process, synced, and renamed into place; then its
// folder is synced. Processes that write the same file concurrently without a lock are safe: the last rename wins, and
// all of them write the same bytes. A process whose temporary files were removed as leftovers writes them again.
#pragma once

#include <insonify/core/error.hpp>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "layout.hpp"

namespace generator {

/// Another process removed a temporary file as a leftover; the file must be written again.
struct lost_file : insonify::io_error {
    explicit lost_file(const std::string& path)
        : io_error(path +
                   ": another process keeps removing its temporary file; run the command again when that process has "
                   "ended") {}
};

/// A temporary file that is written in pieces.
class staged_file {
  public:
    staged_file(std::string temporary, std::string path);
    staged_file(staged_file&& other) noexcept;
    staged_file& operator=(staged_file&&) = delete;
    ~staged_file();

    void write(std::string_view bytes);
    /// Passes the bytes written so far to `visit`, in pieces.
    void read_back(const std::function<void(std::string_view)>& visit);
    /// Syncs and closes the file.
    void finish();
    /// Renames a finished file into place. @returns false if another process removed the temporary file
    bool place();
    enum class outcome { placed, exists, lost };
    /// Moves a finished file into place unless a file exists there.
    outcome place_if_absent();

  private:
    std::string temporary_, path_;
    std::FILE* stream_;
};

/// Writes files of a data set by way of .partial/<unit>/.
class staging {
  public:
    /// @param unit  name of the subfolder of .partial/, locked by the caller; leftovers in it are removed
    staging(const std::filesystem::path& root, const std::string& unit);
    ~staging();
    staging(const staging&) = delete;
    staging& operator=(const staging&) = delete;

    /// Writes groups of files: a group is synced before the first file of the next one appears.
    /// @throws io_error, naming the file, if one can't be written
    void put(const std::vector<std::vector<file>>& groups);

    /// Writes a file unless it exists. @returns whether it was written
    bool write_if_absent(const file& f);

    /// Opens a file to be written in pieces and passed to `put`.
    staged_file open(const std::string& path);
    /// @throws lost_file
    void put(staged_file& f, const std::string& path);

    /// Calls `write` again while it throws `lost_file`, at most 100 times.
    void retry_lost(const std::function<void()>& write);

  private:
    void make_folder(const std::filesystem::path& folder);
    bool put_group(const std::vector<file>& group);
    void restore();  ///< recreates folders that another process removed
    std::string temporary_name();

    std::filesystem::path root_, folder_;
    std::string process_;
    std::atomic<unsigned> count_ = 0;
    std::mutex mutex_;
    std::set<std::filesystem::path> folders_;  ///< known to exist
};

/// Syncs the directory entries of a folder.
void sync_folder(const std::filesystem::path& folder);

}  // namespace generator
