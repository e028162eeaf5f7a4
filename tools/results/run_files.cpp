#include "tools/results/run_files.h"

#include <fmt/format.h>
#include <zlib.h>

#include "engine/io/files.h"
#include "engine/session/results_folder.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

nlohmann::ordered_json describe_file(const std::filesystem::path& file) {
  const std::string content = read_file(file);
  const uLong sum =
      crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(content.data()), content.size());
  return {{"bytes", content.size()}, {"crc32", fmt::format("{:08x}", sum)}};
}

bool is_listed(const std::string& name) {
  return is_result_name(name) && name != "metrics.json" && name != "log.txt" && !name.starts_with('.') &&
         !name.ends_with(".part");
}

}  // namespace

nlohmann::ordered_json run_files_json(const std::filesystem::path& folder, const std::string& run_id) {
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  for (const std::filesystem::path& file : list_folder(folder)) {
    const std::string name = file.filename().string();
    if (is_listed(name)) files[name] = describe_file(file);
  }
  return {{"id", run_id}, {"files", files}};
}

void check_run_files(const nlohmann::json& metrics, const std::filesystem::path& folder) {
  if (!metrics.contains("run") || metrics.value("status", "") == "running") return;
  const nlohmann::json files = metrics["run"].value("files", nlohmann::json::object());
  for (const std::filesystem::path& file : list_folder(folder)) {
    const std::string name = file.filename().string();
    if (!is_listed(name)) continue;
    if (!files.contains(name)) {
      throw InputError(
          file, fmt::format("is not of run {}, whose metrics.json lies beside it: results of two runs are "
                            "mixed here",
                            metrics["run"].value("id", "?")));
    }
    if (nlohmann::json(describe_file(file)) == files[name]) continue;
    throw InputError(
        file, fmt::format("is not as run {} wrote it, whose metrics.json lies beside it: results of two runs "
                          "are mixed, or the file was changed",
                          metrics["run"].value("id", "?")));
  }
}

}  // namespace surefield
