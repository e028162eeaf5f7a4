#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace surefield {

/// The id of a run and what its files hold, for metrics.json: "id", and under "files" the bytes and the
/// CRC-32 of each file of results that is in the folder, metrics.json and log.txt apart.
nlohmann::ordered_json run_files_json(const std::filesystem::path& folder, const std::string& run_id);

/// Throws InputError where a file in the folder is not the one that the run of `metrics` wrote: results of
/// two runs are mixed, or one was changed. Says nothing of files that are not there, of a run that says
/// nothing of its files, or of one that is still running, whose files change.
void check_run_files(const nlohmann::json& metrics, const std::filesystem::path& folder);

}  // namespace surefield
