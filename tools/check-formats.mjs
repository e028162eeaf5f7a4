// Part of tools/check-formats: makes a random map, and compares two files of the same Gaussians.
import fs from 'node:fs';

/** The largest difference that is taken for the same, of each attribute. */
const LIMITS = {position: 2e-6, 'ln(scale)': 2e-6, covariance: 2e-5, opacity: 1.1e-3, colour: 2e-6, harmonics: 2e-6};

/** Numbers from 0 to 1 that are the same each time (a linear congruential generator). */
let state = 1;
const random = () => (state = (1664525 * state + 1013904223) % 4294967296) / 4294967296;

function makePly(file, count) {
  const rest = Array.from({length: 45}, (_, k) => `f_rest_${k}`);
  const names = ['x', 'y', 'z', 'f_dc_0', 'f_dc_1', 'f_dc_2', ...rest, 'opacity', 'scale_0', 'scale_1', 'scale_2', 'rot_0',
                 'rot_1', 'rot_2', 'rot_3'];
  const header = `ply\nformat binary_little_endian 1.0\nelement vertex ${count}\n` +
      names.map((name) => `property float ${name}\n`).join('') + 'end_header\n';
  const range = (name) => name.length === 1 ? 5 : name.startsWith('opacity') ? 5 : name.startsWith('scale') ? 3 : 0.9;
  const values = new Float32Array(count * names.length);
  for (let i = 0; i < values.length; ++i) {
    const name = names[i % names.length];
    values[i] = (2 * random() - 1) * range(name) - (name.startsWith('scale') ? 3 : 0);
  }
  fs.writeFileSync(file, Buffer.concat([Buffer.from(header), Buffer.from(values.buffer)]));
}

/** The float properties of a binary PLY file, by name. */
function readPly(file) {
  const bytes = fs.readFileSync(file), end = bytes.indexOf('end_header\n') + 11;
  const header = bytes.subarray(0, end).toString().split('\n');
  const count = Number(header.find((line) => line.startsWith('element vertex')).split(' ')[2]);
  const names = header.filter((line) => line.startsWith('property float')).map((line) => line.split(' ')[2]);
  const values = new Float32Array(bytes.buffer.slice(bytes.byteOffset + end, bytes.byteOffset + end + 4 * count * names.length));
  return {count, names, get: (i, name) => values[i * names.length + names.indexOf(name)]};
}

/** The attributes of Gaussians, each an array of numbers a Gaussian. Quaternions are w, x, y, z. */
function gaussiansOfPly(file) {
  const ply = readPly(file), rest = ply.names.filter((name) => name.startsWith('f_rest_')).length;
  return Array.from({length: ply.count}, (_, i) => {
    const all = (...names) => names.map((name) => ply.get(i, name));
    const scales = all('scale_0', 'scale_1', 'scale_2');
    return {
      position: all('x', 'y', 'z'),
      'ln(scale)': scales,
      covariance: covariance(scales.map(Math.exp), all('rot_0', 'rot_1', 'rot_2', 'rot_3')),
      opacity: [1 / (1 + Math.exp(-ply.get(i, 'opacity')))],
      colour: all('f_dc_0', 'f_dc_1', 'f_dc_2'),
      harmonics: all(...Array.from({length: rest}, (_, k) => `f_rest_${k}`)),
    };
  });
}

/** Relative to the largest of its numbers. */
function covariance(scales, q) {
  const length = Math.hypot(...q), [w, x, y, z] = q.map((value) => value / length);
  const axes = [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
  const largest = Math.max(...scales) ** 2;
  return [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]].map(
      ([a, b]) => axes.reduce((sum, axis, k) => sum + scales[k] ** 2 * axis[a] * axis[b], 0) / largest);
}

/** `signs` turn the axes, so that both files have the same: x, y and z of positions. */
function gaussiansOfGlb(file, signs) {
  const bytes = fs.readFileSync(file), length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + length).toString()), start = bytes.byteOffset + 28 + length;
  const {attributes} = json.meshes[0].primitives[0];
  const values = (name, width) => {
    const accessor = json.accessors[attributes[name]], view = json.bufferViews[accessor.bufferView];
    const floats = new Float32Array(bytes.buffer.slice(start + view.byteOffset, start + view.byteOffset + view.byteLength));
    return (i) => [...floats.subarray(width * i, width * (i + 1))];
  };
  const splat = (name, width) => values(`KHR_gaussian_splatting:${name}`, width);
  const position = values('POSITION', 3), scale = splat('SCALE', 3), rotation = splat('ROTATION', 4), opacity = splat('OPACITY', 1),
        colour = splat('SH_DEGREE_0_COEF_0', 3);
  return Array.from({length: json.accessors[attributes.POSITION].count}, (_, i) => {
    const [x, y, z, w] = rotation(i), s = signs[0] * signs[1] * signs[2];
    const turned = [x, y, z].map((value, k) => s * signs[k] * value);
    return {
      position: position(i).map((value, k) => signs[k] * value),
      'ln(scale)': scale(i).map(Math.log),
      covariance: covariance(scale(i), [w, ...turned]),
      opacity: opacity(i),
      colour: colour(i),
      harmonics: [],  // each is turned in its own way; tests/io/glb_test.cpp checks ours
    };
  });
}

/** Prints the largest difference of each attribute; whether all are within their limits. */
function compare(a, b) {
  if (a.length !== b.length) throw new Error(`${a.length} Gaussians against ${b.length}`);
  let good = true;
  const words = Object.entries(LIMITS).map(([name, limit]) => {
    let largest = 0;
    for (let i = 0; i < a.length; ++i) {
      if (a[i][name].length !== b[i][name].length) throw new Error(`the files hold different ${name}`);
      a[i][name].forEach((value, k) => { largest = Math.max(largest, Math.abs(value - b[i][name][k])); });
    }
    if (!(largest <= limit)) good = false;
    return `${name} ${largest.toExponential(1)}`;
  });
  console.log(`   ${a.length} Gaussians, largest differences: ${words.join(', ')}`);
  return good;
}

const [what, first, second] = process.argv.slice(2);
if (what === 'make') makePly(first, 1000);
if (what === 'ply' && !compare(gaussiansOfPly(first), gaussiansOfPly(second))) process.exit(1);
// splat-transform turns a PLY file's axes by 180 degrees about z into glTF's, we about x.
if (what === 'glb' && !compare(gaussiansOfGlb(first, [-1, -1, 1]), gaussiansOfGlb(second, [1, -1, -1]))) process.exit(1);
