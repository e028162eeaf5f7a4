#version 460
#extension GL_GOOGLE_include_directive : require
#include "sort_offsets.h"

shared uint scratch[gl_WorkGroupSize.x];
#define WORKGROUP_SCAN_SCRATCH scratch
#include "chunks.glsl"
#include "workgroup_scan.glsl"

// A team of TEAM invocations takes one digit, that is one row of the table, and shares out the columns in use: each
// member sums a consecutive part of the row, learns from the members before it where the part starts, and writes the
// running sum. A team of one goes along the row alone.
void main() {
  const uint n = min(count[0], params.capacity);
  const uint chunk = chunk_length(n, params.columns, CHUNK_LEAST);
  const uint digit = gl_GlobalInvocationID.x / TEAM;
  const uint member = gl_GlobalInvocationID.x % TEAM;
  const uint used = digit < params.digits ? (n + chunk - 1) / chunk : 0;
  const uint part = chunk_length(used, TEAM, 1);
  const uint row = digit * params.columns;
  const uint begin = row + min(member * part, used);
  const uint end = row + min(member * part + part, used);

  uint running = 0;
  if (TEAM > 1) {
    uint sum = 0, total;
    for (uint i = begin; i < end; ++i) sum += table[i];
    running = team_exclusive_scan(sum, TEAM, total);
  }
  for (uint i = begin; i < end; ++i) {
    const uint here = table[i];
    table[i] = running;
    running += here;
  }
  if (member == TEAM - 1 && digit < params.digits) digit_totals[digit] = running;
}
