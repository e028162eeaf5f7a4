#include <doctest/doctest.h>

#include <opencv2/imgcodecs.hpp>

#include "engine/report/html.h"
#include "tests/report/markup.h"

using namespace surefield;

namespace {

/// The bytes that base64 text stands for, by the plain definition.
std::vector<uchar> decode_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<uchar> bytes;
  uint32_t bits = 0;
  int count = 0;
  for (char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<uint32_t>(digits.find(c));
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<uchar>(bits >> count & 255));
    }
  }
  return bytes;
}

}  // namespace

TEST_CASE("text is escaped, and bytes that are no UTF-8 do no harm") {
  CHECK(escape_html("a<b> & \"c\" 'd'") == "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
  CHECK(escape_html("Räume, 夏, 🙂") == "Räume, 夏, 🙂");
  CHECK(escape_html("caf\xe9<") == "caf?&lt;");  // Latin-1
  CHECK(escape_html("\xc3") == "?");             // cut off
  CHECK(escape_html("\xc3<script>") == "?&lt;script&gt;");
}

TEST_CASE("images carry their pixels, shrunk to what is shown") {
  for (int width : {40, 41, 42}) {  // all three lengths of the last group of base64 come up
    cv::Mat image(30, width, CV_8UC3, cv::Scalar(200, 100, 50));
    image.colRange(0, width / 2) = cv::Scalar(0, 0, 255);
    const std::string html = html_image(image, "a \"view\"", 20);
    CHECK(html.starts_with("<img width=\"20\" height=\"" + std::to_string((30 * 20 + width / 2) / width) +
                           "\" alt=\"a &quot;view&quot;\""));
    const std::string marker = "base64,";
    const std::size_t start = html.find(marker) + marker.size();
    const cv::Mat decoded =
        cv::imdecode(decode_base64(html.substr(start, html.find('"', start) - start)), cv::IMREAD_COLOR);
    REQUIRE(decoded.cols == 20);
    // BGR: blue on the left, the other colour on the right, as JPEG keeps them.
    CHECK(cv::norm(decoded.at<cv::Vec3b>(7, 3), cv::Vec3b(255, 0, 0), cv::NORM_INF) < 12);
    CHECK(cv::norm(decoded.at<cv::Vec3b>(7, 17), cv::Vec3b(50, 100, 200), cv::NORM_INF) < 12);
  }
}
