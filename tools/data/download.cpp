#include "tools/data/download.h"

#include <curl/curl.h>
#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "engine/types/error.h"
#include "tools/data/sha256.h"

namespace surefield {

namespace {

constexpr long kConnectSeconds = 30;
constexpr long kSlowestBytes = 1000;  // a second, over kSlowSeconds; slower is taken for a dead connection
constexpr long kSlowSeconds = 60;
constexpr long kMostRedirects = 10;
constexpr long kOk = 200, kPartial = 206, kRangeNotSatisfiable = 416;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct CleanUp {
  void operator()(CURL* curl) const { curl_easy_cleanup(curl); }
};

/// One attempt to get the rest of a file.
class Transfer {
 public:
  Transfer(const DownloadRequest& request, const std::filesystem::path& part,
           const TransferProgress& progress)
      : request_(request), part_(part), progress_(progress), curl_(curl_easy_init()) {
    if (!curl_) throw InputError("libcurl cannot be started");
    std::error_code error;
    start_ = std::filesystem::exists(part_) ? std::filesystem::file_size(part_, error) : 0;
    file_.reset(std::fopen(part_.c_str(), "ab"));
    if (!file_) throw InputError(part_, "cannot be written; check the permissions of its folder");
    set_options();
  }

  CURLcode run() {
    const CURLcode result = curl_easy_perform(curl_.get());
    if (std::fflush(file_.get()) != 0) disk_failed_ = true;
    return result;
  }

  long status() const {
    long status = 0;
    curl_easy_getinfo(curl_.get(), CURLINFO_RESPONSE_CODE, &status);
    return status;
  }

  bool disk_failed() const { return disk_failed_; }
  bool too_large() const { return too_large_; }
  bool stopped() const { return stopped_; }
  /// Bytes that this attempt brought.
  uint64_t received() const { return received_; }
  uint64_t start() const { return start_; }

 private:
  void set_options() {
    CURL* curl = curl_.get();
    curl_easy_setopt(curl, CURLOPT_URL, request_.url.c_str());
    curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
    // No step down: what starts encrypted stays so.
    const bool secure = request_.url.starts_with("https:");
    curl_easy_setopt(curl, CURLOPT_REDIR_PROTOCOLS_STR, secure ? "https" : "http,https");
    curl_easy_setopt(curl, CURLOPT_MAXREDIRS, kMostRedirects);
    curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 1L);
    curl_easy_setopt(curl, CURLOPT_FAILONERROR, 1L);
    curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(curl, CURLOPT_USERAGENT, "surefield");
    curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT, kConnectSeconds);
    curl_easy_setopt(curl, CURLOPT_LOW_SPEED_LIMIT, kSlowestBytes);
    curl_easy_setopt(curl, CURLOPT_LOW_SPEED_TIME, kSlowSeconds);
    curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, &Transfer::on_data);
    curl_easy_setopt(curl, CURLOPT_WRITEDATA, this);
    curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, &Transfer::on_progress);
    curl_easy_setopt(curl, CURLOPT_XFERINFODATA, this);
    curl_easy_setopt(curl, CURLOPT_NOPROGRESS, 0L);
    // Not CURLOPT_RESUME_FROM: a server without ranges would be an error instead of a download from the
    // start.
    if (start_ > 0) curl_easy_setopt(curl, CURLOPT_RANGE, fmt::format("{}-", start_).c_str());
  }

  static std::size_t on_data(char* bytes, std::size_t, std::size_t count, void* self) {
    return static_cast<Transfer*>(self)->store(bytes, count);
  }

  static int on_progress(void* self, curl_off_t total, curl_off_t now, curl_off_t, curl_off_t) {
    auto* transfer = static_cast<Transfer*>(self);
    const auto start = transfer->start_;
    const auto whole = total > 0 ? start + static_cast<uint64_t>(total) : 0;
    if (total > 0 && !transfer->fits(static_cast<uint64_t>(total))) return 1;
    const bool go_on = !transfer->progress_ || transfer->progress_(start + static_cast<uint64_t>(now), whole);
    if (!go_on) transfer->stopped_ = true;
    return go_on ? 0 : 1;
  }

  /// Whether there is room for what comes; asked once, with the bytes of this attempt.
  bool fits(uint64_t coming) {
    if (asked_) return true;
    asked_ = true;
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(part_.parent_path(), error);
    too_large_ = !error && coming > space.available;
    return !too_large_;
  }

  std::size_t store(const char* bytes, std::size_t count) {
    if (received_ == 0 && start_ > 0 && status() == kOk) {
      // The server sends everything again.
      file_.reset(std::freopen(part_.c_str(), "wb", file_.release()));
      start_ = 0;
    }
    const std::size_t written = file_ ? std::fwrite(bytes, 1, count, file_.get()) : 0;
    if (written != count) disk_failed_ = true;
    received_ += written;
    return written;
  }

  const DownloadRequest& request_;
  const std::filesystem::path& part_;
  const TransferProgress& progress_;
  std::unique_ptr<CURL, CleanUp> curl_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  uint64_t start_ = 0;
  uint64_t received_ = 0;
  bool disk_failed_ = false;
  bool asked_ = false;
  bool too_large_ = false;
  bool stopped_ = false;
};

/// How an attempt ended that did not fail for good.
enum class Attempt { Complete, Stopped, Cut, Restart };

Attempt attempt(const DownloadRequest& request, const std::filesystem::path& part,
                const TransferProgress& progress) {
  Transfer transfer(request, part, progress);
  const CURLcode result = transfer.run();
  if (transfer.stopped()) return Attempt::Stopped;
  if (transfer.too_large())
    throw InputError(part, "the disk has no room for what is to come; free some first");
  if (transfer.disk_failed()) throw InputError(part, "cannot be written; is the disk full?");
  if (result == CURLE_OK) return Attempt::Complete;
  if (result == CURLE_HTTP_RETURNED_ERROR) {
    if (transfer.status() == kRangeNotSatisfiable && transfer.start() > 0) return Attempt::Restart;
    throw InputError(fmt::format("{}: the server answers {}; the address may have changed", request.url,
                                 transfer.status()));
  }
  const bool was_connected = transfer.status() == kOk || transfer.status() == kPartial;
  if (!was_connected) {
    throw InputError(fmt::format("{}: {}; check the connection", request.url, curl_easy_strerror(result)));
  }
  return Attempt::Cut;
}

void finish(const DownloadRequest& request, const std::filesystem::path& part) {
  std::error_code error;
  if (!request.sha256.empty()) {
    const std::string found = sha256_of_file(part);
    if (found != request.sha256) {
      std::filesystem::remove(part, error);
      throw InputError(
          fmt::format("{}: the checksum is {}, not {}; what was downloaded is removed, try again",
                      request.url, found, request.sha256));
    }
  }
  std::filesystem::rename(part, request.file, error);
  if (error) throw InputError(request.file, "cannot be written: " + error.message());
}

}  // namespace

bool download(const DownloadRequest& request, const TransferProgress& progress) {
  if (std::filesystem::exists(request.file)) return true;
  curl_global_init(CURL_GLOBAL_DEFAULT);
  const std::filesystem::path part = request.file.string() + ".part";
  for (int cuts = 0; cuts <= request.retries;) {
    switch (attempt(request, part, progress)) {
      case Attempt::Complete:
        finish(request, part);
        return true;
      case Attempt::Stopped:
        return false;
      case Attempt::Cut:
        ++cuts;
        break;
      case Attempt::Restart:
        std::filesystem::remove(part);
        ++cuts;
    }
  }
  throw InputError(
      fmt::format("{}: the connection was cut again and again; run the same command later, it goes "
                  "on where it ended",
                  request.url));
}

}  // namespace surefield
