#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/data/download.h"

namespace surefield {

/// A public dataset that can be downloaded without asking anyone.
struct PublicDataset {
  std::string name;    ///< as given to `surefield fetch`
  std::string url;     ///< of the archive, at its official address
  std::string folder;  ///< the archive's top folder
  std::string terms;   ///< one line: licence, and where it is
  std::string sha256;  ///< where one is published; else empty
};

/// All that are known, in the order in which they are listed.
const std::vector<PublicDataset>& public_datasets();

/// The dataset of a name. Throws InputError that names similar ones, and that says what to do for those that
/// need a signed form (ScanNet).
const PublicDataset& find_public_dataset(const std::string& name);

/// How far fetching is: the step, "downloading" or "unpacking", and its bytes.
using FetchProgress = std::function<bool(const std::string& step, uint64_t done, uint64_t total)>;

/// What fetch_dataset() did.
enum class Fetched { Complete, AlreadyThere, Stopped };

/// Where the archive of a dataset is kept until it is unpacked.
std::filesystem::path archive_of(const PublicDataset& dataset, const std::filesystem::path& out);

/// Downloads the archive into `out`, which is created, unpacks it there (archives inside it too) and removes
/// it. The folder appears when it is complete. Throws InputError as download() and unpack() do.
Fetched fetch_dataset(const PublicDataset& dataset, const std::filesystem::path& out,
                      const FetchProgress& progress);

}  // namespace surefield
