// Downloads from a server on this machine, and what comes out of the archives.
#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <map>

#include "engine/io/files.h"
#include "tests/tools/support.h"
#include "tests/tools/test_server.h"
#include "tools/data/public_datasets.h"
#include "tools/data/sha256.h"
#include "tools/data/unpack.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// Some bytes that are not alike.
std::string noise(std::size_t size) {
  std::string bytes;
  uint32_t state = 1;
  for (std::size_t i = 0; i < size; ++i) {
    state = state * 1664525u + 1013904223u;
    bytes.push_back(static_cast<char>(state >> 24));
  }
  return bytes;
}

std::string sha256(const std::string& bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.hex();
}

/// An archive of text files.
std::string pack(const std::map<std::string, std::string>& files, bool zip) {
  const TemporaryFolder folder;
  const std::string file = folder / "archive";
  archive* writer = archive_write_new();
  if (zip) {
    archive_write_set_format_zip(writer);
  } else {
    archive_write_add_filter_gzip(writer);
    archive_write_set_format_pax_restricted(writer);
  }
  archive_write_open_filename(writer, file.c_str());
  for (const auto& [name, text] : files) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(text.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    archive_write_header(writer, entry);
    archive_write_data(writer, text.data(), text.size());
    archive_entry_free(entry);
  }
  archive_write_close(writer);
  archive_write_free(writer);
  return read_file(file);
}

/// A tar with one entry that is no file of text: its type, and where it links to.
std::string pack_special(const std::string& name, unsigned type, const std::string& target = "",
                         bool hard = false) {
  const TemporaryFolder folder;
  const std::string file = folder / "archive";
  archive* writer = archive_write_new();
  archive_write_set_format_pax_restricted(writer);
  archive_write_open_filename(writer, file.c_str());
  archive_entry* entry = archive_entry_new();
  archive_entry_set_pathname(entry, name.c_str());
  archive_entry_set_filetype(entry, static_cast<__LA_MODE_T>(type));
  archive_entry_set_perm(entry, 0644);
  if (hard) {
    archive_entry_set_hardlink(entry, target.c_str());
  } else if (!target.empty()) {
    archive_entry_set_symlink(entry, target.c_str());
  }
  archive_write_header(writer, entry);
  archive_entry_free(entry);
  archive_write_close(writer);
  archive_write_free(writer);
  return read_file(file);
}

const TransferProgress kNoProgress;

}  // namespace

TEST_CASE("SHA-256 gives the digests of the standard's examples") {
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST_CASE("a file is downloaded whole, and not again") {
  const TestServer server({.body = noise(300000)});
  const TemporaryFolder folder;
  uint64_t most = 0;
  const DownloadRequest request{server.url("a.zip"), folder / "a.zip", sha256(noise(300000))};
  CHECK(download(request, [&](uint64_t done, uint64_t) {
    most = std::max(most, done);
    return true;
  }));
  CHECK(read_file(folder / "a.zip") == noise(300000));
  CHECK(most == 300000);
  CHECK_FALSE(std::filesystem::exists(folder / "a.zip.part"));
  CHECK(download(request, kNoProgress));
  CHECK(server.ranges().size() == 1);
}

TEST_CASE("a cut connection is taken up where it ended, also by a later call") {
  const std::string body = noise(300000);
  const TestServer server({.body = body, .cuts = 3, .cut_after = 70000});
  const TemporaryFolder folder;
  DownloadRequest request{server.url("a.zip"), folder / "a.zip", sha256(body), 1};
  CHECK(contains(input_error([&] { download(request, kNoProgress); }), "was cut again and again"));
  CHECK(std::filesystem::file_size(folder / "a.zip.part") == 140000);
  CHECK(download(request, kNoProgress));
  CHECK(read_file(folder / "a.zip") == body);
  CHECK(server.ranges() == std::vector<std::string>{"", "bytes=70000-", "bytes=140000-", "bytes=210000-"});
}

TEST_CASE("a server without ranges sends everything again") {
  const std::string body = noise(200000);
  const TestServer server({.body = body, .ranges = false, .cuts = 1, .cut_after = 70000});
  const TemporaryFolder folder;
  CHECK(download({server.url("a.zip"), folder / "a.zip", sha256(body)}, kNoProgress));
  CHECK(read_file(folder / "a.zip") == body);
  CHECK(server.ranges().size() == 2);
}

TEST_CASE("a rest that the server does not have starts the download anew") {
  const std::string body = noise(1000);
  const TestServer server({.body = body});
  const TemporaryFolder folder;
  folder.write("a.zip.part", noise(5000));
  CHECK(download({server.url("a.zip"), folder / "a.zip", sha256(body)}, kNoProgress));
  CHECK(read_file(folder / "a.zip") == body);
}

TEST_CASE("a wrong checksum removes what came; a missing file, a dead server and a full folder are named") {
  const TemporaryFolder folder;
  const TestServer server({.body = noise(1000)});
  const auto error = [&](const DownloadRequest& request) {
    return input_error([&] { download(request, kNoProgress); });
  };
  CHECK(contains(error({server.url("a.zip"), folder / "a.zip", sha256("other")}), "the checksum is"));
  CHECK(std::filesystem::is_empty(folder.path()));
  const TestServer missing({.body = "x", .status = 404});
  CHECK(contains(error({missing.url("b.zip"), folder / "b.zip"}), "b.zip: the server answers 404"));
  std::string gone;
  {
    const TestServer stopped({.body = "x"});
    gone = stopped.url("c.zip");
  }
  CHECK(contains(error({gone, folder / "c.zip"}), "check the connection"));
  CHECK(contains(error({server.url("d.zip"), folder / "no/such/d.zip"}), "cannot be written"));
  CHECK(contains(error({"ftp://127.0.0.1/a", folder / "e"}), "ftp://127.0.0.1/a"));
}

TEST_CASE("a download that is stopped keeps what it has") {
  const std::string body = noise(3000000);
  const TestServer server({.body = body});
  const TemporaryFolder folder;
  const DownloadRequest request{server.url("a.zip"), folder / "a.zip", sha256(body)};
  CHECK_FALSE(download(request, [](uint64_t done, uint64_t) { return done < 100000; }));
  CHECK_FALSE(std::filesystem::exists(folder / "a.zip"));
  CHECK(download(request, kNoProgress));
  CHECK(read_file(folder / "a.zip") == body);
}

TEST_CASE("a dataset appears in its folder, with the archives inside unpacked, and the archive is gone") {
  const std::string inner = pack({{"seq-01/frame.txt", "inner"}}, true);
  const std::string body = pack({{"chess/readme.txt", "outer"}, {"chess/seq-01.zip", inner}}, true);
  const TestServer server({.body = body});
  const TemporaryFolder folder;
  const PublicDataset dataset{"7scenes/chess", server.url("chess.zip"), "chess", "terms", ""};
  const FetchProgress go_on = [](const std::string&, uint64_t, uint64_t) { return true; };
  CHECK(fetch_dataset(dataset, folder / "data", go_on) == Fetched::Complete);
  CHECK(read_file(folder / "data/chess/readme.txt") == "outer");
  CHECK(read_file(folder / "data/chess/seq-01/frame.txt") == "inner");
  CHECK_FALSE(std::filesystem::exists(folder / "data/chess/seq-01.zip"));
  CHECK_FALSE(std::filesystem::exists(folder / "data/chess.zip"));
  CHECK_FALSE(std::filesystem::exists(folder / "data/chess.unpacking"));
  CHECK(fetch_dataset(dataset, folder / "data", go_on) == Fetched::AlreadyThere);
}

TEST_CASE("archives are unpacked; damaged ones, and entries that lead out of the folder, are refused") {
  const TemporaryFolder folder;
  const auto good = folder.write("good.tgz", pack({{"a/b.txt", "text"}}, false));
  CHECK(unpack(good, folder / "good", kNoProgress));
  CHECK(read_file(folder / "good/a/b.txt") == "text");
  const std::string bytes = pack({{"a.txt", noise(50000)}}, false);
  const auto cut = folder.write("cut.tgz", bytes.substr(0, bytes.size() / 2));
  CHECK(contains(input_error([&] { unpack(cut, folder / "cut", kNoProgress); }), "cut.tgz: is "));
  const auto evil = folder.write("evil.tgz", pack({{"../../evil.txt", "x"}}, false));
  CHECK_FALSE(input_error([&] { unpack(evil, folder / "x/y", kNoProgress); }).empty());
  CHECK_FALSE(std::filesystem::exists(folder / "evil.txt"));
  const auto none = folder.write("none.zip", "no archive");
  CHECK(contains(input_error([&] { unpack(none, folder / "none", kNoProgress); }), "none.zip"));
}

TEST_CASE("links that lead out of the folder, pipes and devices are not made") {
  const TemporaryFolder folder;
  int count = 0;
  const auto error = [&](const std::string& bytes) {
    const std::string name = fmt::format("a{}", ++count);
    const auto file = folder.write(name + ".tar", bytes);
    const std::string message = input_error([&] { unpack(file, folder / name, kNoProgress); });
    if (!message.empty()) CHECK(std::filesystem::is_empty(folder / name));
    return message;
  };
  CHECK(
      contains(error(pack_special("x", AE_IFLNK, "/etc/passwd")), "holds x, which leads out of its folder"));
  CHECK(contains(error(pack_special("d/x", AE_IFLNK, "../../y")), "leads out of its folder"));
  CHECK(contains(error(pack_special("d/x", AE_IFLNK, "z/../../../y")), "leads out of its folder"));
  CHECK(contains(error(pack_special("x", AE_IFREG, "../a.tar", true)), "leads out of its folder"));
  CHECK(contains(error(pack_special("x", AE_IFREG, "/etc/passwd", true)), "leads out of its folder"));
  CHECK(contains(error(pack_special("x", AE_IFIFO)), "holds x, a pipe or a device"));
  CHECK(contains(error(pack_special("x", AE_IFCHR)), "a pipe or a device"));
  CHECK(error(pack_special("d/x", AE_IFLNK, "../y")).empty());
  CHECK(std::filesystem::read_symlink(folder / "a8/d/x") == "../y");
}

TEST_CASE("the folder to unpack into may lie behind dots and links") {
  const TemporaryFolder folder;
  const auto file = folder.write("good.zip", pack({{"a/b.txt", "text"}}, true));
  std::filesystem::create_directories(folder / "work");
  CHECK(unpack(file, folder / "work/../data", kNoProgress));
  CHECK(read_file(folder / "data/a/b.txt") == "text");
  std::filesystem::create_directory_symlink(folder / "work", folder / "link");
  CHECK(unpack(file, folder / "link/data", kNoProgress));
  CHECK(read_file(folder / "work/data/a/b.txt") == "text");

  const TestServer server({.body = pack({{"chess/readme.txt", "outer"}}, true)});
  const PublicDataset dataset{"7scenes/chess", server.url("chess.zip"), "chess", "terms", ""};
  const FetchProgress go_on = [](const std::string&, uint64_t, uint64_t) { return true; };
  CHECK(fetch_dataset(dataset, folder / "work/../link/more", go_on) == Fetched::Complete);
  CHECK(read_file(folder / "work/more/chess/readme.txt") == "outer");
}

TEST_CASE("archives that grow beyond their bound are refused, and nothing is left of them") {
  const TemporaryFolder folder;
  const auto bomb = folder.write("bomb.zip", pack({{"zeros", std::string(3000000, '\0')}}, true));
  CHECK(contains(input_error([&] { unpack(bomb, folder / "a", kNoProgress, 1000000); }),
                 "unpacks to more than 1 MB"));
  std::map<std::string, std::string> many;
  for (int i = 0; i < 300; ++i) many[std::to_string(i)] = "";
  const auto empty = folder.write("empty.tgz", pack(many, false));
  CHECK(contains(input_error([&] { unpack(empty, folder / "b", kNoProgress, 1000000); }),
                 "unpacks to more than"));
  CHECK(unpack(bomb, folder / "c", kNoProgress));  // small enough for any disk

  const TestServer server({.body = pack({{"chess/zeros", std::string(80000000, '\0')}}, true)});
  const PublicDataset dataset{"7scenes/chess", server.url("chess.zip"), "chess", "terms", ""};
  const FetchProgress go_on = [](const std::string&, uint64_t, uint64_t) { return true; };
  CHECK(contains(input_error([&] { fetch_dataset(dataset, folder / "data", go_on); }),
                 "50 times its own size"));
  CHECK_FALSE(std::filesystem::exists(folder / "data/chess"));
  CHECK_FALSE(std::filesystem::exists(folder / "data/chess.unpacking"));
}

TEST_CASE("datasets come encrypted") {
  for (const PublicDataset& dataset : public_datasets()) {
    CAPTURE(dataset.name);
    CHECK(dataset.url.starts_with("https://"));
  }
}

TEST_CASE("fetch lists what there is, tells of ScanNet's form, and names similar datasets") {
  const TemporaryFolder folder;
  const Outcome list = surefield_command({"fetch", "--list"}, folder.path());
  CHECK(list.code == 0);
  CHECK(contains(list.out, "https://cvg.cit.tum.de/rgbd/dataset/freiburg1/rgbd_dataset_freiburg1_desk.tgz"));
  CHECK(contains(list.out, "https://cvg-data.inf.ethz.ch/nice-slam/data/Replica.zip"));
  const Outcome scannet = surefield_command({"fetch", "scannet"}, folder.path());
  CHECK(scannet.code == 2);
  CHECK(contains(scannet.err, "http://www.scan-net.org"));
  const Outcome typo = surefield_command({"fetch", "kitchen"}, folder.path());
  CHECK(typo.code == 2);
  CHECK(contains(typo.err, "is it one of 7scenes/redkitchen?"));
  CHECK(surefield_command({"fetch"}, folder.path()).code == 2);
}
