// Drawing with WebGL2: Gaussians far to near, and lines over them. A camera is {rotation (rows, world to camera), position,
// fx, fy, cx, cy, width, height}, in pixels whose centres are at integers, as everywhere in Surefield.

const NEAR = 0.01;  // metres

const PROJECTION = `#version 300 es
precision highp float;
precision highp int;
uniform mat3 rotation;
uniform vec3 position;
uniform vec2 focal, centre, size;
vec3 toCamera(vec3 world) { return rotation * (world - position); }
// Of a point in the camera's frame and an offset in pixels.
vec4 toClip(vec3 p, vec2 offset) {
  vec2 pixels = focal * p.xy + (centre + 0.5 + offset) * p.z;
  return vec4((2.0 * pixels / size - p.z) * vec2(1, -1), p.z - 2.0 * ${NEAR.toFixed(3)}, p.z);
}
`;

const SPLAT_VERTICES = PROJECTION + `
uniform highp sampler2D gaussians;
in uint gaussian;
out vec2 local;   // in standard deviations
out vec4 colour;  // and opacity
vec4 texel(uint k) {
  uint at = 4u * gaussian + k, width = uint(textureSize(gaussians, 0).x);
  return texelFetch(gaussians, ivec2(at % width, at / width), 0);
}
void main() {
  vec4 a = texel(0u), b = texel(1u), c = texel(2u), d = texel(3u);
  vec3 p = toCamera(a.xyz);
  colour = vec4(max(vec3(c.zw, d.x), 0.0), a.w);
  gl_Position = vec4(0, 0, 2, 1);  // outside
  if (p.z < ${NEAR.toFixed(3)} || a.w < 1.0 / 255.0) return;
  // The engine's projection (docs/method.md): perspective, linear about the centre, and blurred by 0.3 pixels
  // squared, of those that the Gaussian was seen with where they are wider.
  vec2 low = 1.3 * (vec2(-0.5) - centre) / focal, high = 1.3 * (size - 0.5 - centre) / focal;
  vec2 tangent = clamp(p.xy / p.z, min(low, high), max(low, high));
  mat3 rows = transpose(rotation);
  vec3 u = focal.x / p.z * (rows[0] - tangent.x * rows[2]), v = focal.y / p.z * (rows[1] - tangent.y * rows[2]);
  mat3 covariance = mat3(b.xyz, b.y, b.w, c.x, b.z, c.xy);
  float blur = 0.3 * max(1.0, d.y * d.y * focal.x * focal.y / (p.z * p.z));
  float xx = dot(u, covariance * u) + blur, xy = dot(u, covariance * v), yy = dot(v, covariance * v) + blur;
  float middle = 0.5 * (xx + yy), apart = length(vec2(0.5 * (xx - yy), xy));
  float angle = apart > 0.0 ? 0.5 * atan(2.0 * xy, xx - yy) : 0.0;
  vec2 axis = vec2(cos(angle), sin(angle));
  float reach = sqrt(2.0 * log(255.0 * a.w)) + 0.01;  // where its opacity falls to 1 / 255
  local = reach * vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  vec2 offset = local.x * sqrt(middle + apart) * axis +
                local.y * sqrt(max(middle - apart, 0.0)) * vec2(-axis.y, axis.x);
  gl_Position = toClip(p, offset);
}`;

const SPLAT_PIXELS = `#version 300 es
precision highp float;
in vec2 local;
in vec4 colour;
out vec4 pixel;
void main() {
  float alpha = min(0.99, colour.a * exp(-0.5 * dot(local, local)));
  if (alpha < 1.0 / 255.0) discard;
  pixel = vec4(colour.rgb * alpha, alpha);
}`;

const LINE_VERTICES = PROJECTION + `
in vec3 point;
in vec3 tint;
out vec3 shown;
void main() {
  shown = tint;
  gl_Position = toClip(toCamera(point), vec2(0));
}`;

const LINE_PIXELS = `#version 300 es
precision highp float;
in vec3 shown;
out vec4 pixel;
void main() { pixel = vec4(shown, 1); }`;

/**
 * The Gaussians in front of the camera, far to near, by a counting sort. Stands alone, since a worker gets its source.
 */
function sortFarToNear(centres, camera, near) {
  const buckets = 1 << 16, [x, y, z] = camera.rotation[2], [px, py, pz] = camera.position;
  const count = centres.length / 3, depths = new Float32Array(count);
  let low = Infinity, high = near;
  for (let i = 0; i < count; ++i) {
    depths[i] = x * (centres[3 * i] - px) + y * (centres[3 * i + 1] - py) + z * (centres[3 * i + 2] - pz);
    const depth = depths[i];  // as rounded
    if (depth < near) continue;
    if (depth < low) low = depth;
    if (depth > high) high = depth;
  }
  const scale = (buckets - 1) / Math.max(high - low, 1e-9), starts = new Uint32Array(buckets + 1);
  const bucket = (i) => Math.floor((high - depths[i]) * scale);
  for (let i = 0; i < count; ++i) if (depths[i] >= near) ++starts[bucket(i) + 1];
  for (let k = 0; k < buckets; ++k) starts[k + 1] += starts[k];
  const order = new Uint32Array(starts[buckets]);
  for (let i = 0; i < count; ++i) if (depths[i] >= near) order[starts[bucket(i)]++] = i;
  return order;
}

/** Sorts in the background; `done` gets each order. While one sort runs, only the newest wish for another is kept. */
function makeSorter(centres, done) {
  const source = `${sortFarToNear}\nlet centres;\nonmessage = ({data}) => {
    if (data.centres) { centres = data.centres; return; }
    const order = sortFarToNear(centres, data, ${NEAR});
    postMessage(order, [order.buffer]);
  };`;
  const worker = new Worker(URL.createObjectURL(new Blob([source], {type: 'text/javascript'})));
  let busy = false, waiting = null;
  const send = (camera) => {
    busy = true;
    worker.postMessage({rotation: camera.rotation, position: camera.position});
  };
  worker.postMessage({centres});
  worker.onmessage = ({data}) => {
    busy = false;
    if (waiting) send(waiting);
    waiting = null;
    done(data);
  };
  return (camera) => { if (busy) waiting = camera; else send(camera); };
}

class Painter {
  /** `opaque`: holes are black, else they show what is behind the canvas. */
  constructor(canvas, map, opaque) {
    const gl = canvas.getContext('webgl2', {alpha: !opaque, antialias: false, depth: false});
    if (!gl) throw new Error('This browser has no WebGL2, which this page needs.');
    this.gl = gl;
    this.opaque = opaque;
    this.splats = this.program(SPLAT_VERTICES, SPLAT_PIXELS, ['gaussian']);
    this.lines = this.program(LINE_VERTICES, LINE_PIXELS, ['point', 'tint']);
    this.upload(map);
    this.order = gl.createBuffer();
    this.visible = 0;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  program(vertices, pixels, inputs) {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertices], [gl.FRAGMENT_SHADER, pixels]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    inputs.forEach((name, place) => gl.bindAttribLocation(program, place, name));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  /** Gaussians lie in a texture, four texels each, row by row. */
  upload(map) {
    const gl = this.gl, width = 4096, height = Math.max(1, Math.ceil(4 * map.count / width));
    if (height > gl.getParameter(gl.MAX_TEXTURE_SIZE)) throw new Error('The map is too large for this graphics device.');
    const texels = new Float32Array(4 * width * height);
    texels.set(map.records);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, texels);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  setOrder(order) {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.order);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, order, this.gl.DYNAMIC_DRAW);
    this.visible = order.length;
  }

  /** Lines for draw(): pairs of ends, each x, y, z, red, green, blue. */
  makeLines(numbers) {
    const buffer = this.gl.createBuffer();
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, new Float32Array(numbers), this.gl.STATIC_DRAW);
    return {buffer, ends: numbers.length / 6};
  }

  use(program, camera) {
    const gl = this.gl, at = (name) => gl.getUniformLocation(program, name);
    gl.useProgram(program);
    gl.uniformMatrix3fv(at('rotation'), true, camera.rotation.flat());
    gl.uniform3fv(at('position'), camera.position);
    gl.uniform2f(at('focal'), camera.fx, camera.fy);
    gl.uniform2f(at('centre'), camera.cx, camera.cy);
    gl.uniform2f(at('size'), camera.width, camera.height);
  }

  draw(camera, lines) {
    const gl = this.gl;
    gl.viewport(0, 0, camera.width, camera.height);
    gl.clearColor(0, 0, 0, this.opaque ? 1 : 0);  // holes show the page's squares
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.use(this.splats, camera);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.order);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribIPointer(0, 1, gl.UNSIGNED_INT, 0, 0);
    gl.vertexAttribDivisor(0, 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.visible);
    this.use(this.lines, camera);
    gl.vertexAttribDivisor(0, 0);
    gl.enableVertexAttribArray(1);
    for (const line of lines) {
      gl.bindBuffer(gl.ARRAY_BUFFER, line.buffer);
      gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 24, 0);
      gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 24, 12);
      gl.drawArrays(gl.LINES, 0, line.ends);
    }
    gl.disableVertexAttribArray(1);
  }
}
