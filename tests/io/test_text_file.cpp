#include "engine/io/text_file.h"

#include <cmath>

#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

std::vector<std::string> texts(const std::vector<TextLine>& lines) {
  std::vector<std::string> list;
  for (const TextLine& line : lines) list.push_back(line.text);
  return list;
}

}  // namespace

TEST_CASE("lines end as on any system, and a byte order mark is passed over") {
  const TemporaryFolder folder;
  const std::vector<std::string> expected = {"1 a", "2 b"};
  for (const char* content : {"1 a\n2 b\n", "1 a\r\n\r\n2 b\r\n", "1 a\r2 b\r",
                              "\xef\xbb\xbf# title\n1 a\n2 b", "  1 a \t\n# note\n\t2 b  "}) {
    CAPTURE(content);
    CHECK(texts(read_lines(folder.write("list.txt", content))) == expected);
  }
  const auto numbered = read_lines(folder.write("list.txt", "\r\n1 a\r\n\r\n2 b"));
  REQUIRE(numbered.size() == 2);
  CHECK(numbered[0].number == 2);
  CHECK(numbered[1].number == 4);
  CHECK(read_lines(folder.write("list.txt", "")).empty());
}

TEST_CASE("what is no text is named") {
  const TemporaryFolder folder;
  CHECK(contains(input_error([&] {
                   read_lines(folder.write("a.txt",
                                           "\xff\xfe"
                                           "1"));
                 }),
                 "a.txt: is UTF-16 text"));
  CHECK(contains(input_error([&] { read_lines(folder.write("a.txt", std::string("1\0 2", 4))); }),
                 "a.txt: is no text file"));
  CHECK(contains(input_error([&] { read_lines(folder.path()); }), "is a folder, not a file"));
  std::filesystem::create_symlink("loop", folder / "loop");
  CHECK(contains(input_error([&] { read_lines(folder / "loop"); }), "loop: cannot be opened: "));
}

TEST_CASE("a header row is passed over, a wrong first row is not") {
  const TemporaryFolder folder;
  CHECK(texts(read_rows(folder.write("l.txt", "timestamp filename\n1 a\n"))) ==
        std::vector<std::string>{"1 a"});
  CHECK(texts(read_rows(folder.write("l.txt", "\"time [s]\",file\n1,a\n"))).size() == 1);
  CHECK(texts(read_rows(folder.write("l.txt", "1.0x a\n2 b\n"))).size() == 2);
  CHECK(texts(read_rows(folder.write("l.txt", "name a\nname b\n"))).size() == 2);
  CHECK(texts(read_rows(folder.write("l.txt", "nan a\n2 b\n"))).size() == 2);
}

TEST_CASE("numbers: signs, separators, what is none") {
  CHECK(parse_number("+1.5") == 1.5);
  CHECK(parse_number("-1e-3") == -1e-3);
  CHECK(std::isinf(*parse_number("+inf")));
  CHECK(std::isnan(*parse_number("nan")));
  for (const char* text : {"", "+", "++1", "+-1", "1,5", "1.0x", "0x10", "one"})
    CHECK_FALSE(parse_number(text));
  CHECK(parse_numbers("1, 2;3\t+4 ,5,") == std::vector<double>{1, 2, 3, 4, 5});
  CHECK(parse_numbers(" ") == std::vector<double>{});
  CHECK_FALSE(parse_numbers("1 two"));
}

TEST_CASE("fields are separated like numbers, and quotes keep blanks") {
  CHECK(split_fields("1.5 rgb/1.png") == std::vector<std::string>{"1.5", "rgb/1.png"});
  CHECK(split_fields("1.5,rgb/1.png") == std::vector<std::string>{"1.5", "rgb/1.png"});
  CHECK(split_fields("1 \"my rgb/1.png\" ;2") == std::vector<std::string>{"1", "my rgb/1.png", "2"});
  CHECK(split_fields("\"open").size() == 1);
  CHECK(split_fields("").empty());
}

TEST_CASE("UTF-8 is told from what is none") {
  for (const char* text : {"", "a", "\xc3\xa4", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xf4\x8f\xbf\xbf"})
    CHECK(is_utf8(text));
  for (const char* text : {"\xe4", "\xc3", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                           "\xf8\x88\x80\x80\x80", "a\x80"})
    CHECK_FALSE(is_utf8(text));
}

TEST_CASE("the unit of a stamp follows from its size") {
  CHECK(stamp_unit(0) == 1);
  CHECK(stamp_unit(1305031102.175) == 1);
  CHECK(stamp_unit(1305031102175.0) == 1e-3);
  CHECK(stamp_unit(1305031102175304.0) == 1e-6);
  CHECK(stamp_unit(1403636579763555584.0) == 1e-9);
}
