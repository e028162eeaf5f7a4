// libjpeg is called itself, and not by way of OpenCV, because OpenCV leaves what libjpeg has to say about a
// damaged image to stderr, where no file is named, and takes such an image for a good one.
#include <csetjmp>
#include <cstddef>
#include <cstdio>
// libjpeg's headers need those above.
#include <jerror.h>
#include <jpeglib.h>

#include "engine/io/encoded_image.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr int kMostStray = 16;  // bytes between two parts; more are a part that was damaged

/// What libjpeg calls about problems: C code, through which no exception may pass.
struct Complaints {
  jpeg_error_mgr base;  // first, so that its address is that of the whole
  std::jmp_buf give_up;
  char first[JMSG_LENGTH_MAX];  ///< empty: none so far

  void note(j_common_ptr decoder) {
    if (first[0] == '\0') base.format_message(decoder, first);
  }
};

Complaints& complaints_of(j_common_ptr decoder) {
  return *reinterpret_cast<Complaints*>(decoder->err);
}

extern "C" void on_error(j_common_ptr decoder) {
  complaints_of(decoder).note(decoder);
  std::longjmp(complaints_of(decoder).give_up, 1);
}

extern "C" void on_message(j_common_ptr decoder, int level) {
  const jpeg_error_mgr& said = *decoder->err;
  const bool stray = said.msg_code == JWRN_EXTRANEOUS_DATA && said.msg_parm.i[0] <= kMostStray;
  const bool warning = level < 0;
  if (warning && !stray) complaints_of(decoder).note(decoder);
}

extern "C" void say_nothing(j_common_ptr) {}

/// Decodes as far as the first error. What is used here must need no destructor: an error jumps out of it.
void decode_rows(jpeg_decompress_struct& decoder, Complaints& complaints, std::string_view bytes,
                 cv::Mat& image) {
  if (setjmp(complaints.give_up) != 0) return;
  jpeg_create_decompress(&decoder);
  jpeg_mem_src(&decoder, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&decoder, TRUE);
  if (decoder.num_components == 4) return;  // OpenCV converts those
  decoder.out_color_space = JCS_RGB;
  jpeg_start_decompress(&decoder);
  image.create(static_cast<int>(decoder.output_height), static_cast<int>(decoder.output_width), CV_8UC3);
  while (decoder.output_scanline < decoder.output_height) {
    JSAMPROW row = image.ptr<uint8_t>(static_cast<int>(decoder.output_scanline));
    jpeg_read_scanlines(&decoder, &row, 1);
  }
  jpeg_finish_decompress(&decoder);
}

}  // namespace

cv::Mat decode_jpeg(std::string_view bytes, const std::filesystem::path& name) {
  jpeg_decompress_struct decoder{};
  Complaints complaints{};
  decoder.err = jpeg_std_error(&complaints.base);
  complaints.base.error_exit = on_error;
  complaints.base.emit_message = on_message;
  complaints.base.output_message = say_nothing;
  cv::Mat image;
  decode_rows(decoder, complaints, bytes, image);
  jpeg_destroy_decompress(&decoder);
  if (complaints.first[0] != '\0')
    throw InputError(
        name, std::string("is not a readable image; it is damaged or cut off (") + complaints.first + ")");
  return image;
}

}  // namespace surefield
