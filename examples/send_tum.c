/* Sends a list of PNG files to surefield run --live by way of standard output. Plain C, no library.
   The list has lines as TUM's associations: stamp colour.png stamp depth.png

     send_tum associations.txt 640 480 525 525 319.5 239.5 | surefield run --live - --out out/run */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#pragma pack(push, 1) /* the layout of docs/live.md, on a little-endian machine */
struct header {
  char tag[4];
  uint32_t bytes, version, flags, width, height;
  double fx, fy, cx, cy, depth_unit;
  uint32_t distortion_model, coefficients;
  double distortion[14];
  char name[64];
};
struct frame {
  char tag[4];
  uint32_t bytes, colour_kind, depth_kind;
  double stamp, depth_stamp;
  uint32_t colour_bytes, depth_bytes;
};
#pragma pack(pop)

static char* read_file(const char* path, uint32_t* size) {
  FILE* file = fopen(path, "rb");
  if (!file || fseek(file, 0, SEEK_END) != 0) {
    perror(path);
    exit(1);
  }
  *size = (uint32_t)ftell(file);
  rewind(file);
  char* bytes = malloc(*size);
  if (!bytes || fread(bytes, 1, *size, file) != *size) exit(1);
  fclose(file);
  return bytes;
}

int main(int count, char** arguments) {
  if (count != 8) return fprintf(stderr, "usage: send_tum LIST WIDTH HEIGHT FX FY CX CY\n"), 2;
  struct header header = {.tag = "SFLH", .bytes = sizeof(header) - 8, .version = 1, .flags = 1 /* every frame counts */};
  header.width = (uint32_t)atoi(arguments[2]);
  header.height = (uint32_t)atoi(arguments[3]);
  header.fx = atof(arguments[4]);
  header.fy = atof(arguments[5]);
  header.cx = atof(arguments[6]);
  header.cy = atof(arguments[7]);
  header.depth_unit = 1.0 / 5000; /* metres for one step */
  strncpy(header.name, "tum", sizeof(header.name) - 1);
  fwrite(&header, sizeof(header), 1, stdout);
  FILE* list = fopen(arguments[1], "r");
  char line[4096], colour_path[2048], depth_path[2048];
  while (list && fgets(line, sizeof(line), list)) {
    struct frame frame = {.tag = "SFLF", .colour_kind = 3 /* PNG */, .depth_kind = 1 /* PNG of 16 bits */};
    if (sscanf(line, "%lf %2047s %lf %2047s", &frame.stamp, colour_path, &frame.depth_stamp, depth_path) != 4) continue;
    char* colour = read_file(colour_path, &frame.colour_bytes);
    char* depth = read_file(depth_path, &frame.depth_bytes);
    frame.bytes = (uint32_t)(sizeof(frame) - 8) + frame.colour_bytes + frame.depth_bytes;
    fwrite(&frame, sizeof(frame), 1, stdout);
    fwrite(colour, 1, frame.colour_bytes, stdout);
    fwrite(depth, 1, frame.depth_bytes, stdout);
    free(colour);
    free(depth);
  }
  fwrite("SFLE\0\0\0\0", 8, 1, stdout);
  return fflush(stdout) == 0 && list ? 0 : 1;
}
