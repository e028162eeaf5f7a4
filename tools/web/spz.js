// The map: SPZ version 2 in base64 (docs/formats.md).

function decodeBase64(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function unzip(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The covariance (xx, xy, xz, yy, yz, zz) of a Gaussian with the unit quaternion x, y, z, w. */
function covarianceOf(x, y, z, w, scales) {
  const axes = [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
  const sum = (a, b) => axes.reduce((all, axis, k) => all + scales[k] * scales[k] * axis[a] * axis[b], 0);
  return [sum(0, 0), sum(0, 1), sum(0, 2), sum(1, 1), sum(1, 2), sum(2, 2)];
}

/**
 * Reads the Gaussians: their number, their centres (three numbers each) and 16 numbers each for the shaders: centre, opacity,
 * covariance, colour, sampling, two unused. In metres, x right, y down, z front. Spherical harmonics above degree 0 are left
 * out. The sampling, the width of a pixel of the nearest view that saw it, comes a byte each: its logarithm in twentieths of an
 * octave, 255 one metre, 0 not known.
 */
async function readMap(base64, samplingBase64) {
  const sampling = decodeBase64(samplingBase64);
  const bytes = await unzip(decodeBase64(base64));
  const view = new DataView(bytes.buffer);
  const count = view.getUint32(8, true), unit = 2 ** -view.getUint8(13);
  const positions = 16, alphas = positions + 9 * count, colours = alphas + count, scales = colours + 3 * count,
        rotations = scales + 3 * count;
  const turned = [1, -1, -1];  // the file's y points up and its z back
  const centres = new Float32Array(3 * count), records = new Float32Array(16 * count);
  for (let i = 0; i < count; ++i) {
    const q = [0, 0, 0], axes = [0, 0, 0];
    for (let k = 0; k < 3; ++k) {
      const at = positions + 9 * i + 3 * k;
      const fixed = bytes[at] << 8 | bytes[at + 1] << 16 | bytes[at + 2] << 24;  // with its sign
      centres[3 * i + k] = turned[k] * unit * (fixed >> 8);
      axes[k] = Math.exp(bytes[scales + 3 * i + k] / 16 - 10);
      q[k] = turned[k] * (bytes[rotations + 3 * i + k] / 127.5 - 1);
      records[16 * i + 10 + k] = (bytes[colours + 3 * i + k] / 255 - 0.5) / 0.15 * 0.28209479177387814 + 0.5;
    }
    const w = Math.sqrt(Math.max(0, 1 - q[0] * q[0] - q[1] * q[1] - q[2] * q[2]));
    records.set(centres.subarray(3 * i, 3 * i + 3), 16 * i);
    records[16 * i + 3] = bytes[alphas + i] / 255;
    records[16 * i + 13] = sampling[i] ? 2 ** ((sampling[i] - 255) / 20) : 0;
    records.set(covarianceOf(q[0], q[1], q[2], w, axes), 16 * i + 4);
  }
  return {count, centres, records};
}
