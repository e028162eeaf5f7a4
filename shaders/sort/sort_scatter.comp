#version 460
#extension GL_GOOGLE_include_directive : require
#include "sort_scatter.h"

shared uint next[SORT_DIGITS_MAX * gl_WorkGroupSize.x];  // per digit and invocation: where its next pair goes
#define WORKGROUP_SCAN_SCRATCH next
#include "chunks.glsl"
#include "workgroup_scan.glsl"

// Fills `next` for the whole workgroup. Each invocation takes a few consecutive digits and does, for all columns of
// the workgroup: start of the digit among all pairs + start of the column among the pairs of the digit.
void load_starts(uint used_columns) {
  const uint digits = 1u << params.digit_bits;
  const uint part = chunk_length(digits, gl_WorkGroupSize.x, 1);
  const uint begin = min(gl_LocalInvocationID.x * part, digits);
  const uint end = min(begin + part, digits);
  uint sum = 0;
  for (uint d = begin; d < end; ++d) sum += digit_totals[d];
  uint total;
  uint digit_start = workgroup_exclusive_scan(sum, total);
  const uint first_column = min(gl_WorkGroupID.x * gl_WorkGroupSize.x, used_columns);
  const uint columns_here = min(gl_WorkGroupSize.x, used_columns - first_column);
  for (uint d = begin; d < end; ++d) {
    for (uint c = 0; c < columns_here; ++c)
      next[d * gl_WorkGroupSize.x + c] = digit_start + table[d * params.columns + first_column + c];
    digit_start += digit_totals[d];
  }
  barrier();
}

// Each invocation moves the pairs of the chunk that it counted in sort_histogram, first to last: the sort is stable
// because chunks before it have got the places before its own.
void main() {
  const uint n = min(count[0], params.capacity);
  const uint chunk = chunk_length(n, params.columns, CHUNK_LEAST);
  load_starts((n + chunk - 1) / chunk);
  const uint begin = min(gl_GlobalInvocationID.x * chunk, n);
  const uint end = min(begin + chunk, n);
  for (uint i = begin; i < end; ++i) {
    const uint key = keys[i];
    const uint digit = bitfieldExtract(key, int(params.shift), int(params.digit_bits));
    const uint slot = digit * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    const uint place = next[slot];
    next[slot] = place + 1;
    sorted_keys[place] = key;
    sorted_values[place] = values[i];
  }
}
