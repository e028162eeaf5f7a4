#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace surefield {

/// Asked now and then how far a transfer is, in bytes (`total` is 0 where unknown); it ends when false is
/// returned.
using TransferProgress = std::function<bool(uint64_t done, uint64_t total)>;

/// A file to be downloaded.
struct DownloadRequest {
  std::string url;             ///< http or https
  std::filesystem::path file;  ///< where it goes; its folder exists
  std::string sha256;          ///< expected digest, hexadecimal; empty where none is published
  int retries = 3;             ///< after a connection was cut, before giving up
};

/// Downloads a file, going on where an earlier attempt ended: what has arrived is kept in `file`.part, which
/// becomes `file` when it is complete and its digest is right. Does nothing where `file` exists. Returns
/// false when `progress` asked to stop. Throws InputError when the server does not have the file, cannot be
/// reached or keeps cutting the connection, when the digest is wrong (what arrived is removed), and when the
/// file cannot be written.
bool download(const DownloadRequest& request, const TransferProgress& progress);

}  // namespace surefield
