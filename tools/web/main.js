// The page: reads the map and the run, draws when something changed, and does what the panel asks.

const element = (id) => document.getElementById(id);
const canvas = element('view');
const run = JSON.parse(element('run').textContent);
const wishes = new URLSearchParams(location.hash.slice(1));
const numbers = (name) => wishes.get(name)?.split(',').map(Number);
const fixed = numbers('camera');  // fx, fy, cx, cy, width, height: shows exactly this, without lines and panel

const COLOURS = {estimate: [1, 0.62, 0.11], truth: [0.18, 0.77, 0.71], keyframes: [0.54, 0.71, 1]};

/** Lines from each position to the next. */
function path(poses, colour) {
  return poses.slice(1).flatMap((pose, i) => [...poses[i].slice(0, 3), ...colour, ...pose.slice(0, 3), ...colour]);
}

/** The corners of a keyframe's picture, `depth` in front of it, between lines to its centre. */
function frustum(pose, colour, depth) {
  const {position, rotation} = poseOf(pose), c = run.camera;
  const corner = (u, v) => {
    const ray = [(u - c.cx) / c.fx, (v - c.cy) / c.fy, 1];
    return ray.reduce((at, value, k) => along(at, depth * value, rotation[k]), position);
  };
  const corners = [corner(-0.5, -0.5), corner(c.width - 0.5, -0.5), corner(c.width - 0.5, c.height - 0.5), corner(-0.5, c.height - 0.5)];
  const line = (a, b) => [...a, ...colour, ...b, ...colour];
  return corners.flatMap((at, k) => [...line(position, at), ...line(at, corners[(k + 1) % 4])]);
}

/** How far in front of a pose the map's middle lies. */
function distanceOf(pose, centres) {
  const depths = [];
  for (let i = 0; i < centres.length; i += 3) {
    const offset = along([centres[i], centres[i + 1], centres[i + 2]], -1, pose.position);
    const [x, y, z] = pose.rotation.map((row) => dot(row, offset));
    if (z > 0.1 && Math.abs(x) < 0.3 * z && Math.abs(y) < 0.3 * z) depths.push(z);
  }
  return depths.sort((a, b) => a - b)[depths.length >> 1] || 1;
}

/** The camera of a viewpoint, for the canvas as large as it is: the run's field of view from top to bottom. */
function cameraOf({position, rotation}) {
  if (fixed) {
    const [fx, fy, cx, cy, width, height] = fixed;
    Object.assign(canvas.style, {width: `${width}px`, height: `${height}px`});
    Object.assign(canvas, {width, height});
    return {position, rotation, fx, fy, cx, cy, width, height};
  }
  const width = Math.round(canvas.clientWidth * devicePixelRatio), height = Math.round(canvas.clientHeight * devicePixelRatio);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
  const focal = run.camera.fy / run.camera.height * height;
  return {position, rotation, fx: focal, fy: focal, cx: (width - 1) / 2, cy: (height - 1) / 2, width, height};
}

function start(map) {
  const painter = new Painter(canvas, map, Boolean(fixed));
  const home = poseOf(numbers('pose') ?? run.keyframes[0] ?? [0, 0, 0, 0, 0, 0, 1]);
  const distance = distanceOf(home, map.centres);
  const viewpoint = new Viewpoint(home, run.up, distance);
  const lines = {
    estimate: painter.makeLines(path(run.estimate, COLOURS.estimate)),
    truth: painter.makeLines(path(run.truth, COLOURS.truth)),
    keyframes: painter.makeLines(run.keyframes.flatMap((pose) => frustum(pose, COLOURS.keyframes, 0.04 * distance))),
  };
  let wanted = false, last = 0, steer = () => false, sort = () => {};
  const request = () => {
    if (wanted) return;
    wanted = true;
    requestAnimationFrame(frame);
  };
  const shownLines = () => fixed ? [] : Object.keys(lines).filter((name) => element(name).checked).map((name) => lines[name]);
  function frame(now) {
    wanted = false;
    const moving = [viewpoint.advance(now), steer(Math.min(0.1, (now - last) / 1000))].includes(true);
    last = now;
    const camera = cameraOf(viewpoint);
    sort(camera);
    painter.draw(camera, shownLines());
    if (moving) request();
  }
  painter.setOrder(sortFarToNear(map.centres, home, NEAR));  // at once, so that the first picture is right
  if (!fixed) {
    const wish = makeSorter(map.centres, (order) => { painter.setOrder(order); painter.draw(cameraOf(viewpoint), shownLines()); });
    let sorted = '';
    sort = (camera) => {
      const view = JSON.stringify([camera.position, camera.rotation[2]]);
      if (view !== sorted) wish(camera);
      sorted = view;
    };
    steer = listen(canvas, viewpoint, request, (x, y) => visit(nearestKeyframe(x, y)));
    fillPanel(map, viewpoint, home, request, (step) => visit((current + step + run.keyframes.length) % run.keyframes.length));
    addEventListener('resize', request);
  }
  let current = 0;
  function visit(keyframe) {
    if (!(keyframe in run.keyframes)) return;
    current = keyframe;
    viewpoint.travel(poseOf(run.keyframes[keyframe]));
    request();
  }
  function nearestKeyframe(x, y) {
    const camera = cameraOf(viewpoint), reach = 15;
    const distances = element('keyframes').checked ? run.keyframes.map((pose) => {
      const offset = along(pose.slice(0, 3), -1, camera.position), [a, b, z] = camera.rotation.map((row) => dot(row, offset));
      const u = camera.fx * a / z + camera.cx, v = camera.fy * b / z + camera.cy;
      return z < NEAR ? Infinity : Math.hypot(u / devicePixelRatio - x, v / devicePixelRatio - y);
    }) : [];
    const best = Math.min(...distances);
    return best < reach ? distances.indexOf(best) : -1;
  }
  request();
}

function fillPanel(map, viewpoint, home, request, step) {
  element('panel').hidden = false;
  element('lines').hidden = run.keyframes.length === 0;
  element('truth-label').hidden = run.truth.length === 0;
  element('about').textContent = `${map.count.toLocaleString('en')} Gaussians` +
      (run.keyframes.length ? `, ${run.estimate.length} frames, ${run.keyframes.length} keyframes` : '') +
      (run.sh_degree > 0 ? '; without the colours that depend on the view' : '');
  for (const name of ['estimate', 'truth', 'keyframes']) element(name).onchange = request;
  const actions = {
    previous: () => step(-1),
    next: () => step(1),
    reset: () => { viewpoint.travel(home); request(); },
    mode: () => {
      viewpoint.flying = !viewpoint.flying;
      element('mode').textContent = viewpoint.flying ? 'Orbit' : 'Fly';
    },
    link: () => { location.hash = 'pose=' + tumOf(viewpoint).map((value) => value.toFixed(5)).join(','); },
  };
  for (const [name, action] of Object.entries(actions)) element(name).onclick = action;
  addEventListener('keydown', ({code}) => {
    if (code === 'KeyH') element('panel').hidden = !element('panel').hidden;
    if (code === 'KeyF') actions.mode();
    if (code === 'BracketLeft') step(-1);
    if (code === 'BracketRight') step(1);
  });
}

readMap(element('map').textContent, element('sampling').textContent).then((map) => {
  start(map);
  element('message').hidden = true;
}).catch((error) => { element('message').textContent = `The map cannot be shown: ${error.message}`; });
