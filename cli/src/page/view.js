// The view of a run that can be turned and played: bodies by their axes, points, chains and profiles, what joins them, and
// the ground. What is farther away is paler and is drawn first.
"use strict";
const scene = JSON.parse(document.getElementById("scene").textContent);
const canvas = document.getElementById("view");
const pen = canvas.getContext("2d");
const slider = document.getElementById("time");
const clock = document.getElementById("clock");
const play = document.getElementById("play");
const colours = [[213, 94, 0], [0, 158, 115], [0, 114, 178]];
const blue = [0, 114, 178], grey = [90, 90, 90], trace = [120, 170, 215], ink = [40, 40, 40];
// The scale "viridis" of matplotlib.
const scale = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
const last = scene.times.length - 1;
// Frames of a trail, and most things that have their names beside them.
const behind = 150, named = 12;
// Profiles are wider than high.
const flatter = scene.flat && scene.bodies.length === 0 && scene.chains.every(c => c.profile);
let yaw = scene.flat ? 0 : -0.6, pitch = scene.flat ? Math.PI / 2 : 0.45, zoom = 1;
let frame = 0, running = false;

// Largest distance of anything from the middle, so that all of the motion fits.
const middle = [0, 0, 0];
let reach = 1e-300;
// A part of the range of what colours particles.
function depth(tints, f, k) {
  return (tints.frames[f][k] - tints.low) / (tints.high - tints.low || 1);
}
function points(chain, f) {
  const flat = chain.frames[f], out = [];
  if (chain.profile) {
    const n = flat.length, top = chain.top || 1;
    flat.forEach((v, i) => out.push([n > 1 ? 2 * i / (n - 1) - 1 : 0, 0.6 * v / top, 0]));
    return out;
  }
  // Particles on a line are at the height of their depth.
  if (chain.dim === 1) return flat.map((x, i) => [x, chain.tints ? 0.5 * scene.box[0] * depth(chain.tints, f, i) : 0, 0]);
  for (let i = 0; i < flat.length; i += chain.dim)
    out.push([flat[i], flat[i + 1], chain.dim > 2 ? flat[i + 2] : 0]);
  return out;
}
function joined(link, f) {
  const flat = link[f], out = [];
  for (let i = 0; i < flat.length; i += 3) out.push([flat[i], flat[i + 1], flat[i + 2]]);
  return out;
}
function places() {
  const all = [...scene.supports];
  for (let f = 0; f <= last; f++) {
    scene.chains.forEach(c => all.push(...points(c, f)));
    scene.bodies.forEach(b => all.push(b.places[f]));
    scene.links.forEach(l => all.push(...joined(l, f)));
  }
  if (scene.box) all.push([0, 0, 0], [scene.box[0], scene.box[1] || 0, 0]);
  return all;
}
{
  const all = places(), low = [1e300, 1e300, 1e300], high = [-1e300, -1e300, -1e300];
  for (const p of all) for (let j = 0; j < 3; j++) {
    low[j] = Math.min(low[j], p[j]);
    high[j] = Math.max(high[j], p[j]);
  }
  for (let j = 0; j < 3; j++) if (all.length) middle[j] = (low[j] + high[j]) / 2;
  for (const p of all) reach = Math.max(reach, Math.hypot(p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]));
}
const few = scene.bodies.length <= 3;
const arm = scene.arm;
reach += 1.15 * arm;
// The origin is marked where it is seen and nothing stands on it.
const apart = p => Math.hypot(...p) > 1e-6 * reach;
const origin = !scene.box && scene.chains.every(c => !c.profile) && scene.supports.every(apart)
  && scene.bodies.every(b => apart(b.places[0])) && Math.hypot(...middle) < reach;

// Pixels of a length of one.
function unit() {
  return 0.48 * (flatter ? Math.min(canvas.width, 1.6 * canvas.height) : Math.min(canvas.width, canvas.height)) / reach * zoom;
}
// Where a point is in the picture, and how near it is: from -1, the farthest, to 1.
function seen(p) {
  const x = p[0] - middle[0], y = p[1] - middle[1], z = p[2] - middle[2];
  const [c, s, d, t] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  const across = c * x - s * y, away = s * x + c * y;
  const size = unit();
  return [canvas.width / 2 + size * across, canvas.height / 2 - size * (away * t + z * d), (z * t - away * d) / reach];
}
// Paler with the distance.
function shade(colour, near) {
  const part = scene.flat ? 0 : 0.3 * (1 - Math.max(-1, Math.min(1, near)));
  return "rgb(" + colour.map(c => Math.round(c + part * (255 - c))).join(",") + ")";
}
function tint(part) {
  const at = Math.max(0, Math.min(1, part)) * (scale.length - 1), k = Math.min(Math.floor(at), scale.length - 2);
  return scale[k].map((c, j) => c + (at - k) * (scale[k + 1][j] - c));
}

// What is drawn in this frame, each with its nearness.
let parts = [];
function stroke(list, colour, width) {
  const at = list.map(seen), near = at.reduce((sum, p) => sum + p[2], 0) / at.length;
  parts.push([near, () => {
    pen.beginPath();
    at.forEach((p, i) => i ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1]));
    pen.strokeStyle = shade(colour, near);
    pen.lineWidth = width * devicePixelRatio;
    pen.stroke();
  }]);
}
// Piece by piece, each with its own shade.
function path(list, colour, width) {
  for (let i = 1; i < list.length; i++) stroke([list[i - 1], list[i]], colour, width);
}
function dot(p, colour, radius) {
  const at = seen(p);
  parts.push([at[2] + 1e-3, () => {
    pen.beginPath();
    pen.arc(at[0], at[1], radius * devicePixelRatio, 0, 7);
    pen.fillStyle = shade(colour, at[2]);
    pen.fill();
  }]);
}
// A smooth curve through the points of a trail (Catmull and Rom, 1974): the corners at its nodes are of the samples that are
// kept, not of the motion.
function curve(list, colour, width) {
  const at = i => list[Math.max(0, Math.min(list.length - 1, i))];
  for (let i = 1; i < list.length; i++) {
    const [a, b, c, d] = [at(i - 2), at(i - 1), at(i), at(i + 1)];
    const from = seen(b), to = seen(c);
    const count = Math.max(1, Math.min(12, Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) / 3)));
    const piece = [];
    for (let k = 0; k <= count; k++) {
      const s = k / count;
      piece.push([0, 1, 2].map(j => 0.5 * (2 * b[j] + s * (c[j] - a[j] + s * (2 * a[j] - 5 * b[j] + 4 * c[j] - d[j]
        + s * (3 * b[j] - 3 * c[j] + d[j] - a[j]))))));
    }
    stroke(piece, colour, width);
  }
}
// The ground: a line with strokes below it.
function ground(p) {
  const at = seen(p), w = 9 * devicePixelRatio;
  parts.push([at[2] - 1e-3, () => {
    pen.beginPath();
    pen.moveTo(at[0] - w, at[1]);
    pen.lineTo(at[0] + w, at[1]);
    for (let k = -1; k < 1; k += 0.5) {
      pen.moveTo(at[0] + (k + 0.5) * w, at[1]);
      pen.lineTo(at[0] + k * w, at[1] + 0.6 * w);
    }
    pen.strokeStyle = shade(ink, at[2]);
    pen.lineWidth = 1.3 * devicePixelRatio;
    pen.stroke();
  }]);
}
// A name beside a point, over all that is drawn.
function label(p, words, below) {
  const at = seen(p);
  parts.push([2, () => {
    const [x, y] = [at[0] + 7 * devicePixelRatio, at[1] + (below ? 16 : -7) * devicePixelRatio];
    pen.font = 13 * devicePixelRatio + "px sans-serif";
    pen.strokeStyle = "rgb(255,255,255)";
    pen.lineWidth = 3 * devicePixelRatio;
    pen.strokeText(words, x, y);
    pen.fillStyle = "rgb(40,40,40)";
    pen.fillText(words, x, y);
  }]);
}
function circle(p) {
  const at = seen(p);
  parts.push([-2, () => {
    pen.beginPath();
    pen.arc(at[0], at[1], arm * unit(), 0, 7);
    pen.strokeStyle = "#dddddd";
    pen.lineWidth = devicePixelRatio;
    pen.stroke();
  }]);
}
function tip(body, f, axis) {
  const turn = body.turns[f], p = body.places[f];
  return [0, 1, 2].map(j => p[j] + arm * turn[3 * j + axis]);
}
// The scale of the colours of particles, with its numbers and its name.
function legend(tints) {
  const u = devicePixelRatio, [x, y, tall] = [canvas.width - 70 * u, 34 * u, 120 * u];
  for (let k = 0; k < 40; k++) {
    pen.fillStyle = "rgb(" + tint(1 - k / 39).map(Math.round).join(",") + ")";
    pen.fillRect(x, y + k * tall / 40, 14 * u, tall / 40 + 1);
  }
  pen.font = 12 * u + "px sans-serif";
  pen.fillStyle = "rgb(40,40,40)";
  pen.fillText(tints.name, x, y - 10 * u);
  for (const part of [1, 0.5, 0])
    pen.fillText(String(Number((tints.low + part * (tints.high - tints.low)).toPrecision(4))), x + 18 * u, y + (1 - part) * tall + 4 * u);
}
function draw() {
  canvas.width = canvas.clientWidth * devicePixelRatio;
  canvas.height = canvas.clientHeight * devicePixelRatio;
  pen.clearRect(0, 0, canvas.width, canvas.height);
  pen.lineCap = pen.lineJoin = "round";
  parts = [];
  if (scene.box) {
    const [x, y] = [scene.box[0], scene.box[1] || 0], corners = [[0, 0, 0], [x, 0, 0], [x, y, 0], [0, y, 0]];
    pen.beginPath();
    corners.map(seen).forEach((p, i) => i ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1]));
    pen.fillStyle = "#f2f2f2";
    pen.fill();
    path([...corners, [0, 0, 0]], [170, 170, 170], 1);
  }
  const from = Math.max(0, frame - behind);
  for (const body of scene.bodies) {
    const trail = [];
    for (let f = from; f <= frame; f++) trail.push(body.still ? tip(body, f, scene.flat ? 0 : 2) : body.places[f]);
    if (few || body.still) curve(trail, trace, 1.5);
    if (body.still) circle(body.places[frame]);
    for (let axis = 0; axis < (scene.flat ? 2 : 3); axis++)
      path([body.places[frame], tip(body, frame, axis)], colours[axis], few ? 3 : 1.2);
    if (body.still && !scene.flat) dot(tip(body, frame, 2), colours[2], 4);
    if (scene.bodies.length <= named) label(body.places[frame], body.name, false);
  }
  for (const link of scene.links) path(joined(link, frame), grey, 2.5);
  for (const chain of scene.chains) {
    const now = points(chain, frame);
    if (chain.line) path(now, grey, 1.5);
    if (chain.trails) now.forEach((_, k) => {
      const trail = [];
      for (let f = from; f <= frame; f++) trail.push(points(chain, f)[k]);
      curve(trail, trace, 1.5);
    });
    const radius = now.length > 200 ? 1.6 : chain.line || now.length > 20 ? 2.5 : 5;
    const tints = chain.tints;
    now.forEach((p, k) => dot(p, tints ? tint(depth(tints, frame, k)) : blue, tints ? 1.4 * radius : radius));
    if (!tints && !chain.profile && scene.chains.length <= named && now.length) label(now[0], chain.name, true);
  }
  scene.supports.forEach(ground);
  if (origin) {
    const w = reach / 40;
    for (const j of [0, 1, 2].slice(0, scene.flat ? 2 : 3))
      stroke([-w, w].map(x => [0, 1, 2].map(i => i === j ? x : 0)), [150, 150, 150], 1);
    label([0, 0, 0], "0", true);
  }
  parts.sort((a, b) => a[0] - b[0]).forEach(part => part[1]());
  scene.chains.filter(c => c.tints).slice(0, 1).forEach(c => legend(c.tints));
  clock.textContent = "t = " + scene.times[frame].toPrecision(5);
  slider.value = frame;
  document.body.dataset.drawn = String(frame + 1);
}
function tick() {
  if (!running) return;
  frame = frame >= last ? 0 : frame + 1;
  draw();
  requestAnimationFrame(tick);
}
play.onclick = () => {
  running = !running;
  play.textContent = running ? "pause" : "play";
  if (running) requestAnimationFrame(tick);
};
slider.max = last;
slider.oninput = () => { frame = Number(slider.value); draw(); };
canvas.onpointermove = event => {
  if (!event.buttons) return;
  yaw += event.movementX / 150;
  pitch = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, pitch + event.movementY / 150));
  draw();
};
canvas.onwheel = event => {
  event.preventDefault();
  zoom = Math.min(20, Math.max(0.2, zoom * Math.exp(-event.deltaY / 500)));
  draw();
};
window.onresize = draw;
draw();
