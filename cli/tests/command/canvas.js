// Runs the script of a page without a browser, on a canvas that writes what is drawn as SVG. Takes the file of a page and
// the number of a frame; prints the picture.
"use strict";
const text = require("fs").readFileSync(process.argv[2], "utf8");
const script = text.split("<script>").pop().split("</script>")[0];
const data = text.split('id="scene">')[1].split("</script>")[0];
const wide = 900, tall = 460;
let out = [], path = "";
const close = words => words.replace(/&/g, "&amp;").replace(/</g, "&lt;");
const number = x => x.toFixed(2);
const pen = {
  clearRect() { out = []; },
  beginPath() { path = ""; },
  moveTo(x, y) { path += `M${number(x)} ${number(y)}`; },
  lineTo(x, y) { path += `L${number(x)} ${number(y)}`; },
  arc(x, y, r) { path += `M${number(x - r)} ${number(y)}a${number(r)} ${number(r)} 0 1 0 ${number(2 * r)} 0a${number(r)} ${number(r)} 0 1 0 ${number(-2 * r)} 0`; },
  stroke() { out.push(`<path d="${path}" fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}" stroke-linecap="round" stroke-linejoin="round"/>`); },
  fill() { out.push(`<path d="${path}" fill="${this.fillStyle}"/>`); },
  fillRect(x, y, w, h) { out.push(`<rect x="${x}" y="${y}" width="${w}" height="${h}" fill="${this.fillStyle}"/>`); },
  strokeText() {},
  fillText(words, x, y) { out.push(`<text x="${number(x)}" y="${number(y)}" font-size="13" font-family="sans-serif" fill="${this.fillStyle}">${close(words)}</text>`); },
};
const elements = {
  scene: { textContent: data },
  view: { clientWidth: wide, clientHeight: tall, getContext: () => pen },
  time: {}, clock: {}, play: {},
};
const document = { getElementById: id => elements[id], body: { dataset: {} } };
new Function("document", "window", "devicePixelRatio", "requestAnimationFrame", script)(document, {}, 1, () => {});
elements.time.value = Math.min(Number(process.argv[3] || 0), elements.time.max);
elements.time.oninput();
console.log(`<svg xmlns="http://www.w3.org/2000/svg" width="${wide}" height="${tall}"><rect width="${wide}" height="${tall}" fill="white"/>\n${out.join("\n")}\n</svg>`);
