// The camera and what moves it. Vectors are arrays; the rows of `rotation` are the camera's right, down and front in the world.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const along = (a, s, b) => a.map((value, k) => value + s * b[k]);  // a + s b
const unit = (a) => along([0, 0, 0], 1 / (Math.hypot(...a) || 1), a);
const mix = (a, b, t) => a.map((value, k) => value + t * (b[k] - value));

/** A camera-to-world pose in TUM's order, tx ty tz qx qy qz qw, as position and rotation. */
function poseOf([tx, ty, tz, x, y, z, w]) {
  return {
    position: [tx, ty, tz],
    rotation: [
      [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
      [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
      [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)],
    ],
  };
}

/** The other way round. */
function tumOf({position, rotation: r}) {
  const four = [1 + r[0][0] - r[1][1] - r[2][2], 1 - r[0][0] + r[1][1] - r[2][2], 1 - r[0][0] - r[1][1] + r[2][2],
                1 + r[0][0] + r[1][1] + r[2][2]];
  const largest = four.indexOf(Math.max(...four));
  const sum = (a, b) => r[a][b] + r[b][a], difference = (a, b) => r[a][b] - r[b][a];
  const products = [
    [four[0], sum(0, 1), sum(0, 2), difference(1, 2)],
    [sum(0, 1), four[1], sum(1, 2), difference(2, 0)],
    [sum(0, 2), sum(1, 2), four[2], difference(0, 1)],
    [difference(1, 2), difference(2, 0), difference(0, 1), four[3]],
  ][largest];
  const length = Math.hypot(...products);
  return [...position, ...products.map((value) => value / length)];
}

/** Rows of unit length, at right angles: the front row counts most. */
function orthonormal([right, , front]) {
  front = unit(front);
  const down = unit(cross(front, right));
  return [cross(down, front), down, front];
}

/** Turns a rotation's rows by `angle` about the world's `axis`. */
function turned(rotation, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return rotation.map((row) => along(along(along([0, 0, 0], c, row), s, cross(axis, row)), (1 - c) * dot(axis, row), axis));
}

/** A camera that orbits a point in front of it, or flies. */
class Viewpoint {
  /** `up` is the world's; `distance` that of the point to orbit, metres. */
  constructor(pose, up, distance) {
    Object.assign(this, pose, {up, distance, flying: false, journey: null});
  }

  target() { return along(this.position, this.distance, this.rotation[2]); }

  /** Turns by angles to the right and down. */
  turn(yaw, pitch) {
    this.journey = null;
    const centre = this.target(), sign = this.flying ? -1 : 1;
    let next = turned(this.rotation, this.up, -sign * yaw);
    next = turned(next, next[0], -sign * pitch);
    if (Math.abs(dot(next[2], this.up)) > 0.995) return;
    const level = unit(cross(next[2], this.up));
    if (dot(level, next[0]) > 0) next[0] = mix(next[0], level, 0.1);  // a tilted view rights itself as it turns
    this.rotation = orthonormal(next);
    if (!this.flying) this.position = along(centre, -this.distance, this.rotation[2]);
  }

  /** Moves by metres to the right, down and forward. */
  move(right, down, forward) {
    this.journey = null;
    [right, down, forward].forEach((way, k) => { this.position = along(this.position, way, this.rotation[k]); });
  }

  /** Towards the target, so that its distance shrinks by a factor; flying, by as far. */
  approach(factor) {
    const way = this.distance * (1 - factor);
    this.move(0, 0, way);
    if (!this.flying) this.distance -= way;
  }

  travel(pose) { this.journey = {from: {position: this.position, rotation: this.rotation}, to: pose, start: performance.now()}; }

  /** Goes on with a journey; whether there is one. */
  advance(now) {
    if (!this.journey) return false;
    const {from, to, start} = this.journey, t = Math.min(1, (now - start) / 600), s = t * t * (3 - 2 * t);
    this.position = mix(from.position, to.position, s);
    this.rotation = t < 1 ? orthonormal(from.rotation.map((row, k) => mix(row, to.rotation[k], s))) : to.rotation;
    if (t >= 1) this.journey = null;
    return true;
  }
}

/** Lets pointers, wheel and keys move the viewpoint; `changed` is called after each move, `clicked(x, y)` for a click. */
function listen(canvas, viewpoint, changed, clicked) {
  const pointers = new Map(), keys = new Set();
  let moved = 0;
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y)};
  };
  const shift = (dx, dy) => {
    const metres = viewpoint.distance / canvas.clientHeight;
    viewpoint.move(-dx * metres, -dy * metres, 0);
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    moved = pointers.size > 1 ? 99 : 0;
  });
  canvas.addEventListener('pointermove', (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const before = pointers.size === 2 ? spread() : null, dx = event.clientX - last.x, dy = event.clientY - last.y;
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    moved += Math.hypot(dx, dy);
    if (before) {
      const after = spread();
      shift(after.x - before.x, after.y - before.y);
      viewpoint.approach(before.apart / Math.max(after.apart, 1));
    } else if (event.buttons & 2 || event.shiftKey) {
      shift(dx, dy);
    } else {
      viewpoint.turn(4 * dx / canvas.clientHeight, 4 * dy / canvas.clientHeight);
    }
    changed();
  });
  for (const name of ['pointerup', 'pointercancel'])
    canvas.addEventListener(name, (event) => {
      if (pointers.delete(event.pointerId) && moved < 5 && name === 'pointerup') clicked(event.clientX, event.clientY);
    });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    viewpoint.approach(Math.exp(Math.max(-0.3, Math.min(0.3, event.deltaY / 500))));
    changed();
  }, {passive: false});
  const ways = {KeyW: [0, 0, 1], KeyS: [0, 0, -1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0],
                ArrowUp: [0, 0, 1], ArrowDown: [0, 0, -1], ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0]};
  addEventListener('keydown', (event) => {
    if (!(event.code in ways) || event.ctrlKey || event.metaKey) return;
    keys.add(event.code);
    changed();
  });
  addEventListener('keyup', (event) => keys.delete(event.code));
  addEventListener('blur', () => keys.clear());
  /** Moves for as many seconds as the keys were held; whether any is. */
  return (seconds) => {
    const metres = seconds * Math.max(0.3, 0.6 * viewpoint.distance);
    for (const code of keys) viewpoint.move(...ways[code].map((way) => way * metres));
    return keys.size > 0;
  };
}
