// Writing into the folder of a data set: a file is there as a whole, or not at all.
//
// Bytes go to .partial/<unit>/ under a name that no other process uses, are brought to disk, and are renamed into
// place; then the folder is brought to disk, too. Processes that write the same file at the same time, without a lock,
// don't disturb one another: the last one to rename wins, and an image has the same bytes from all of them. A process
// that finds its files removed by another one that took them for leftovers writes them again.
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

/// Another process took a file in the making for a leftover: to be written again.
struct lost_file : insonify::io_error {
    explicit lost_file(const std::string& path)
        : io_error(path + ": another process removes it in the making; run the command again when that has ended") {}
};

/// A file in the making whose bytes come in pieces.
class staged_file {
  public:
    staged_file(std::string temporary, std::string path);
    staged_file(staged_file&& other) noexcept;
    staged_file& operator=(staged_file&&) = delete;
    ~staged_file();

    void write(std::string_view bytes);
    /// Passes all that was written to `visit`, in pieces.
    void read_back(const std::function<void(std::string_view)>& visit);
    /// Brings the bytes to disk, and closes.
    void finish();
    /// Puts a finished file in its place. @returns false if another process removed the temporary file
    bool place();
    /// What `place_first` found.
    enum class outcome { placed, taken, lost };
    /// Puts a finished file in its place unless there is one.
    outcome place_first();

  private:
    std::string temporary_, path_;
    std::FILE* stream_;
};

class staging {
  public:
    /// @param unit  what works alone in its part of .partial/: its leftovers are removed
    staging(const std::filesystem::path& root, const std::string& unit);
    ~staging();
    staging(const staging&) = delete;
    staging& operator=(const staging&) = delete;

    /// Writes files in groups: all files of a group are on disk before the first of the next group is in place.
    /// @throws io_error, naming the file, if one can't be written
    void put(const std::vector<std::vector<file>>& groups);

    /// Writes a file unless there is one already. @returns whether it was written
    bool put_first(const file& f);

    /// A file to be written piece by piece, and to be given to `put`.
    staged_file open(const std::string& path);
    /// @throws lost_file
    void put(staged_file& f, const std::string& path);

    /// Calls `write` until it throws no `lost_file`.
    void until_kept(const std::function<void()>& write);

  private:
    void make_folder(const std::filesystem::path& folder);
    bool put_group(const std::vector<file>& group);
    void restore();  ///< folders that another process removed
    std::string temporary_name();

    std::filesystem::path root_, folder_;
    std::string process_;
    std::atomic<unsigned> count_ = 0;
    std::mutex mutex_;
    std::set<std::filesystem::path> folders_;  ///< that are known to be there
};

/// Brings the names in a folder to disk.
void sync_folder(const std::filesystem::path& folder);

}  // namespace generator
