#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace surefield {

/// Whether there is anything under that path, or a folder; false also where nobody can tell, as behind a loop
/// of links.
bool file_exists(const std::filesystem::path& path);
bool folder_exists(const std::filesystem::path& path);

/// What a folder holds, in natural order (natural_less); nothing where there is no such folder. Throws
/// InputError where it cannot be read.
std::vector<std::filesystem::path> list_folder(const std::filesystem::path& folder);

/// The whole content of a file. Throws InputError when it is missing or cannot be read.
std::string read_file(const std::filesystem::path& file);

/// The same of a file of a recording, which must be one on a disk: whoever opens a pipe waits until somebody
/// writes to it.
std::string read_regular_file(const std::filesystem::path& file);

/// Writes a file through `write` so that it appears complete or not at all. Throws InputError when the folder
/// is missing, the disk is full, or the file cannot be written for another reason.
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);

/// Has the disk hold what a file or a folder's list holds now, so that no power cut undoes it. Where the file
/// system cannot, nothing is done.
void sync_to_disk(const std::filesystem::path& path);

}  // namespace surefield
