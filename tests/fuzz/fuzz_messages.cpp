// Messages of all types that are read: the first byte says how they are serialised.
#include <string_view>

#include "engine/logs/messages.h"
#include "engine/sources/log_images.h"
#include "tests/fuzz/harness.h"

using namespace surefield;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const SerialisedMessage message{bytes, data[0] % 2 == 0 ? Serialisation::Cdr : Serialisation::Ros1,
                                  "message"};
  fuzz::expect_answer([&] {
    const ImageMessage image = read_image(message);
    fuzz::expect_answer([&] { colour_of(image, "message"); });
    fuzz::expect_answer([&] { depth_of(image, 0.001, "message"); });
  });
  fuzz::expect_answer([&] {
    const CompressedImageMessage image = read_compressed_image(message);
    pixels_of(image);
    size_of_encoded(image);
    fuzz::expect_answer([&] { colour_of(image, "message"); });
    fuzz::expect_answer([&] { depth_of(image, 0.001, "message"); });
  });
  fuzz::expect_answer([&] { read_camera_info(message); });
  fuzz::expect_answer([&] { read_transforms(message); });
  fuzz::expect_answer([&] { read_odometry(message); });
  fuzz::expect_answer([&] { read_extrinsics(message); });
  return 0;
}
