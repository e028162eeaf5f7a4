// surefield fetch: downloads public sequences from their official addresses.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "engine/types/error.h"
#include "tools/data/public_datasets.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress_line.h"

namespace surefield {

namespace {

constexpr const char* kFetchExamples =
    "The terms of the dataset are printed first; who downloads accepts them. Ctrl-C ends the download, and "
    "the\n"
    "same command goes on with it.\n"
    "\n"
    "Examples:\n"
    "  surefield fetch --list\n"
    "  surefield fetch fr1/desk --out data\n"
    "  surefield run --dataset data/rgbd_dataset_freiburg1_desk --out out/desk\n";

constexpr double kBytesPerMegabyte = 1e6;

struct FetchOptions {
  std::string name;
  std::string out = ".";
  bool list = false;
};

int list_datasets() {
  for (const PublicDataset& dataset : public_datasets()) fmt::print("{:<40} {}\n", dataset.name, dataset.url);
  fmt::print("{:<40} {}\n", "scannet", "says how to get it: a form must be signed");
  return kSuccess;
}

int fetch(const FetchOptions& options) {
  if (options.list) return list_datasets();
  if (options.name.empty()) throw InputError("give the name of a dataset; see surefield fetch --list");
  catch_interrupts();
  const PublicDataset& dataset = find_public_dataset(options.name);
  fmt::print("terms    {}\nfrom     {}\nchecksum {}\n", dataset.terms, dataset.url,
             dataset.sha256.empty() ? "none is published" : "SHA-256 " + dataset.sha256);
  const std::filesystem::path part = archive_of(dataset, options.out).string() + ".part";
  std::error_code error;
  if (const auto kept = std::filesystem::file_size(part, error); !error)
    fmt::print("kept     {:.0f} MB of an earlier download, which goes on there\n",
               static_cast<double>(kept) / kBytesPerMegabyte);
  std::fflush(stdout);
  Fetched result;
  {
    ProgressLine line(dataset.name);
    result = fetch_dataset(dataset, options.out, [&](const std::string& step, uint64_t done, uint64_t total) {
      const double fraction = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : -1;
      line.show(fraction,
                fmt::format("{} {:.0f} of {} MB", step, static_cast<double>(done) / kBytesPerMegabyte,
                            total > 0 ? fmt::format("{:.0f}", static_cast<double>(total) / kBytesPerMegabyte)
                                      : std::string("?")));
      return !interrupted();
    });
  }
  const std::filesystem::path folder = std::filesystem::path(options.out) / dataset.folder;
  if (result == Fetched::Stopped) {
    fmt::print(stderr, "surefield: stopped; what has arrived is kept, the same command goes on with it\n");
    return kInterrupted;
  }
  fmt::print("{}   {}\n", result == Fetched::AlreadyThere ? "present" : "ready  ", folder.string());
  return kSuccess;
}

}  // namespace

void add_fetch(CLI::App& program, Action& action) {
  auto options = std::make_shared<FetchOptions>();
  CLI::App* command = program.add_subcommand("fetch", "Downloads a public sequence");
  command->add_option("name", options->name, "Name of the dataset, see --list");
  command->add_option("--out", options->out, "Folder to put it in")->capture_default_str();
  command->add_flag("--list", options->list, "Lists what can be fetched");
  command->footer(kFetchExamples);
  command->callback([options, &action] { action = [options] { return fetch(*options); }; });
}

}  // namespace surefield
