// The view of a run that can be turned and played: bodies by their axes, points, chains and profiles.
"use strict";
const scene = JSON.parse(document.getElementById("scene").textContent);
const canvas = document.getElementById("view");
const pen = canvas.getContext("2d");
const slider = document.getElementById("time");
const clock = document.getElementById("clock");
const play = document.getElementById("play");
const colours = ["#d55e00", "#009e73", "#0072b2"];
const last = scene.times.length - 1;
// Profiles are wider than high.
const flatter = scene.flat && scene.chains.every(c => c.profile);
let yaw = scene.flat ? 0 : -0.6, pitch = scene.flat ? Math.PI / 2 : 0.45, zoom = 1;
let frame = 0, running = false;

// Largest distance of anything from the middle, so that all of the motion fits.
const middle = [0, 0, 0];
let reach = 1e-300;
function points(chain, f) {
  const flat = chain.frames[f], out = [];
  if (chain.profile) {
    const n = flat.length, top = chain.top || 1;
    flat.forEach((v, i) => out.push([n > 1 ? 2 * i / (n - 1) - 1 : 0, 0.6 * v / top, 0]));
    return out;
  }
  for (let i = 0; i < flat.length; i += chain.dim)
    out.push([flat[i], flat[i + 1], chain.dim > 2 ? flat[i + 2] : 0]);
  return out;
}
function places() {
  const all = [];
  for (let f = 0; f <= last; f++) {
    scene.chains.forEach(c => all.push(...points(c, f)));
    scene.bodies.forEach(b => all.push(b.places[f]));
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
const arm = scene.bodies.length === 0 ? 0 : !scene.bodies.some(b => b.small) ? 1 : reach / (few ? 5 : 12);
reach += 1.15 * arm;

// Pixels of a length of one.
function unit() {
  return 0.48 * (flatter ? Math.min(canvas.width, 1.6 * canvas.height) : Math.min(canvas.width, canvas.height)) / reach * zoom;
}
function seen(p) {
  const x = p[0] - middle[0], y = p[1] - middle[1], z = p[2] - middle[2];
  const [c, s, d, t] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  const across = c * x - s * y, away = s * x + c * y;
  const scale = unit();
  return [canvas.width / 2 + scale * across, canvas.height / 2 - scale * (away * t + z * d)];
}
function path(list, colour, width) {
  pen.beginPath();
  list.forEach((p, i) => i ? pen.lineTo(...seen(p)) : pen.moveTo(...seen(p)));
  pen.strokeStyle = colour;
  pen.lineWidth = width * devicePixelRatio;
  pen.stroke();
}
function dot(p, colour, radius) {
  pen.beginPath();
  pen.arc(...seen(p), radius * devicePixelRatio, 0, 7);
  pen.fillStyle = colour;
  pen.fill();
}
function circle(p) {
  const at = seen(p);
  pen.beginPath();
  pen.arc(at[0], at[1], arm * unit(), 0, 7);
  pen.strokeStyle = "#dddddd";
  pen.lineWidth = devicePixelRatio;
  pen.stroke();
}
function tip(body, f, axis) {
  const turn = body.turns[f], p = body.places[f];
  return [0, 1, 2].map(j => p[j] + arm * turn[3 * j + axis]);
}
function draw() {
  canvas.width = canvas.clientWidth * devicePixelRatio;
  canvas.height = canvas.clientHeight * devicePixelRatio;
  pen.clearRect(0, 0, canvas.width, canvas.height);
  if (scene.box) {
    const [x, y] = [scene.box[0], scene.box[1] || 0];
    path([[0, 0, 0], [x, 0, 0], [x, y, 0], [0, y, 0], [0, 0, 0]], "#bbbbbb", 1);
  }
  const from = Math.max(0, frame - 150);
  for (const body of scene.bodies) {
    const trail = [];
    for (let f = from; f <= frame; f++) trail.push(body.small ? body.places[f] : tip(body, f, 2));
    if (few || !body.small) path(trail, "#9ecae1", 1.5);
    if (!body.small) circle(body.places[frame]);
    for (let axis = 0; axis < 3; axis++) path([body.places[frame], tip(body, frame, axis)], colours[axis], few ? 3 : 1.2);
    if (!body.small) dot(tip(body, frame, 2), colours[2], 4);
  }
  for (const chain of scene.chains) {
    const now = points(chain, frame);
    if (chain.line) path(now, "#666666", 1.5);
    if (now.length === 1) {
      const trail = [];
      for (let f = from; f <= frame; f++) trail.push(points(chain, f)[0]);
      path(trail, "#9ecae1", 1.5);
    }
    const radius = now.length > 200 ? 1.6 : now.length > 20 ? 2.5 : 5;
    now.forEach(p => dot(p, "#0072b2", radius));
  }
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
